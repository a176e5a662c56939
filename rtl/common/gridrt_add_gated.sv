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
  // (A & B) ^ (C & D); where C and D are 0 it is A & B, which is the carry of a bit that makes one.
  localparam logic [15:0] TABLE = 16'h7888;
  localparam int unsigned PAIRS = (WIDTH + 1) / 2;
  logic [2*PAIRS-1:0] a, b, sum;
  logic [PAIRS:0] carry;
  assign a = (2 * PAIRS)'(a_i);
  assign b = (2 * PAIRS)'(b_i);
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
        .A0(a[2*i]), .B0(a_valid_i), .C0(b[2*i]), .D0(b_valid_i),
        .A1(a[2*i+1]), .B1(a_valid_i), .C1(b[2*i+1]), .D1(b_valid_i),
        .S0(sum[2*i]), .S1(sum[2*i+1]),
        .COUT(carry[i+1])
    );
  end
  logic unused;
  assign unused = &{1'b0, carry[PAIRS], sum};
`else
  assign sum_o = (a_valid_i ? a_i : '0) + (b_valid_i ? b_i : '0);
`endif
endmodule
