// a plus one of two numbers. On an ECP5 the choice fits into the tables of the carry chain, which yosys
// does not find: it would put a table a bit before the chain.
module gridrt_add_mux #(
    parameter int unsigned WIDTH = 18
) (
    input  logic             first_i,
    input  logic [WIDTH-1:0] a_i,
    input  logic [WIDTH-1:0] b_i,      // added if first_i
    input  logic [WIDTH-1:0] c_i,      // added if not
    output logic [WIDTH-1:0] sum_o     // modulo 2^WIDTH
);
`ifdef GRIDRT_ECP5
  // a ^ (d ? b : c)
  gridrt_carry_chain #(
      .WIDTH(WIDTH),
      .TABLE(16'h665A)
  ) u_chain (
      .a_i(a_i),
      .b_i(b_i),
      .c_i(c_i),
      .d_i({WIDTH{first_i}}),
      .sum_o(sum_o)
  );
`else
  assign sum_o = a_i + (first_i ? b_i : c_i);
`endif
endmodule
