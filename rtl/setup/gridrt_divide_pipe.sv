// Unsigned division, a new one every clock, STEP quotient bits a stage. The dividend must be below
// divisor * 2^QUOTIENT_W. Results come LATENCY clocks (with enable_i) after the operands. It does not
// restore: where a difference is negative, the next bit's step adds the divisor instead of taking it
// away, which leaves the same quotient and needs no multiplexer.
module gridrt_divide_pipe #(
    parameter int unsigned DIVIDEND_W = 20,
    parameter int unsigned DIVISOR_W = 18,
    parameter int unsigned QUOTIENT_W = 11,
    parameter int unsigned STEP = 1,  // 1 or 2
    parameter bit REMAINDER = 1'b0,  // wanted; 0 otherwise
    parameter bit CONSTANT = 1'b0,  // the divisor stays the same while anything is in flight
    localparam int unsigned LATENCY = (QUOTIENT_W + STEP - 1) / STEP
) (
    input  logic                  clk_i,
    input  logic                  rst_ni,
    input  logic                  enable_i,
    input  logic                  valid_i,
    input  logic [DIVIDEND_W-1:0] dividend_i,
    input  logic [ DIVISOR_W-1:0] divisor_i,
    output logic                  valid_o,
    output logic [QUOTIENT_W-1:0] quotient_o,
    output logic [ DIVISOR_W-1:0] remainder_o
);
  if (DIVIDEND_W <= QUOTIENT_W || STEP < 1 || STEP > 2 ||
      QUOTIENT_W < 3) begin : gen_illegal
    $error("gridrt_divide_pipe: a dividend longer than the quotient of 3 bits or more, 1 or 2 a stage");
  end
  if (DIVIDEND_W > QUOTIENT_W + DIVISOR_W) begin : gen_illegal_width
    $error("gridrt_divide_pipe: the quotient of a longer dividend does not fit");
  end

  // Stage i holds the remainder and, in one word, dividend bits to come and quotient bits found.
  logic [LATENCY:0] valid;
  logic [LATENCY:0][DIVISOR_W:0] remainder;  // signed
  logic [LATENCY:0][QUOTIENT_W-1:0] word;
  logic [LATENCY:0][DIVISOR_W-1:0] divisor;

  assign valid[0] = valid_i;
  assign remainder[0] = (DIVISOR_W + 1)'(dividend_i >> QUOTIENT_W);
  assign word[0] = dividend_i[QUOTIENT_W-1:0];
  assign divisor[0] = divisor_i;
  assign valid_o = valid[LATENCY];
  assign quotient_o = word[LATENCY];
  assign remainder_o = REMAINDER ? remainder[LATENCY][DIVISOR_W-1:0] : '0;

  for (genvar i = 0; i < LATENCY; i++) begin : gen_stage
    gridrt_divide_stage #(
        .DIVISOR_W(DIVISOR_W),
        .QUOTIENT_W(QUOTIENT_W),
        .BITS((i == LATENCY - 1) ? QUOTIENT_W - i * STEP : STEP),
        .RESTORE(REMAINDER && i == LATENCY - 1),
        .CONSTANT(CONSTANT)
    ) i_stage (
        .clk_i,
        .rst_ni,
        .enable_i,
        .valid_i(valid[i]),
        .remainder_i(remainder[i]),
        .word_i(word[i]),
        .divisor_i(divisor[i]),
        .valid_o(valid[i+1]),
        .remainder_o(remainder[i+1]),
        .word_o(word[i+1]),
        .divisor_o(divisor[i+1])
    );
  end
  // The last stage's divisor and the remainder's sign end here.
  logic unused;
  assign unused = &{1'b0, divisor[LATENCY], remainder[LATENCY]};

`ifdef GRIDRT_ASSERT
  always_ff @(posedge clk_i) begin
    if (rst_ni && enable_i && valid_i) begin
      assert ((dividend_i >> QUOTIENT_W) < DIVIDEND_W'(divisor_i));
    end
  end
`endif
endmodule
