// A number as one line of many. On an ECP5 it is decoded in two halves: of a shift, or of a bit chosen
// on the left of an assignment, yosys makes a shifter that takes several times as much. In simulation
// a shift is what takes the least time; tools/synth proves the two equal.
module gridrt_onehot #(
    parameter int unsigned LINES = 64,
    parameter int unsigned INDEX_W = (LINES > 1) ? $clog2(LINES) : 1
) (
    input  logic               valid_i,
    input  logic [INDEX_W-1:0] index_i,
    output logic [  LINES-1:0] line_o    // none for what is not valid or too large
);
  if (LINES < 1 || INDEX_W < 1 || LINES > (1 << INDEX_W)) begin : gen_illegal
    $error("gridrt_onehot: LINES must be positive, and INDEX_W enough for them");
  end

`ifdef GRIDRT_ECP5
  localparam int unsigned LOW_W = (INDEX_W > 3) ? 3 : INDEX_W;
  localparam int unsigned LOWS = 1 << LOW_W;
  localparam int unsigned HIGHS = (LINES + LOWS - 1) / LOWS;
  logic [ LOWS-1:0] low;
  logic [HIGHS-1:0] high;
  always_comb begin
    for (int unsigned i = 0; i < LOWS; i++) low[i] = index_i[LOW_W-1:0] == LOW_W'(i);
    for (int unsigned i = 0; i < HIGHS; i++) begin
      high[i] = valid_i && (index_i >> LOW_W) == INDEX_W'(i);
    end
    for (int unsigned i = 0; i < LINES; i++) line_o[i] = high[i/LOWS] && low[i%LOWS];
  end
`else
  assign line_o = LINES'(valid_i) << index_i;
`endif
endmodule
