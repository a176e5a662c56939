// One stage of gridrt_divide_pipe: one or two bits of the quotient. The remainder, signed, is below
// the divisor and not below its negative. `word` holds dividend bits to come, highest first, and
// below them the quotient bits found so far.
module gridrt_divide_stage #(
    parameter int unsigned DIVISOR_W = 18,
    parameter int unsigned QUOTIENT_W = 11,
    parameter int unsigned BITS = 1,  // 1 or 2
    parameter bit RESTORE = 1'b0,  // the remainder that leaves is not negative
    parameter bit CONSTANT = 1'b0
) (
    input  logic                  clk_i,
    input  logic                  rst_ni,
    input  logic                  enable_i,
    input  logic                  valid_i,
    input  logic [   DIVISOR_W:0] remainder_i,
    input  logic [QUOTIENT_W-1:0] word_i,
    input  logic [ DIVISOR_W-1:0] divisor_i,
    output logic                  valid_o,
    output logic [   DIVISOR_W:0] remainder_o,
    output logic [QUOTIENT_W-1:0] word_o,
    output logic [ DIVISOR_W-1:0] divisor_o
);
  logic [DIVISOR_W:0] first, last, remainder;
  logic [QUOTIENT_W-1:0] word;
  gridrt_add_sub #(
      .WIDTH(DIVISOR_W + 1)
  ) i_first (
      .sub_i(!remainder_i[DIVISOR_W]),
      .a_i  ({remainder_i[DIVISOR_W-1:0], word_i[QUOTIENT_W-1]}),
      .b_i  ({1'b0, divisor_i}),
      .sum_o(first)
  );
  if (BITS == 2) begin : gen_second
    gridrt_add_sub #(
        .WIDTH(DIVISOR_W + 1)
    ) i_second (
        .sub_i(!first[DIVISOR_W]),
        .a_i  ({first[DIVISOR_W-1:0], word_i[QUOTIENT_W-2]}),
        .b_i  ({1'b0, divisor_i}),
        .sum_o(last)
    );
    assign word = {word_i[QUOTIENT_W-3:0], !first[DIVISOR_W], !last[DIVISOR_W]};
  end else begin : gen_one
    assign last = first;
    assign word = {word_i[QUOTIENT_W-2:0], !first[DIVISOR_W]};
  end
  if (RESTORE) begin : gen_restore
    gridrt_add_gated #(
        .WIDTH(DIVISOR_W + 1)
    ) i_remainder (
        .a_valid_i(1'b1),
        .a_i(last),
        .b_valid_i(last[DIVISOR_W]),
        .b_i({1'b0, divisor_i}),
        .sum_o(remainder)
    );
  end else begin : gen_signed
    assign remainder = last;
  end

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) valid_o <= 1'b0;
    else if (enable_i) valid_o <= valid_i;
  end
  always_ff @(posedge clk_i) begin
    if (enable_i && (gridrt_pkg::FREE_RUNNING || valid_i)) begin
      remainder_o <= remainder;
      word_o <= word;
    end
  end

  if (CONSTANT) begin : gen_constant
    assign divisor_o = divisor_i;
  end else begin : gen_moving
    always_ff @(posedge clk_i) begin
      if (enable_i && (gridrt_pkg::FREE_RUNNING || valid_i)) divisor_o <= divisor_i;
    end
  end
  // Of a second bit; the sign is shifted out.
  logic unused;
  assign unused = &{1'b0, first, word_i};
endmodule
