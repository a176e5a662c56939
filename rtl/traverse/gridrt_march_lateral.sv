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
    input  logic [gridrt_state_pkg::EDGE_W+1:0]               s2_edge3_i,
    input  logic [2:0]                                        s3_ahead_i,  // 1 .. 7
    output logic [4:0][2:0]                                   s5_sample_o,
    output logic [gridrt_state_pkg::REST_W-1:0]               s7_rest_o,
    output logic [4:0]                                        s7_halves_o  // half-voxels passed
);
  localparam int unsigned REST_W = gridrt_state_pkg::REST_W;
  localparam int unsigned EDGE_W = gridrt_state_pkg::EDGE_W;
  localparam int unsigned SHIFT = gridrt_state_pkg::UNIT_SHIFT;
  localparam int unsigned SIGN = REST_W + 2;  // of sums of the samples
  localparam int unsigned FAR_W = REST_W + 5;  // a position up to 29 half-voxels ahead

  // Clock 2: increments with one half-voxel taken off: of one half-slab and of two.
  logic [SIGN:0] s3_one, s3_two, s4_one, s4_two;
  logic [REST_W-1:0] s3_rest, s4_rest;
  logic [REST_W:0] s3_slope;
  logic [REST_W+2:0] s3_slope3;
  logic [2:0] s3_half, s3_limit, s4_limit;
  logic [1:0] s3_low, s4_low;
  logic [EDGE_W-1:0] s3_edge, s4_edge, s5_edge, s6_edge;
  logic [EDGE_W+1:0] s3_edge3, s4_edge3, s5_edge3, s6_edge3;
  always_ff @(posedge clk_i) begin
    if (valid_i[0]) begin
      s3_one <= {2'b00, s2_slope_i} - {2'b00, s2_edge_i, SHIFT'(0)};
      s3_two <= {1'b0, s2_slope_i, 1'b0} - {2'b00, s2_edge_i, SHIFT'(0)};
      s3_rest <= s2_rest_i;
      s3_slope <= s2_slope_i;
      s3_slope3 <= {2'b00, s2_slope_i} + {1'b0, s2_slope_i, 1'b0};
      s3_half <= s2_half_i;
      s3_low <= s2_low_i;
      s3_limit <= (s2_limit_i[gridrt_pkg::AXIS_W-1:3] != '0) ? 3'd7 : s2_limit_i[2:0];
      s3_edge <= s2_edge_i;
      s3_edge3 <= s2_edge3_i;
    end
  end

  // Clock 3: the first two samples.
  logic [SIGN:0] first, second_1, second_2;
  logic [REST_W-1:0] second_0;
  always_comb begin
    first = {3'b000, s3_rest} + s3_one;
    second_0 = s3_rest + {s3_slope[REST_W-2:0], 1'b0};  // taken if it fits
    second_1 = {3'b000, s3_rest} + s3_two;
    second_2 = {3'b000, s3_rest} + {s3_one[SIGN-1:0], 1'b0};
  end
  logic [REST_W-1:0] s4_second;
  logic [3:0] s4_half_0, s4_half_1, s4_half_2;  // signed, -4 .. 5
  always_ff @(posedge clk_i) begin
    if (valid_i[1]) begin
      s4_one <= s3_one;
      s4_two <= s3_two;
      s4_low <= s3_low;
      s4_limit <= s3_limit;
      s4_rest <= s3_rest;
      s4_half_0 <= {s3_half[2], s3_half};
      s4_half_1 <= {s3_half[2], s3_half} + 4'(!first[SIGN]);
      s4_half_2 <= {s3_half[2], s3_half} + 4'(!second_1[SIGN]) + 4'(!second_2[SIGN]);
      s4_second <= !second_2[SIGN] ? second_2[REST_W-1:0]
                 : !second_1[SIGN] ? second_1[REST_W-1:0] : second_0;
      s4_edge <= s3_edge;
      s4_edge3 <= s3_edge3;
    end
  end

  // Clock 4: the last two, from the second; all held between P0's half and P1's.
  function automatic logic [2:0] held(logic [3:0] half, logic [1:0] low, logic [2:0] limit);
    held = half[2:0];
    if (half[3] || half[2:0] < {1'b0, low}) held = {1'b0, low};
    if (held > limit) held = limit;
  endfunction
  logic [SIGN:0] third, fourth_1, fourth_2;
  logic [2:0] plus_0, plus_1, plus_2;
  always_comb begin
    third = {3'b000, s4_second} + s4_one;
    fourth_1 = {3'b000, s4_second} + s4_two;
    fourth_2 = {3'b000, s4_second} + {s4_one[SIGN-1:0], 1'b0};
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
      s5_sample_o[4] <= fourth_1[SIGN] ? plus_0 : fourth_2[SIGN] ? plus_1 : plus_2;
    end
  end

  // Clocks 3 to 6: 4 ahead increments on, then half-voxels off: 16, then up to 3 times 4, then up to 3.
  logic [REST_W+2:0] few, s4_ahead;  // few: 0 to 3 increments
  always_comb begin
    case (s3_ahead_i[1:0])
      2'd0: few = '0;
      2'd1: few = {2'b00, s3_slope};
      2'd2: few = {1'b0, s3_slope, 1'b0};
      default: few = s3_slope3;
    endcase
  end
  logic [FAR_W-1:0] far;
  logic [FAR_W-SHIFT:0] s4_less;  // without the bits that multiples of a half-voxel do not have
  logic [2:0][FAR_W-SHIFT:0] s5_less;
  logic [2:0][REST_W-SHIFT+2:0] s6_less;
  logic [FAR_W-1:0] s5_far;
  logic [REST_W+1:0] s6_far;
  logic s5_16, s6_16;
  logic [1:0] s6_4, s5_4, s6_1;
  logic [REST_W-SHIFT+1:0] s5_high;
  logic [REST_W-SHIFT-1:0] s6_high;
  always_comb begin
    far = {5'b0, s4_rest} + {s4_ahead, 2'b00};
    s4_less = {1'b0, far[FAR_W-1:SHIFT]} - {1'b0, s4_edge, 4'b0};

    s5_less[0] = {1'b0, s5_far[FAR_W-1:SHIFT]} - {3'b000, s5_edge, 2'b00};
    s5_less[1] = {1'b0, s5_far[FAR_W-1:SHIFT]} - {2'b00, s5_edge, 3'b000};
    s5_less[2] = {1'b0, s5_far[FAR_W-1:SHIFT]} - {1'b0, s5_edge3, 2'b00};
    s5_4 = 2'd0;
    s5_high = s5_far[REST_W+1:SHIFT];
    for (int unsigned i = 0; i < 3; i++) begin
      if (!s5_less[i][FAR_W-SHIFT]) begin
        s5_4 = 2'(i + 1);
        s5_high = s5_less[i][REST_W-SHIFT+1:0];
      end
    end

    s6_less[0] = {1'b0, s6_far[REST_W+1:SHIFT]} - {2'b00, s6_edge};
    s6_less[1] = {1'b0, s6_far[REST_W+1:SHIFT]} - {1'b0, s6_edge, 1'b0};
    s6_less[2] = {1'b0, s6_far[REST_W+1:SHIFT]} - s6_edge3;
    s6_1 = 2'd0;
    s6_high = s6_far[REST_W-1:SHIFT];
    for (int unsigned i = 0; i < 3; i++) begin
      if (!s6_less[i][REST_W-SHIFT+2]) begin
        s6_1 = 2'(i + 1);
        s6_high = s6_less[i][REST_W-SHIFT-1:0];
      end
    end
  end
  always_ff @(posedge clk_i) begin
    if (valid_i[1]) s4_ahead <= few + (s3_ahead_i[2] ? {s3_slope, 2'b00} : '0);
    if (valid_i[2]) begin
      s5_16 <= !s4_less[FAR_W-SHIFT];
      s5_far <= {s4_less[FAR_W-SHIFT] ? far[FAR_W-1:SHIFT] : s4_less[FAR_W-SHIFT-1:0],
                 far[SHIFT-1:0]};
      s5_edge <= s4_edge;
      s5_edge3 <= s4_edge3;
    end
    if (valid_i[3]) begin
      s6_16 <= s5_16;
      s6_4 <= s5_4;
      s6_far <= {s5_high, s5_far[SHIFT-1:0]};
      s6_edge <= s5_edge;
      s6_edge3 <= s5_edge3;
    end
    if (valid_i[4]) begin
      s7_rest_o <= {s6_high, s6_far[SHIFT-1:0]};
      s7_halves_o <= {s6_16, s6_4, s6_1};
    end
  end
endmodule
