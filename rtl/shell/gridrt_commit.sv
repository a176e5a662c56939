// Checks an image when the host says that it is complete: every section of every PE is there, whole
// and with the CRC that the directory names, all blocks of the grid are, and the grid covers the
// lattice box. Then the engine takes the grid's constants. The first objection ends the check.
module gridrt_commit #(
    parameter int unsigned PES = 4
) (
    input  logic                                    clk_i,
    input  logic                                    rst_ni,
    input  logic                                    clear_i,
    input  logic                                    start_i,
    input  logic                             [63:0] pe_mask_i,  // held until done
    input  logic                                    configured_i,  // the engine has this image already
    input  logic                                    header_complete_i,
    input  gridrt_shell_pkg::refusal_t              header_refusal_i,
    input  gridrt_shell_pkg::header_t               header_i,
    // A section's directory entry and state, in the same clock.
    output logic                             [ 3:0] slot_o,
    input  logic                                    present_i,
    input  logic                             [15:0] entry_bytes_i,
    input  logic                             [31:0] entry_crc_i,
    input  gridrt_shell_pkg::saved_t                saved_i,
    output logic                                    config_o,  // a pulse
    input  logic                                    config_done_i,
    output logic                                    done_o,  // a pulse
    output gridrt_shell_pkg::refusal_t              refusal_o  // valid with done_o
);
  typedef enum logic [2:0] {
    IDLE,
    BEGIN,
    SECTION,
    GRID,
    MULTIPLY,
    CONFIGURE,
    SETTLE,
    DONE
  } state_e;
  state_e state;

  logic [3:0] slot;
  logic [3:0] over;
  logic [13:0] blocks;
  gridrt_shell_pkg::refusal_t refusal, objection;
  logic [7:0] kind, pe;
  logic [31:0] where;

  // The section at hand.
  assign slot_o = slot;
  always_comb begin
    pe = {6'd0, slot[1:0]};
    case (slot[3:2])
      2'd0: begin
        kind = slot[0] ? gridrt_protocol_pkg::SECTION_KIND_CELLS :
                         gridrt_protocol_pkg::SECTION_KIND_BLOCKS;
        pe = '0;
      end
      2'd1: kind = gridrt_protocol_pkg::SECTION_KIND_REFERENCES;
      2'd2: kind = gridrt_protocol_pkg::SECTION_KIND_TRIANGLES;
      default: kind = gridrt_protocol_pkg::SECTION_KIND_VERTICES;
    endcase
    where = {16'd0, pe, kind};
    objection.detail = where;
    objection.code = '0;
    if (!present_i) begin
      objection.code = gridrt_protocol_pkg::ERROR_CODE_BAD_HEADER;
    end else if (saved_i.progress != entry_bytes_i ||
                 (slot[3:2] == 2'd1 && !pe_mask_i[{4'd0, slot[1:0]}])) begin
      // All PEs of an image have to answer.
      objection.code = gridrt_protocol_pkg::ERROR_CODE_MISSING_SECTION;
    end else if (~saved_i.crc != entry_crc_i) begin
      objection.code = gridrt_protocol_pkg::ERROR_CODE_BAD_SECTION_CRC;
    end else if (saved_i.phase != '0 || saved_i.bad ||
                 (slot == 4'd1 && saved_i.index != header_i.cells) ||
                 (slot[3:2] == 2'd1 && over[slot[1:0]])) begin
      objection.code = gridrt_protocol_pkg::ERROR_CODE_BAD_SECTION;
    end
  end

  // Products, a bit of one factor a clock: voxels times edge per axis, blocks in all.
  logic [2:0] step;  // 0 .. 2: axis; 3, 4: blocks
  logic [27:0] sum, addend;
  logic [9:0] bits;
  logic [2:0][9:0] half;
  logic [1:0] axis;
  assign axis = step[1:0];
  for (genvar a = 0; a < 3; a++) begin : gen_half
    assign half[a] = 10'((11'(header_i.count[a]) + 11'd1) >> 1);
  end
  logic covers, all_blocks;
  logic [16:0] box;
  logic [17:0] edges;
  logic [9:0] count;
  // Chosen by comparison: an index would be multiplied.
  always_comb begin
    box   = header_i.box[0];
    edges = header_i.edges[0];
    count = header_i.count[0];
    for (int unsigned a = 1; a < 3; a++) begin
      if (axis == 2'(a)) begin
        box   = header_i.box[a];
        edges = header_i.edges[a];
        count = header_i.count[a];
      end
    end
  end
  assign covers = sum >= {11'd0, box};
  assign all_blocks = sum == {14'd0, blocks};

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      state <= IDLE;
    end else if (clear_i) begin
      state <= IDLE;
    end else begin
      case (state)
        IDLE: if (start_i) state <= BEGIN;
        BEGIN: state <= header_complete_i ? SECTION : DONE;
        SECTION: begin
          if (objection.code != '0) state <= DONE;
          else if (slot == 4'd1) state <= GRID;
          else if (slot == {2'd3, 2'(header_i.pes - 3'd1)}) begin
            state <= configured_i ? DONE : CONFIGURE;
          end
        end
        GRID: state <= MULTIPLY;
        MULTIPLY: begin
          if (bits == '0) begin
            if (step < 3'd3) state <= covers ? GRID : DONE;
            else if (step == 3'd3) state <= GRID;
            else state <= all_blocks ? SECTION : DONE;
          end
        end
        CONFIGURE: state <= SETTLE;
        SETTLE: if (config_done_i) state <= DONE;
        default: state <= IDLE;
      endcase
    end
  end
  always_ff @(posedge clk_i) begin
    case (state)
      BEGIN: begin
        slot <= '0;
        step <= '0;
        over <= '0;
        refusal <= '0;
        if (!header_complete_i) begin
          refusal <= header_refusal_i;
          if (header_refusal_i.code == '0) begin
            refusal.code <= gridrt_protocol_pkg::ERROR_CODE_MISSING_SECTION;
          end
        end
      end
      SECTION: begin
        if (objection.code != '0) refusal <= objection;
        if (slot == 4'd0) blocks <= saved_i.index;
        if (slot == 4'd1) over <= saved_i.over;
        // Of one PE after the other: references, triangles, vertices.
        case (slot[3:2])
          2'd0: slot <= slot[0] ? 4'd4 : 4'd1;
          2'd1, 2'd2: slot <= slot + 4'd4;
          default: slot <= {2'd1, slot[1:0] + 2'd1};
        endcase
      end
      GRID: begin
        sum <= '0;
        case (step)
          3'd3: begin
            addend <= 28'(half[0]);
            bits   <= half[1];
          end
          3'd4: begin
            addend <= sum;
            bits   <= half[2];
          end
          default: begin
            addend <= 28'(edges);
            bits   <= count;
          end
        endcase
      end
      MULTIPLY: begin
        if (bits[0]) sum <= sum + addend;
        addend <= addend << 1;
        bits   <= bits >> 1;
        if (bits == '0) begin
          step <= step + 1'b1;
          if (step < 3'd3 && !covers) begin
            refusal.code   <= gridrt_protocol_pkg::ERROR_CODE_BAD_HEADER;
            refusal.detail <= 32'd76 + {28'd0, axis, 2'd0};
          end
          if (step == 3'd4 && !all_blocks) begin
            refusal.code   <= gridrt_protocol_pkg::ERROR_CODE_BAD_SECTION;
            refusal.detail <= 32'(gridrt_protocol_pkg::SECTION_KIND_BLOCKS);
          end
        end
      end
      default: ;
    endcase
  end

  assign config_o = state == CONFIGURE;
  assign done_o = state == DONE;
  assign refusal_o = refusal;

  logic unused;
  assign unused = &{1'b0, pe_mask_i, header_i, saved_i};
  if (PES < 1 || PES > gridrt_pkg::MAX_PES) begin : gen_illegal
    $error("gridrt_commit: PES must be 1 to 4");
  end
endmodule
