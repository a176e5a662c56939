// Two products of 18 bits and their sum or difference, one pair a clock, as one slice of an ECP5's
// sysDSP makes them (docs/hardware.md): factors, products and sum each end at a register there.
//   SUBTRACT: sum = a[0] b[0] - a[1] b[1]
//   else:     sum = a[0] b[0] + 2^18 a[1] b[1], where b[0] has no sign: the halves of a factor of 36 bits
// CHAIN adds the sum of the slice before, as it is two clocks after the factors.
module gridrt_product_pair #(
    parameter bit SUBTRACT = 1'b0,
    parameter bit CHAIN = 1'b0
) (
    input  logic             clk_i,
    input  logic             valid_i,  // whether anybody asks for the sum
    input  logic [1:0][17:0] a_i,      // signed
    input  logic [1:0][17:0] b_i,      // signed but for the low half
    input  logic [53:0]      sum_i,    // of the slice before
    output logic [53:0]      sum_o     // signed, of the factors three clocks ago
);
`ifdef GRIDRT_ECP5
  logic unused;
  assign unused = valid_i;
  gridrt_ecp5_slice #(
      .SUBTRACT(SUBTRACT),
      .CHAIN(CHAIN)
  ) u_slice (
      .clk_i,
      .a0_i(a_i[0]),
      .b0_i(b_i[0]),
      .a1_i(a_i[1]),
      .b1_i(b_i[1]),
      .sum_i,
      .sum_o
  );
`else
  // A simulation is faster where nothing moves; on an ECP5 that would cost wires.
  logic valid_1, valid_2;
  logic signed [1:0][17:0] a, b;
  logic signed [35:0] low, high;
  logic [53:0] more, chained;
  assign more = SUBTRACT ? -54'(high) : {high, 18'd0};
  assign chained = CHAIN ? sum_i : '0;
  always_ff @(posedge clk_i) begin
    valid_1 <= valid_i;
    valid_2 <= valid_1;
    if (valid_i) begin
      a <= a_i;
      b <= b_i;
    end
    if (valid_1) begin
      low <= 36'($signed(a[0]) * $signed({SUBTRACT && b[0][17], b[0]}));
      high <= $signed(a[1]) * $signed(b[1]);
    end
    if (valid_2) sum_o <= 54'(low) + more + chained;
  end
`endif
endmodule
