// A number as one line of many, decoded in two halves: a shift by a number, or a bit chosen by one on
// the left of an assignment, becomes a shifter that takes several times as much.
module gridrt_onehot #(
    parameter int unsigned LINES = 64,
    parameter int unsigned INDEX_W = (LINES > 1) ? $clog2(LINES) : 1
) (
    input  logic               valid_i,
    input  logic [INDEX_W-1:0] index_i,
    output logic [  LINES-1:0] line_o    // none for what is not valid or too large
);
  localparam int unsigned LOW_W = (INDEX_W > 3) ? 3 : INDEX_W;
  localparam int unsigned LOWS = 1 << LOW_W;
  localparam int unsigned HIGHS = (LINES + LOWS - 1) / LOWS;

  if (LINES < 1 || INDEX_W < 1 || LINES > (1 << INDEX_W)) begin : gen_illegal
    $error("gridrt_onehot: LINES must be positive, and INDEX_W enough for them");
  end

  logic [ LOWS-1:0] low;
  logic [HIGHS-1:0] high;
  always_comb begin
    for (int unsigned i = 0; i < LOWS; i++) low[i] = index_i[LOW_W-1:0] == LOW_W'(i);
    for (int unsigned i = 0; i < HIGHS; i++) begin
      high[i] = valid_i && (index_i >> LOW_W) == INDEX_W'(i);
    end
    for (int unsigned i = 0; i < LINES; i++) line_o[i] = high[i/LOWS] && low[i%LOWS];
  end
endmodule
