// One stage of gridrt_divide_pipe: BITS bits of the quotient. `word` holds dividend bits to come,
// highest first, and below them the quotient bits found so far.
module gridrt_divide_stage #(
    parameter int unsigned DIVISOR_W = 18,
    parameter int unsigned QUOTIENT_W = 11,
    parameter int unsigned BITS = 1,
    parameter int unsigned REMAINDER_W = DIVISOR_W,  // of remainder_i; bits above are 0
    parameter bit CONSTANT = 1'b0
) (
    input  logic                  clk_i,
    input  logic                  rst_ni,
    input  logic                  enable_i,
    input  logic                  valid_i,
    input  logic [ DIVISOR_W-1:0] remainder_i,
    input  logic [QUOTIENT_W-1:0] word_i,
    input  logic [ DIVISOR_W-1:0] divisor_i,
    output logic                  valid_o,
    output logic [ DIVISOR_W-1:0] remainder_o,
    output logic [QUOTIENT_W-1:0] word_o,
    output logic [ DIVISOR_W-1:0] divisor_o
);
  logic [ DIVISOR_W-1:0] remainder;
  logic [QUOTIENT_W-1:0] word;
  logic [DIVISOR_W:0] shifted, difference;

  always_comb begin
    remainder = remainder_i;
    word = word_i;
    shifted = '0;
    difference = '0;
    for (int unsigned j = 0; j < BITS; j++) begin
      shifted = {remainder, word[QUOTIENT_W-1]};
      difference = shifted - {1'b0, divisor_i};
      for (int unsigned i = 0; i < DIVISOR_W; i++) begin
        remainder[i] = i <= REMAINDER_W + j && (difference[DIVISOR_W] ? shifted[i] : difference[i]);
      end
      word = {word[QUOTIENT_W-2:0], !difference[DIVISOR_W]};
    end
  end

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) valid_o <= 1'b0;
    else if (enable_i) valid_o <= valid_i;
  end
  always_ff @(posedge clk_i) begin
    if (enable_i && valid_i) begin
      remainder_o <= remainder;
      word_o <= word;
    end
  end

  if (CONSTANT) begin : gen_constant
    assign divisor_o = divisor_i;
  end else begin : gen_moving
    always_ff @(posedge clk_i) begin
      if (enable_i && valid_i) divisor_o <= divisor_i;
    end
  end
endmodule
