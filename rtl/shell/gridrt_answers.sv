// Answers in the order in which they were asked for, as bytes to the host.
module gridrt_answers #(
    parameter int unsigned ANSWERS = 16  // frames that may wait, 2 or more
) (
    input  logic                                              clk_i,
    input  logic                                              rst_ni,
    input  logic                                              clear_i,  // drop everything
    output logic                                              room_o,  // for two answers
    output logic                                              idle_o,  // nothing is to be sent
    input  logic                                              answer_valid_i,
    input  gridrt_shell_pkg::answer_t                         answer_i,
    input  logic                                              verdict_valid_i,
    input  gridrt_shell_pkg::verdict_t                        verdict_i,
    input  logic                                              hit_valid_i,
    output logic                                              hit_ready_o,
    input  logic                                              hit_i,
    input  logic                       [gridrt_pkg::ID_W-1:0] hit_id_i,
    output logic                                              tx_valid_o,
    input  logic                                              tx_ready_i,
    output logic                       [7:0]                  tx_data_o
);
  localparam int unsigned COUNT_W = $clog2(ANSWERS + 1);

  logic answer_room, verdict_room, answer_valid, answer_ready, verdict_valid, verdict_ready;
  logic [gridrt_shell_pkg::ANSWER_W-1:0] answer;
  logic [gridrt_shell_pkg::VERDICT_W-1:0] verdict;
  logic [COUNT_W-1:0] waiting, verdicts;
  logic [1:0] sending;
  gridrt_fifo #(
      .WIDTH(gridrt_shell_pkg::ANSWER_W),
      .DEPTH(ANSWERS)
  ) u_answers (
      .clk_i,
      .rst_ni,
      .in_valid_i(answer_valid_i),
      .in_ready_o(answer_room),
      .in_data_i(answer_i),
      .out_valid_o(answer_valid),
      .out_ready_i(answer_ready || clear_i),
      .out_data_o(answer),
      .count_o(waiting)
  );
  gridrt_fifo #(
      .WIDTH(gridrt_shell_pkg::VERDICT_W),
      .DEPTH(ANSWERS)
  ) u_verdicts (
      .clk_i,
      .rst_ni,
      .in_valid_i(verdict_valid_i),
      .in_ready_o(verdict_room),
      .in_data_i(verdict_i),
      .out_valid_o(verdict_valid),
      .out_ready_i(verdict_ready || clear_i),
      .out_data_o(verdict),
      .count_o(verdicts)
  );
  assign idle_o = !answer_valid && !byte_valid && !tx_valid;
  assign room_o = waiting <= COUNT_W'(ANSWERS - 2);

  logic byte_valid, byte_ready, tx_valid, tx_ready;
  logic [7:0] data;
  gridrt_frame_out u_frame_out (
      .clk_i,
      .rst_ni,
      .clear_i,
      .answer_valid_i(answer_valid),
      .answer_ready_o(answer_ready),
      .answer_i(answer),
      .verdict_valid_i(verdict_valid),
      .verdict_ready_o(verdict_ready),
      .verdict_i(verdict),
      .hit_valid_i,
      .hit_ready_o,
      .hit_i,
      .hit_id_i,
      .byte_valid_o(byte_valid),
      .byte_ready_i(byte_ready),
      .byte_o(data)
  );
  // What is dropped leaves alone the byte that is being offered.
  gridrt_fifo #(
      .WIDTH(8),
      .DEPTH(2)
  ) u_tx (
      .clk_i,
      .rst_ni,
      .in_valid_i(byte_valid && !clear_i),
      .in_ready_o(byte_ready),
      .in_data_i(data),
      .out_valid_o(tx_valid),
      .out_ready_i(tx_ready),
      .out_data_o(tx_data_o),
      .count_o(sending)
  );
  gridrt_stall #(
      .SEED(14),
      .WIDTH(8)
  ) u_stall (
      .clk_i,
      .rst_ni,
      .in_valid_i(tx_valid),
      .in_ready_o(tx_ready),
      .out_valid_o(tx_valid_o),
      .out_ready_i(tx_ready_i),
      .data_i(tx_data_o)
  );

  if (ANSWERS < 2) begin : gen_illegal
    $error("gridrt_answers: ANSWERS must be 2 or more");
  end
  logic unused;
  assign unused = &{1'b0, answer_room, verdict_room, verdicts, sending};

`ifdef GRIDRT_ASSERT
  always_ff @(posedge clk_i) begin
    if (rst_ni) begin
      assert (!(answer_valid_i && !answer_room));
      assert (!(verdict_valid_i && !verdict_room));
    end
  end
`endif
endmodule
