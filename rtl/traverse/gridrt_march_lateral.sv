// The march on one lateral axis, clocks 2 to 9 of a step: the quarters of voxels in which the ray is at
// the nine quarter-slab faces of a block-slab, and its position where the next block-slab to be looked
// at begins, one to seven of them ahead. The position is rest + slope per quarter-slab, modulo a quarter
// of edge * 2^UNIT_SHIFT; no increment is longer than a quarter.
module gridrt_march_lateral (
    input  logic                                              clk_i,
    input  logic [6:0]                                        valid_i,     // of clocks 8 to 2
    input  logic [3:0]                                        s2_quarter_i,  // signed
    input  logic [2:0]                                        s2_low_i,
    input  logic [gridrt_pkg::AXIS_W:0]                       s2_limit_i,
    input  logic [gridrt_state_pkg::REST_W-1:0]               s2_rest_i,
    input  logic [gridrt_state_pkg::REST_W:0]                 s2_slope_i,
    input  logic [gridrt_state_pkg::EDGE_W-1:0]               s2_edge_i,
    input  logic [2:0]                                        s3_ahead_i,  // 1 .. 7
    output logic [8:0][3:0]                                   s7_sample_o,
    output logic [gridrt_state_pkg::REST_W-1:0]               s9_rest_o,
    output logic [5:0]                                        s9_quarters_o  // passed
);
  localparam int unsigned REST_W = gridrt_state_pkg::REST_W;
  localparam int unsigned EDGE_W = gridrt_state_pkg::EDGE_W;
  localparam int unsigned SHIFT = gridrt_state_pkg::UNIT_SHIFT;
  localparam int unsigned SIGN = REST_W + 1;  // of positions at the samples
  localparam int unsigned PAIRS = 4;

  // Whether a quarter lies before P0's; and a quarter held between P0's and P1's.
  function automatic logic below(logic [4:0] quarter, logic [2:0] low);
    below = quarter[4] || quarter[3:0] < {1'b0, low};
  endfunction
  function automatic logic [3:0] held(logic [4:0] quarter, logic [2:0] low, logic [3:0] limit);
    held = below(quarter, low) ? {1'b0, low} : quarter[3:0];
    if (held > limit) held = limit;
  endfunction

  // Clock 2: the increment with one quarter taken off. Below SHIFT it is the slope.
  // Then two samples a clock, in clocks 3 to 6: index p of what follows is that of clock 3 + p.
  logic [PAIRS-1:0][SIGN-SHIFT:0] one;
  logic [PAIRS-1:0][REST_W:0] slope;
  logic [PAIRS-1:0][SIGN:0] at, first, second;
  logic [PAIRS-1:1][SIGN:0] reached;
  logic [PAIRS-1:0][4:0] quarter;  // of the last sample before, signed
  logic [PAIRS-1:0][2:0] low;
  logic [PAIRS-1:0][3:0] limit;
  logic [REST_W-1:0] s3_rest;
  logic [EDGE_W-1:0] s3_edge, s4_edge;
  assign at = {reached, 2'b00, s3_rest};
  // A position that is not negative goes on by the increment less a quarter; a negative one stands for
  // that plus a quarter, and goes on by the increment. Where what comes out is not negative, the ray has
  // come to the next quarter.
  for (genvar p = 0; p < PAIRS; p++) begin : gen_pair
    logic [SIGN:0] whole, less;
    assign whole = {1'b0, slope[p]};
    assign less = {one[p], slope[p][SHIFT-1:0]};
    gridrt_add_mux #(
        .WIDTH(SIGN + 1)
    ) i_first (
        .first_i(at[p][SIGN]),
        .a_i(at[p]),
        .b_i(whole),
        .c_i(less),
        .sum_o(first[p])
    );
    gridrt_add_mux #(
        .WIDTH(SIGN + 1)
    ) i_second (
        .first_i(first[p][SIGN]),
        .a_i(first[p]),
        .b_i(whole),
        .c_i(less),
        .sum_o(second[p])
    );
  end
  always_ff @(posedge clk_i) begin
    if (valid_i[0]) begin
      one[0] <= {1'b0, s2_slope_i[REST_W:SHIFT]} - {1'b0, s2_edge_i};
      slope[0] <= s2_slope_i;
      s3_rest <= s2_rest_i;
      quarter[0] <= {s2_quarter_i[3], s2_quarter_i};
      low[0] <= s2_low_i;
      limit[0] <= (s2_limit_i[gridrt_pkg::AXIS_W:4] != '0) ? 4'd15 : s2_limit_i[3:0];
      s3_edge <= s2_edge_i;
    end
    if (valid_i[1]) s4_edge <= s3_edge;
    for (int unsigned p = 1; p < PAIRS; p++) begin
      if (valid_i[p]) begin
        one[p] <= one[p-1];
        slope[p] <= slope[p-1];
        reached[p] <= second[p-1];
        quarter[p] <= quarter[p-1] + 5'(!first[p-1][SIGN]) + 5'(!second[p-1][SIGN]);
        low[p] <= low[p-1];
        limit[p] <= limit[p-1];
      end
    end
  end

  // The samples of a clock are told apart by the signs alone, so the choices are held before: where the
  // last clock's second sample is, and one and two quarters on. Below P0's quarter and at P1's a sample
  // does not move.
  logic [PAIRS-1:0][3:0] plus_0, plus_1, plus_2;
  logic [PAIRS-1:0][1:0][3:0] pair;
  logic [2:0][3:0] s4_sample;
  logic [4:0][3:0] s5_sample;
  logic [6:0][3:0] s6_sample;
  assign plus_0 = {s6_sample[6], s5_sample[4], s4_sample[2], held(quarter[0], low[0], limit[0])};
  always_comb begin
    for (int unsigned p = 0; p < PAIRS; p++) begin
      plus_1[p] = plus_0[p] + 4'(!below(quarter[p], low[p]) && plus_0[p] != limit[p]);
      plus_2[p] = plus_1[p] + 4'(!below(quarter[p] + 5'd1, low[p]) && plus_1[p] != limit[p]);
      pair[p][0] = first[p][SIGN] ? plus_0[p] : plus_1[p];
      pair[p][1] = (first[p][SIGN] && second[p][SIGN]) ? plus_0[p]
                 : (first[p][SIGN] || second[p][SIGN]) ? plus_1[p] : plus_2[p];
    end
  end
  always_ff @(posedge clk_i) begin
    if (valid_i[1]) s4_sample <= {pair[0], plus_0[0]};
    if (valid_i[2]) s5_sample <= {pair[1], s4_sample};
    if (valid_i[3]) s6_sample <= {pair[2], s5_sample};
    if (valid_i[4]) s7_sample_o <= {pair[3], s6_sample};
  end

  gridrt_march_ahead i_ahead (
      .clk_i,
      .valid_i(valid_i[6:1]),
      .s3_ahead_i,
      .s3_rest_i(s3_rest),
      .s3_slope_i(slope[0]),
      .s4_slope_i(slope[1]),
      .s4_edge_i(s4_edge),
      .s9_rest_o,
      .s9_quarters_o
  );

  // Of the last sample the sign alone is needed.
  logic unused;
  assign unused = &{1'b0, second};
endmodule
