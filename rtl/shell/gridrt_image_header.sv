// Takes an image header and its directory apart while their bytes pass: nothing but what a device
// needs is kept. The first field that is not valid is what the image is refused for.
module gridrt_image_header #(
    parameter int unsigned B = 17,
    parameter int unsigned PES = 4,
    parameter int unsigned BLOCKS = 4096,
    parameter int unsigned CELLS = 6144,
    parameter int unsigned REFS = 8192,
    parameter int unsigned TRIS = 4096,
    parameter int unsigned VERTS = 2560
) (
    input  logic                              clk_i,
    input  logic                              rst_ni,
    input  logic                              begin_i,  // a new image: forget the one before
    input  logic                              byte_valid_i,
    input  logic                       [ 7:0] byte_i,
    input  logic                              finish_i,  // all bytes of the section have come
    output logic                              complete_o,  // from the clock after finish_i on
    output gridrt_shell_pkg::refusal_t        refusal_o,  // from the clock after finish_i on
    output logic                       [11:0] progress_o,  // bytes so far
    output gridrt_shell_pkg::header_t         header_o,
    // The directory: which sections there are (slot: see gridrt_loader) and what is written of each.
    output logic                       [15:0] present_o,
    output logic                              entry_write_o,
    output logic                       [ 3:0] entry_slot_o,
    output logic                       [15:0] entry_bytes_o,
    output logic                       [31:0] entry_crc_o
);
  localparam int unsigned HEADER_WORDS = gridrt_protocol_pkg::IMAGE_HEADER_BYTES / 4;
  localparam logic [15:0] BAD_HEADER = gridrt_protocol_pkg::ERROR_CODE_BAD_HEADER;

  gridrt_shell_pkg::header_t header;
  gridrt_shell_pkg::refusal_t refusal;
  logic [15:0] present;
  logic complete, bad;
  logic [11:0] progress;
  logic [31:0] crc, crc_next;
  logic [4:0] bits;
  logic [16:0] sections;

  // Words of the section, one clock after their last byte.
  logic [31:0] word;
  logic word_valid;
  logic [9:0] index;  // of the word
  gridrt_crc32c u_crc (
      .crc_i (crc),
      .data_i(byte_i),
      .crc_o (crc_next)
  );
  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      word_valid <= 1'b0;
      progress   <= '0;
    end else begin
      word_valid <= byte_valid_i && progress[1:0] == 2'd3;
      if (begin_i) progress <= '0;
      else if (byte_valid_i) progress <= progress + 1'b1;
      else if (finish_i && bad) progress <= '0;
    end
  end
  always_ff @(posedge clk_i) begin
    if (begin_i) crc <= gridrt_shell_pkg::CRC_START;
    else if (byte_valid_i) crc <= crc_next;
    if (byte_valid_i) begin
      word  <= {byte_i, word[31:8]};
      index <= progress[11:2];
    end
  end
  assign progress_o = progress;

  // Fields of the header.
  logic wrong;  // the field at hand is not valid
  logic [11:0] offset;  // of that field
  logic [1:0] axis;
  logic [16:0] limit;  // 2^bits - 2
  logic [16:0] box_now;
  assign limit = 17'((18'd1 << bits) - 18'd2);
  // Chosen by comparison: an index would be multiplied.
  always_comb begin
    box_now = header.box[0];
    for (int unsigned a = 1; a < 3; a++) if (axis == 2'(a)) box_now = header.box[a];
  end
  always_comb begin
    wrong  = 1'b0;
    offset = {index, 2'd0};
    axis   = 2'd0;
    case (index)
      10'd0: wrong = word != 32'(gridrt_protocol_pkg::IMAGE_MAGIC);
      10'd1: begin
        if (word[15:0] != 16'(gridrt_protocol_pkg::IMAGE_VERSION)) begin
          wrong = 1'b1;
        end else if (word[23:16] != gridrt_protocol_pkg::LAYOUT_COMPACT) begin
          wrong  = 1'b1;
          offset = 12'd6;
        end else begin
          wrong  = word[31:24] == 8'd0 || word[31:24] > 8'(PES);
          offset = 12'd7;
        end
      end
      10'd2: wrong = word[7:0] < 8'd4 || word[7:0] > 8'(B);
      10'd13, 10'd14, 10'd15: begin  // largest coordinates, 2 .. 2^bits - 3
        axis  = 2'(index - 10'd13);
        wrong = word < 32'd2 || word >= {15'd0, limit};
      end
      10'd16, 10'd17, 10'd18: begin  // voxels
        axis  = 2'(index - 10'd16);
        wrong = word == '0 || word > 32'd512 || word > {15'd0, box_now};
      end
      10'd19, 10'd20, 10'd21: begin  // edges
        axis  = 2'(index - 10'd19);
        wrong = word == '0 || word > {15'd0, box_now};
      end
      10'd22: wrong = word > 32'd1024;  // margin
      10'd25: wrong = word > 32'(gridrt_protocol_pkg::NO_ID_COMPACT);  // local ids
      10'd26: begin  // the widths of compact records
        wrong = word != {8'(gridrt_protocol_pkg::LAYOUT_COMPACT_ID_BITS),
                         8'(gridrt_protocol_pkg::LAYOUT_COMPACT_TRIANGLE_INDEX_BITS),
                         8'(gridrt_protocol_pkg::LAYOUT_COMPACT_VERTEX_INDEX_BITS),
                         8'(gridrt_protocol_pkg::LAYOUT_COMPACT_COORDINATE_BITS)};
      end
      10'd27: begin
        wrong = word != {8'(gridrt_protocol_pkg::LAYOUT_COMPACT_PE_BITS),
                         8'(gridrt_protocol_pkg::LAYOUT_COMPACT_LIST_BITS),
                         8'(gridrt_protocol_pkg::LAYOUT_COMPACT_FIRST_BITS),
                         8'(gridrt_protocol_pkg::LAYOUT_COMPACT_BASE_BITS)};
      end
      10'd28: wrong = word > 32'(CELLS);
      default: wrong = 1'b0;
    endcase
  end

  // Directory entries: kind and PE, place, bytes, CRC.
  logic in_directory, shared, own, known, excess, fault;
  logic [9:0] place, number;
  logic [7:0] kind, pe;
  logic [31:0] most;
  logic [3:0] slot;
  logic [15:0] bytes;
  assign place = index - 10'(HEADER_WORDS);
  assign number = {2'd0, place[9:2]};
  assign in_directory = index >= 10'(HEADER_WORDS) && {7'd0, number} < sections;
  assign shared = kind == gridrt_protocol_pkg::SECTION_KIND_BLOCKS ||
                  kind == gridrt_protocol_pkg::SECTION_KIND_CELLS;
  assign own = kind == gridrt_protocol_pkg::SECTION_KIND_REFERENCES ||
               kind == gridrt_protocol_pkg::SECTION_KIND_TRIANGLES ||
               kind == gridrt_protocol_pkg::SECTION_KIND_VERTICES;
  assign known = shared || own;
  always_comb begin
    case (kind[2:0])
      3'd1: most = 32'(BLOCKS * gridrt_protocol_pkg::BLOCK_RECORD_BYTES);
      3'd2: most = 32'(CELLS * gridrt_protocol_pkg::CELL_RECORD_BYTES);
      3'd3: most = 32'(REFS * gridrt_protocol_pkg::REFERENCE_RECORD_BYTES);
      3'd4: most = 32'(TRIS * gridrt_protocol_pkg::TRIANGLE_RECORD_BYTES);
      default: most = 32'(VERTS * gridrt_protocol_pkg::VERTEX_RECORD_BYTES);
    endcase
  end
  gridrt_slot u_slot (
      .kind_i(kind),
      .pe_i  (pe),
      .slot_o(slot)
  );
  // Twice the same section, or one of a PE that there is not.
  assign fault = present[slot] || (shared ? pe != 8'd0 : pe >= {5'd0, header.pes});
  assign excess = word > most;
  assign entry_write_o = word_valid && in_directory && place[1:0] == 2'd3 && known;
  assign entry_slot_o = slot;
  assign entry_bytes_o = bytes;
  assign entry_crc_o = word;

  // The end: size and CRC come before all fields.
  logic [21:0] expected;
  gridrt_shell_pkg::refusal_t verdict;
  assign expected = 22'(gridrt_protocol_pkg::IMAGE_HEADER_BYTES + 4) + {1'b0, sections, 4'd0};
  always_comb begin
    verdict = refusal;
    if (progress < 12'(gridrt_protocol_pkg::IMAGE_HEADER_BYTES + 4)) begin
      verdict.code = gridrt_protocol_pkg::ERROR_CODE_MISSING_SECTION;
      verdict.detail = '0;
    end else if ({10'd0, progress} != expected) begin
      verdict.code = BAD_HEADER;
      verdict.detail = 32'd14;
    end else if (crc != gridrt_shell_pkg::CRC_RESIDUE) begin
      verdict.code = gridrt_protocol_pkg::ERROR_CODE_BAD_SECTION_CRC;
      verdict.detail = '0;
    end
  end
  assign bad = verdict.code != '0;

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      complete <= 1'b0;
      present  <= '0;
      refusal  <= '0;
    end else if (begin_i) begin
      complete <= 1'b0;
      present  <= '0;
      refusal  <= '0;
    end else begin
      if (finish_i) begin
        complete <= !bad;
        refusal  <= verdict;
      end
      if (word_valid && refusal.code == '0) begin
        if (wrong && index < 10'(HEADER_WORDS)) begin
          refusal.code   <= BAD_HEADER;
          refusal.detail <= {20'd0, offset};
        end
        if (in_directory && known && place[1:0] == 2'd2 && (fault || excess)) begin
          refusal.code   <= excess ? gridrt_protocol_pkg::ERROR_CODE_TOO_LARGE : BAD_HEADER;
          refusal.detail <= excess ? {16'd0, pe, kind} : {20'd0, index[9:2], 4'd0};
        end
      end
      if (entry_write_o) present[slot] <= 1'b1;
    end
  end

  // The registers hold what a valid header says; of another one nothing is used.
  always_ff @(posedge clk_i) begin
    if (begin_i) sections <= '0;
    if (word_valid) begin
      case (index)
        10'd1: header.pes <= word[26:24];
        10'd2: bits <= word[4:0];
        10'd3: sections <= {1'b0, word[31:16]};
        10'd25: header.local_ids <= word[19:0];
        10'd28: header.cells <= word[13:0];
        default: begin
          if (in_directory && place[1:0] == 2'd2) bytes <= word[15:0];
        end
      endcase
      for (int unsigned a = 0; a < 3; a++) begin
        if (index == 10'(13 + a)) begin
          header.max_q[a] <= word[16:0];
          header.box[a]   <= word[16:0] + 17'd2;
        end
        if (index == 10'(16 + a)) header.count[a] <= word[9:0];
        if (index == 10'(19 + a)) header.edges[a] <= word[17:0];
      end
      if (in_directory && place[1:0] == 2'd0) begin
        kind <= word[7:0];
        pe   <= word[15:8];
      end
    end
  end

  assign complete_o = complete;
  assign refusal_o = refusal;
  assign present_o = present;
  assign header_o = header;

  if (B < 4 || B > gridrt_pkg::MAX_B || PES < 1 || PES > gridrt_pkg::MAX_PES) begin : gen_illegal
    $error("gridrt_image_header: B must be 4 to 17, PES 1 to 4");
  end
  if (BLOCKS < 1 || BLOCKS > gridrt_protocol_pkg::LAYOUT_COMPACT_MAX_BLOCKS ||
      CELLS < 1 || CELLS > gridrt_protocol_pkg::LAYOUT_COMPACT_MAX_CELLS ||
      REFS < 1 || REFS > gridrt_protocol_pkg::LAYOUT_COMPACT_MAX_REFERENCES ||
      TRIS < 1 || TRIS > gridrt_protocol_pkg::LAYOUT_COMPACT_MAX_TRIANGLES ||
      VERTS < 1 || VERTS > 4096) begin : gen_illegal_sizes
    $error("gridrt_image_header: a memory is larger than compact records address");
  end
endmodule
