// The rule of streams as an assertion: what has been offered stays, unchanged, until it is taken.
// Nothing of it is hardware.
module gridrt_stream_check #(
    parameter int unsigned WIDTH = 1
) (
    input logic             clk_i,
    input logic             rst_ni,
    input logic             valid_i,
    input logic             ready_i,
    input logic [WIDTH-1:0] data_i
);
`ifdef GRIDRT_ASSERT
  logic waits;
  logic [WIDTH-1:0] offered;
  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) waits <= 1'b0;
    else waits <= valid_i && !ready_i;
  end
  always_ff @(posedge clk_i) begin
    offered <= data_i;
    if (rst_ni && waits) begin
      assert (valid_i)
      else $error("gridrt_stream_check: an offer was taken back");
      assert (data_i == offered)
      else $error("gridrt_stream_check: an offer has changed");
    end
  end
`else
  logic unused;
  assign unused = &{1'b0, clk_i, rst_ni, valid_i, ready_i, data_i};
`endif
endmodule
