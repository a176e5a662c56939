// What happens after power-up, on a clock that is there at once: the PHY is reset, its clock starts,
// what runs on that is let go. Both outputs are high at first.
module gridrt_power_up #(
    parameter int unsigned CLOCKS = 1 << 18  // the PHY is in reset; the rest for three times as long
) (
    input  logic clk_i,  // without reset: registers have values at configuration
    output logic phy_rst_o,
    output logic hold_o
);
  localparam int unsigned COUNT_W = $clog2(CLOCKS) + 2;

  logic [COUNT_W-1:0] count = '0;
  logic phy = 1'b1;
  logic hold = 1'b1;
  assign phy_rst_o = phy;
  assign hold_o = hold;
  always_ff @(posedge clk_i) begin
    if (hold) count <= count + 1'b1;
    if (count == COUNT_W'(CLOCKS)) phy <= 1'b0;
    if (count == COUNT_W'(3 * CLOCKS)) hold <= 1'b0;
  end

  if (CLOCKS < 2) begin : gen_illegal
    $error("gridrt_power_up: CLOCKS must be 2 or more");
  end
endmodule
