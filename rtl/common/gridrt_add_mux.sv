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
  // A ^ (D ? B : C); where C and D are 0 it is A, which is the carry of a bit that makes one.
  localparam logic [15:0] TABLE = 16'h665A;
  localparam int unsigned PAIRS = (WIDTH + 1) / 2;
  logic [2*PAIRS-1:0] a, b, c, sum;
  logic [PAIRS:0] carry;
  assign a = (2 * PAIRS)'(a_i);
  assign b = (2 * PAIRS)'(b_i);
  assign c = (2 * PAIRS)'(c_i);
  assign carry[0] = 1'b0;
  assign sum_o = sum[WIDTH-1:0];
  for (genvar i = 0; i < PAIRS; i++) begin : gen_pair
    CCU2C #(
        .INIT0(TABLE),
        .INIT1(TABLE),
        .INJECT1_0("NO"),
        .INJECT1_1("NO")
    ) u_pair (
        .CIN(carry[i]),
        .A0(a[2*i]), .B0(b[2*i]), .C0(c[2*i]), .D0(first_i),
        .A1(a[2*i+1]), .B1(b[2*i+1]), .C1(c[2*i+1]), .D1(first_i),
        .S0(sum[2*i]), .S1(sum[2*i+1]),
        .COUT(carry[i+1])
    );
  end
  logic unused;
  assign unused = &{1'b0, carry[PAIRS], sum};
`else
  assign sum_o = a_i + (first_i ? b_i : c_i);
`endif
endmodule
