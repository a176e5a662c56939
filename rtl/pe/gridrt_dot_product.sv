// The dot product of a vector of 18 bits with one of 36, three axes in a chain of slices. Each axis
// comes a clock after the one before it; the sum is there three clocks after the last one.
module gridrt_dot_product (
    input  logic             clk_i,
    input  logic [2:0]       valid_i,  // by axis: whether anybody asks for the sum
    input  logic [2:0][17:0] a_i,      // signed
    input  logic [2:0][35:0] b_i,      // signed
    output logic [53:0]      sum_o     // signed, modulo 2^54
);
  logic [3:0][53:0] sum;
  assign sum[0] = '0;
  for (genvar a = 0; a < 3; a++) begin : gen_axis
    gridrt_product_pair #(
        .CHAIN(a > 0)
    ) u_pair (
        .clk_i,
        .valid_i(valid_i[a]),
        .a_i({2{a_i[a]}}),
        .b_i(b_i[a]),
        .sum_i(sum[a]),
        .sum_o(sum[a+1])
    );
  end
  assign sum_o = sum[3];
endmodule
