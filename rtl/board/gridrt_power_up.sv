// What happens after power-up, on a clock that is there at once: the PHY is reset, its clock starts,
// the PLL on it is let go. All outputs are high at first.
module gridrt_power_up #(
    parameter int unsigned CLOCKS = 1 << 18  // the PHY is in reset; the PLL for three times as long
) (
    input  logic clk_i,  // without reset: registers have values at configuration
    output logic phy_rst_o,
    output logic pll_rst_o
);
  localparam int unsigned COUNT_W = $clog2(CLOCKS) + 2;

  logic [COUNT_W-1:0] count = '0;
  logic phy = 1'b1;
  logic pll = 1'b1;
  assign phy_rst_o = phy;
  assign pll_rst_o = pll;
  always_ff @(posedge clk_i) begin
    if (pll) count <= count + 1'b1;
    if (count == COUNT_W'(CLOCKS)) phy <= 1'b0;
    if (count == COUNT_W'(3 * CLOCKS)) pll <= 1'b0;
  end

  if (CLOCKS < 2) begin : gen_illegal
    $error("gridrt_power_up: CLOCKS must be 2 or more");
  end
endmodule
