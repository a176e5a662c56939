// The sum of two numbers, each of which may be left out; in one carry chain, as gridrt_add_mux.
module gridrt_add_gated #(
    parameter int unsigned WIDTH = 18
) (
    input  logic             a_valid_i,
    input  logic [WIDTH-1:0] a_i,
    input  logic             b_valid_i,
    input  logic [WIDTH-1:0] b_i,
    output logic [WIDTH-1:0] sum_o        // modulo 2^WIDTH
);
`ifdef GRIDRT_ECP5
  // (a & b) ^ (c & d)
  gridrt_carry_chain #(
      .WIDTH(WIDTH),
      .TABLE(16'h7888)
  ) u_chain (
      .a_i(a_i),
      .b_i({WIDTH{a_valid_i}}),
      .c_i(b_i),
      .d_i({WIDTH{b_valid_i}}),
      .sum_o(sum_o)
  );
`else
  assign sum_o = (a_valid_i ? a_i : '0) + (b_valid_i ? b_i : '0);
`endif
endmodule
