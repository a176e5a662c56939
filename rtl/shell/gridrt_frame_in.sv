// Finds frames in the bytes from the host: magic, header CRC, flags and length must be right, other
// bytes are skipped. The search goes on behind the first byte of what was no header. Payload bytes
// go on at once, before their CRC has come; the end of the frame says whether it matched. A frame
// whose bytes stop coming is ended as bad after idle_clocks_i clocks.
//
// For every frame: start (its fields stay until the end has been taken), its payload's bytes, end.
// A frame of another version has a start only.
module gridrt_frame_in (
    input  logic        clk_i,
    input  logic        rst_ni,
    input  logic        clear_i,  // forget the frame at hand
    input  logic        rx_valid_i,
    output logic        rx_ready_o,
    input  logic [ 7:0] rx_data_i,
    input  logic [31:0] idle_clocks_i,  // >= 1
    output logic        start_valid_o,
    input  logic        start_ready_i,
    output logic        start_alien_o,  // another version
    output logic [ 7:0] type_o,
    output logic [ 7:0] layout_o,
    output logic [31:0] sequence_o,
    output logic [22:0] length_o,  // a multiple of 4, at most the protocol's max_payload
    output logic        byte_valid_o,
    input  logic        byte_ready_i,
    output logic [ 7:0] byte_o,
    output logic        end_valid_o,
    input  logic        end_ready_i,
    output logic        end_good_o,
    output logic        bad_frame_o, // a pulse: a header was refused, or a frame was faulty
    output logic        idle_o       // no frame is at hand
);
  localparam logic [31:0] MAGIC = 32'(gridrt_protocol_pkg::FRAME_MAGIC);
  localparam logic [7:0] VERSION = 8'(gridrt_protocol_pkg::VERSION);
  localparam logic [4:0] HEADER = 5'd16;  // bytes behind the magic

  typedef enum logic [2:0] {
    FIND,
    CHECK,
    START,
    PAYLOAD,
    CRC,
    ENDED
  } state_e;
  state_e state;

  // The header behind its magic, the last byte on top. No byte but the first of the magic is a 'G',
  // so a refused header is searched from its fifth byte on: replay bytes are fed once more.
  logic [127:0] head;
  logic [4:0] captured, replay;
  logic [1:0] matched;  // bytes of the magic
  logic in_header;
  logic [31:0] crc, crc_from, crc_next;
  logic [22:0] left;
  logic [31:0] idle;
  logic cut, take, hit_magic, receiving;
  logic [7:0] data;
  logic [31:0] length;

  assign length = head[95:64];
  assign type_o = head[15:8];
  assign layout_o = head[23:16];
  assign sequence_o = head[63:32];
  assign length_o = length[22:0];
  assign start_alien_o = head[7:0] != VERSION;
  assign start_valid_o = state == START;
  assign end_valid_o = state == ENDED;
  assign end_good_o = !cut && crc == gridrt_shell_pkg::CRC_RESIDUE;
  assign byte_valid_o = state == PAYLOAD && rx_valid_i;
  assign byte_o = rx_data_i;

  assign data = (state == FIND && replay != '0) ? head[7:0] : rx_data_i;
  always_comb begin
    case (state)
      FIND: rx_ready_o = replay == '0 && !clear_i;
      PAYLOAD: rx_ready_o = byte_ready_i && !clear_i;
      CRC: rx_ready_o = !clear_i;
      default: rx_ready_o = 1'b0;
    endcase
  end
  assign take = (rx_valid_i && rx_ready_o) || (state == FIND && replay != '0);
  assign idle_o = state == FIND && !in_header && replay == '0;
  assign receiving = state == PAYLOAD || state == CRC;

  assign hit_magic = data == MAGIC[8*matched+:8];
  assign crc_from = (state == FIND && !in_header && (matched == '0 || !hit_magic)) ?
                    gridrt_shell_pkg::CRC_START : crc;
  gridrt_crc32c u_crc (
      .crc_i (crc_from),
      .data_i(data),
      .crc_o (crc_next)
  );

  logic header_good;
  assign header_good = crc == gridrt_shell_pkg::CRC_RESIDUE && head[31:24] == 8'd0 &&
                       length[1:0] == 2'd0 && length <= 32'(gridrt_protocol_pkg::MAX_PAYLOAD);
  assign bad_frame_o = (state == CHECK && !header_good) ||
                       (state == START && start_alien_o && start_ready_i) ||
                       (state == ENDED && !end_good_o && end_ready_i);

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      state     <= FIND;
      matched   <= '0;
      in_header <= 1'b0;
      captured  <= '0;
      replay    <= '0;
      cut       <= 1'b0;
    end else if (clear_i) begin
      state     <= FIND;
      matched   <= '0;
      in_header <= 1'b0;
      replay    <= '0;
    end else begin
      case (state)
        FIND: begin
          if (take) begin
            if (replay != '0) replay <= replay - 1'b1;
            if (in_header) begin
              captured <= captured + 1'b1;
              if (captured == HEADER - 1'b1) begin
                state     <= CHECK;
                in_header <= 1'b0;
              end
            end else if (hit_magic) begin
              matched   <= matched + 1'b1;
              in_header <= matched == 2'd3;
              captured  <= '0;
            end else begin
              matched <= (data == MAGIC[7:0]) ? 2'd1 : 2'd0;
            end
          end
        end
        CHECK: begin
          matched <= '0;
          if (header_good) begin
            state <= START;
          end else begin
            state  <= FIND;
            replay <= HEADER;
          end
        end
        START: begin
          cut <= 1'b0;
          if (start_ready_i) begin
            if (start_alien_o) state <= FIND;
            else state <= (length == '0) ? CRC : PAYLOAD;
          end
        end
        PAYLOAD: begin
          if (take && left == 23'd5) state <= CRC;
        end
        CRC: begin
          if (take && left == 23'd1) state <= ENDED;
        end
        default: begin
          if (end_ready_i) state <= FIND;
        end
      endcase
      if (receiving && !take && idle >= idle_clocks_i) begin
        cut   <= 1'b1;
        state <= ENDED;
      end
    end
  end

  // left counts the payload and then the CRC's four bytes: 4 remain when the payload is complete.
  always_ff @(posedge clk_i) begin
    if (state == FIND && take && (in_header || replay != '0)) head <= {data, head[127:8]};
    if (state == START) crc <= gridrt_shell_pkg::CRC_START;
    else if (take) crc <= crc_next;
    if (state == START) left <= length[22:0] + 23'd4;
    else if (take) left <= left - 1'b1;
    // Only clocks in which a byte was wanted and none came count.
    if (!receiving || take) idle <= '0;
    else if (rx_ready_o) idle <= idle + 1'b1;
  end

`ifdef GRIDRT_ASSERT
  logic held;
  logic [127:0] head_q;
  always_ff @(posedge clk_i) begin
    held   <= (start_valid_o && !start_ready_i) || receiving;
    head_q <= head;
    if (rst_ni && held) begin
      assert (head == head_q);
    end
  end
`endif
endmodule
