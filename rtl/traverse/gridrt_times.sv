// A value times 0 to 7, as 4 times 0, 1 or 2 plus -1, 0, 1 or 2: one carry chain, and one LUT a bit for
// each of the two parts.
module gridrt_times #(
    parameter int unsigned WIDTH = 12
) (
    input  logic [2:0]       factor_i,
    input  logic [WIDTH-1:0] value_i,
    output logic [WIDTH-1:0] product_o  // modulo 2^WIDTH
);
  logic minus, one, two, four, eight;
  assign minus = factor_i[1:0] == 2'd3;
  assign one = factor_i[0];
  assign two = factor_i[1:0] == 2'd2;
  assign four = factor_i[2] ^ minus;
  assign eight = factor_i == 3'd7;
  gridrt_add_sub #(
      .WIDTH(WIDTH)
  ) i_sum (
      .sub_i(minus),
      .a_i  ((four ? value_i << 2 : '0) | (eight ? value_i << 3 : '0)),
      .b_i  ((one ? value_i : '0) | (two ? value_i << 1 : '0)),
      .sum_o(product_o)
  );
endmodule
