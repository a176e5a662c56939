// A reset that begins with another and lasts some clocks longer.
module gridrt_late_reset #(
    parameter int unsigned CLOCKS = 256
) (
    input  logic clk_i,
    input  logic rst_ni,
    output logic rst_no
);
  localparam int unsigned COUNT_W = $clog2(CLOCKS + 1);

  logic [COUNT_W-1:0] count;
  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      count  <= '0;
      rst_no <= 1'b0;
    end else if (count == COUNT_W'(CLOCKS)) begin
      rst_no <= 1'b1;
    end else begin
      count <= count + 1'b1;
    end
  end

  if (CLOCKS < 2) begin : gen_illegal
    $error("gridrt_late_reset: CLOCKS must be 2 or more");
  end
endmodule
