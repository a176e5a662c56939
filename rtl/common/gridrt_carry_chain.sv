// A sum in an ECP5's carry chain, each bit of which has a table of four inputs of its own before the
// carry: TABLE of {d, c, b, a}, and, where c and d are 0, the carry of a bit that makes one. For blocks
// that have the plain sum beside it; tools/synth proves the two equal.
module gridrt_carry_chain #(
    parameter int unsigned WIDTH = 18,
    parameter logic [15:0] TABLE = 16'h6666
) (
    input  logic [WIDTH-1:0] a_i,
    input  logic [WIDTH-1:0] b_i,
    input  logic [WIDTH-1:0] c_i,
    input  logic [WIDTH-1:0] d_i,
    output logic [WIDTH-1:0] sum_o  // modulo 2^WIDTH
);
`ifdef GRIDRT_ECP5
  localparam int unsigned PAIRS = (WIDTH + 1) / 2;
  logic [2*PAIRS-1:0] a, b, c, d, sum;
  logic [PAIRS:0] carry;
  assign a = (2 * PAIRS)'(a_i);
  assign b = (2 * PAIRS)'(b_i);
  assign c = (2 * PAIRS)'(c_i);
  assign d = (2 * PAIRS)'(d_i);
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
        .A0(a[2*i]), .B0(b[2*i]), .C0(c[2*i]), .D0(d[2*i]),
        .A1(a[2*i+1]), .B1(b[2*i+1]), .C1(c[2*i+1]), .D1(d[2*i+1]),
        .S0(sum[2*i]), .S1(sum[2*i+1]),
        .COUT(carry[i+1])
    );
  end
  logic unused;
  assign unused = &{1'b0, carry[PAIRS], sum};
`else
  always_comb begin
    logic carry;
    carry = 1'b0;
    for (int unsigned i = 0; i < WIDTH; i++) begin
      sum_o[i] = TABLE[{d_i[i], c_i[i], b_i[i], a_i[i]}] ^ carry;
      if (!TABLE[{d_i[i], c_i[i], b_i[i], a_i[i]}]) carry = TABLE[{2'b00, b_i[i], a_i[i]}];
    end
  end
`endif
endmodule
