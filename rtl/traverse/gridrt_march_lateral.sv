// The march on one lateral axis, clocks 2 to 7 of a step: the half-voxels in which the ray is at the
// five half-slab faces of a block-slab, and its position where the next block-slab to be looked at
// begins, one to seven of them ahead. The position is rest + slope per half-slab, modulo a half-voxel
// of edge * 2^UNIT_SHIFT; no increment is longer than a half-voxel.
module gridrt_march_lateral (
    input  logic                                              clk_i,
    input  logic [4:0]                                        valid_i,     // of clocks 6 to 2
    input  logic [2:0]                                        s2_half_i,   // signed
    input  logic [1:0]                                        s2_low_i,
    input  logic [gridrt_pkg::AXIS_W-1:0]                     s2_limit_i,
    input  logic [gridrt_state_pkg::REST_W-1:0]               s2_rest_i,
    input  logic [gridrt_state_pkg::REST_W:0]                 s2_slope_i,
    input  logic [gridrt_state_pkg::EDGE_W-1:0]               s2_edge_i,
    input  logic [2:0]                                        s3_ahead_i,  // 1 .. 7
    output logic [4:0][2:0]                                   s5_sample_o,
    output logic [gridrt_state_pkg::REST_W-1:0]               s7_rest_o,
    output logic [4:0]                                        s7_halves_o  // half-voxels passed
);
  localparam int unsigned REST_W = gridrt_state_pkg::REST_W;
  localparam int unsigned EDGE_W = gridrt_state_pkg::EDGE_W;
  localparam int unsigned SHIFT = gridrt_state_pkg::UNIT_SHIFT;
  localparam int unsigned SIGN = REST_W + 1;  // of positions at the samples

  // Clock 2: the increment of one half-slab with one half-voxel taken off. Below SHIFT it is the slope.
  logic [SIGN-SHIFT:0] s3_one, s4_one;
  logic [REST_W-1:0] s3_rest;
  logic [REST_W:0] s3_slope, s4_slope;
  logic [2:0] s3_half, s3_limit, s4_limit;
  logic [1:0] s3_low, s4_low;
  logic [EDGE_W-1:0] s3_edge, s4_edge;
  always_ff @(posedge clk_i) begin
    if (valid_i[0]) begin
      s3_one <= {1'b0, s2_slope_i[REST_W:SHIFT]} - {1'b0, s2_edge_i};
      s3_rest <= s2_rest_i;
      s3_slope <= s2_slope_i;
      s3_half <= s2_half_i;
      s3_low <= s2_low_i;
      s3_limit <= (s2_limit_i[gridrt_pkg::AXIS_W-1:3] != '0) ? 3'd7 : s2_limit_i[2:0];
      s3_edge <= s2_edge_i;
    end
  end

  // A position that is not negative goes on by the increment less a half-voxel; a negative one stands
  // for that plus a half-voxel, and goes on by the increment. Where what comes out is not negative, the
  // ray has come to the next half-voxel.
  function automatic logic [SIGN:0] on(logic [SIGN:0] at, logic [SIGN-SHIFT:0] one,
                                       logic [REST_W:0] slope);
    on = at + {at[SIGN] ? {1'b0, slope[REST_W:SHIFT]} : one, slope[SHIFT-1:0]};
  endfunction

  // Clock 3: the first two samples.
  logic [SIGN:0] first, second, s4_second;
  logic [3:0] s4_half_0, s4_half_1, s4_half_2;  // signed, -4 .. 5
  assign first = {2'b00, s3_rest} + {s3_one, s3_slope[SHIFT-1:0]};
  assign second = on(first, s3_one, s3_slope);
  always_ff @(posedge clk_i) begin
    if (valid_i[1]) begin
      s4_one <= s3_one;
      s4_slope <= s3_slope;
      s4_low <= s3_low;
      s4_limit <= s3_limit;
      s4_half_0 <= {s3_half[2], s3_half};
      s4_half_1 <= {s3_half[2], s3_half} + 4'(!first[SIGN]);
      s4_half_2 <= {s3_half[2], s3_half} + 4'(!first[SIGN]) + 4'(!second[SIGN]);
      s4_second <= second;
      s4_edge <= s3_edge;
    end
  end

  // Clock 4: the last two, from the second; all held between P0's half and P1's.
  function automatic logic [2:0] held(logic [3:0] half, logic [1:0] low, logic [2:0] limit);
    held = half[2:0];
    if (half[3] || half[2:0] < {1'b0, low}) held = {1'b0, low};
    if (held > limit) held = limit;
  endfunction
  logic [SIGN:0] third, fourth;
  logic [2:0] plus_0, plus_1, plus_2;
  always_comb begin
    third = on(s4_second, s4_one, s4_slope);
    fourth = on(third, s4_one, s4_slope);
    plus_0 = held(s4_half_2, s4_low, s4_limit);
    plus_1 = held(s4_half_2 + 4'd1, s4_low, s4_limit);
    plus_2 = held(s4_half_2 + 4'd2, s4_low, s4_limit);
  end
  always_ff @(posedge clk_i) begin
    if (valid_i[2]) begin
      s5_sample_o[0] <= held(s4_half_0, s4_low, s4_limit);
      s5_sample_o[1] <= held(s4_half_1, s4_low, s4_limit);
      s5_sample_o[2] <= plus_0;
      s5_sample_o[3] <= third[SIGN] ? plus_0 : plus_1;
      s5_sample_o[4] <= (third[SIGN] && fourth[SIGN]) ? plus_0
                      : (third[SIGN] || fourth[SIGN]) ? plus_1 : plus_2;
    end
  end

  gridrt_march_ahead i_ahead (
      .clk_i,
      .valid_i(valid_i[4:1]),
      .s3_ahead_i,
      .s3_rest_i(s3_rest),
      .s3_slope_i(s3_slope),
      .s4_slope_i(s4_slope),
      .s4_edge_i(s4_edge),
      .s7_rest_o,
      .s7_halves_o
  );

  // Of the last sample the sign alone is needed.
  logic unused;
  assign unused = &{1'b0, fourth};
endmodule
