// Sends answers, one after the other, as frames: a byte a clock. A frame of hits is sent while they
// arrive; how its Trace has ended is known by the time of its CRC. If that was bad the CRC is
// wrong, and places of rays that never reached the engine are filled up.
module gridrt_frame_out (
    input  logic                                                    clk_i,
    input  logic                                                    rst_ni,
    input  logic                                                    clear_i,  // drop the frame
    input  logic                                                    answer_valid_i,
    output logic                                                    answer_ready_o,
    input  gridrt_shell_pkg::answer_t                               answer_i,
    input  logic                                                    verdict_valid_i,
    output logic                                                    verdict_ready_o,
    input  gridrt_shell_pkg::verdict_t                              verdict_i,
    input  logic                                                    hit_valid_i,
    output logic                                                    hit_ready_o,
    input  logic                                                    hit_i,
    input  logic                       [gridrt_pkg::ID_W-1:0]       hit_id_i,
    output logic                                                    byte_valid_o,
    input  logic                                                    byte_ready_i,
    output logic                       [7:0]                        byte_o
);
  localparam int unsigned COUNT_W = gridrt_shell_pkg::COUNT_W;

  // The word that is loaded next.
  typedef enum logic [3:0] {
    MAGIC,
    KIND,
    SEQUENCE,
    LENGTH,
    HEADER_CRC,
    FIRST,
    SECOND,
    HIT,
    CRC
  } word_e;
  word_e next;

  logic [31:0] word, shift;
  logic [2:0] bytes;  // left in shift
  logic [31:0] crc, crc_step, crc_now;
  logic [COUNT_W-1:0] remaining;
  logic sent, room, have, load, fresh, fill, hits, empty;
  logic [7:0] kind;
  logic [31:0] length;

  assign byte_valid_o = bytes != '0;
  assign byte_o = shift[7:0];
  assign sent = byte_valid_o && byte_ready_i;
  assign room = bytes == '0 || (bytes == 3'd1 && byte_ready_i);

  assign hits = answer_i.kind == gridrt_shell_pkg::ANSWER_HITS;
  assign empty = answer_i.kind == gridrt_shell_pkg::ANSWER_NO_OP;
  always_comb begin
    case (answer_i.kind)
      gridrt_shell_pkg::ANSWER_HITS: kind = gridrt_protocol_pkg::FRAME_TYPE_HITS;
      gridrt_shell_pkg::ANSWER_ERROR: kind = gridrt_protocol_pkg::FRAME_TYPE_ERROR;
      default: kind = gridrt_protocol_pkg::FRAME_TYPE_NO_OP;
    endcase
  end
  assign length = empty ? 32'd0 : 32'd8 + (hits ? 32'({answer_i.first[COUNT_W-1:0], 2'd0}) : 32'd0);

  gridrt_crc32c u_crc (
      .crc_i (crc),
      .data_i(byte_o),
      .crc_o (crc_step)
  );
  // A CRC begins with the magic, and with the first word behind the header's CRC.
  assign fresh = next == MAGIC || next == FIRST || (next == CRC && empty);
  assign crc_now = fresh ? gridrt_shell_pkg::CRC_START : sent ? crc_step : crc;

  assign fill = verdict_valid_i && remaining <= verdict_i.missing;
  assign hit_ready_o = clear_i || (next == HIT && room && !fill);

  always_comb begin
    have = answer_valid_i;
    case (next)
      MAGIC: word = 32'(gridrt_protocol_pkg::FRAME_MAGIC);
      KIND: begin
        word = {8'd0, 8'd0, kind, 8'(gridrt_protocol_pkg::VERSION)};
        if (hits) word[23:16] = gridrt_protocol_pkg::LAYOUT_COMPACT;
      end
      SEQUENCE: word = answer_i.sequence_;
      LENGTH: word = length;
      HEADER_CRC: word = ~crc_now;
      FIRST: word = answer_i.first;
      SECOND: word = answer_i.second;
      HIT: begin
        word = fill ? {12'd0, gridrt_pkg::NO_ID} : {11'd0, hit_i, hit_id_i};
        have = fill || hit_valid_i;
      end
      default: begin
        word = (hits && verdict_i.bad) ? crc_now : ~crc_now;
        have = answer_valid_i && (!hits || verdict_valid_i);
      end
    endcase
  end
  assign load = room && have && !clear_i;
  assign answer_ready_o = load && next == CRC;
  assign verdict_ready_o = load && next == CRC && hits;

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      next  <= MAGIC;
      bytes <= '0;
    end else if (clear_i) begin
      next  <= MAGIC;
      bytes <= '0;
    end else begin
      if (load) bytes <= 3'd4;
      else if (sent) bytes <= bytes - 1'b1;
      if (load) begin
        case (next)
          HEADER_CRC: next <= empty ? CRC : FIRST;
          SECOND: next <= hits ? HIT : CRC;
          HIT: if (remaining == COUNT_W'(1)) next <= CRC;
          CRC: next <= MAGIC;
          default: next <= word_e'(next + 4'd1);
        endcase
      end
    end
  end

  always_ff @(posedge clk_i) begin
    if (load) shift <= word;
    else if (sent) shift <= {8'd0, shift[31:8]};
    if (load && fresh) crc <= gridrt_shell_pkg::CRC_START;
    else if (sent) crc <= crc_step;
    if (load && next == SECOND) remaining <= answer_i.first[COUNT_W-1:0];
    else if (load && next == HIT) remaining <= remaining - 1'b1;
  end

`ifdef GRIDRT_ASSERT
  always_ff @(posedge clk_i) begin
    if (rst_ni && !clear_i) begin
      assert (!(next != MAGIC && !answer_valid_i));
      assert (!(answer_valid_i && hits && answer_i.first[COUNT_W-1:0] == '0));
    end
  end
`endif
endmodule
