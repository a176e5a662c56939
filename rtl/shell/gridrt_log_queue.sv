// The events of one source on their way to the log; lost_o: one came while the queue was full.
module gridrt_log_queue #(
    parameter int unsigned WIDTH = 8,
    parameter int unsigned DEPTH = 16
) (
    input  logic             clk_i,
    input  logic             rst_ni,
    input  logic             push_i,
    input  logic [WIDTH-1:0] data_i,
    output logic             lost_o,
    output logic             valid_o,
    output logic [WIDTH-1:0] data_o,
    input  logic             take_i
);
  logic room;
  logic [$clog2(DEPTH+1)-1:0] count;
  gridrt_fifo #(
      .WIDTH(WIDTH),
      .DEPTH(DEPTH)
  ) u_fifo (
      .clk_i,
      .rst_ni,
      .in_valid_i(push_i),
      .in_ready_o(room),
      .in_data_i(data_i),
      .out_valid_o(valid_o),
      .out_ready_i(take_i),
      .out_data_o(data_o),
      .count_o(count)
  );
  assign lost_o = push_i && !room;
  logic unused;
  assign unused = &{1'b0, count};
endmodule
