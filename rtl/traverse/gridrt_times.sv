// A value times 0 to 7: once, twice and four times the value, each added or left out.
module gridrt_times #(
    parameter int unsigned WIDTH = 12
) (
    input  logic [2:0]       factor_i,
    input  logic [WIDTH-1:0] value_i,
    output logic [WIDTH-1:0] product_o  // modulo 2^WIDTH
);
  logic [WIDTH-1:0] low;
  gridrt_add_gated #(
      .WIDTH(WIDTH)
  ) i_low (
      .a_valid_i(factor_i[0]),
      .a_i(value_i),
      .b_valid_i(factor_i[1]),
      .b_i(value_i << 1),
      .sum_o(low)
  );
  gridrt_add_gated #(
      .WIDTH(WIDTH)
  ) i_sum (
      .a_valid_i(1'b1),
      .a_i(low),
      .b_valid_i(factor_i[2]),
      .b_i(value_i << 2),
      .sum_o(product_o)
  );
endmodule
