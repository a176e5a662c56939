// Where a ray is on a lateral axis when it has gone on by one to seven block-slabs, clocks 3 to 9 of a
// step: the position after 8 ahead increments, as quarters of voxels passed and the rest. A division
// that does not restore: quarters are taken off a position that is not negative and given back to a
// negative one, 32 of them, then 16, 8, 4, 2 and 1.
module gridrt_march_ahead (
    input  logic                                clk_i,
    input  logic [5:0]                          valid_i,     // of clocks 8 to 3
    input  logic [2:0]                          s3_ahead_i,  // 1 .. 7
    input  logic [gridrt_state_pkg::REST_W-1:0] s3_rest_i,
    input  logic [gridrt_state_pkg::REST_W:0]   s3_slope_i,
    input  logic [gridrt_state_pkg::REST_W:0]   s4_slope_i,
    input  logic [gridrt_state_pkg::EDGE_W-1:0] s4_edge_i,
    output logic [gridrt_state_pkg::REST_W-1:0] s9_rest_o,
    output logic [5:0]                          s9_quarters_o
);
  localparam int unsigned REST_W = gridrt_state_pkg::REST_W;
  localparam int unsigned EDGE_W = gridrt_state_pkg::EDGE_W;
  localparam int unsigned SHIFT = gridrt_state_pkg::UNIT_SHIFT;
  localparam int unsigned FAR_W = REST_W + 6;  // a position up to 57 quarters ahead
  localparam int unsigned HIGH_W = REST_W - SHIFT;

  // Clock 3: `ahead` is 4 times 0, 1 or 2 plus -1, 0, 1 or 2. The second part first.
  logic [FAR_W-4:0] part;
  logic [FAR_W-1:0] s4_part;  // signed
  logic [1:0] s4_fours;
  gridrt_add_sub #(
      .WIDTH(FAR_W - 3)
  ) i_part (
      .sub_i(s3_ahead_i[1:0] == 2'd3),
      .a_i  ({6'b0, s3_rest_i[REST_W-1:3]}),
      .b_i  ({1'b0, (s3_ahead_i[0] ? {1'b0, s3_slope_i} : '0) |
              ((s3_ahead_i[1:0] == 2'd2) ? {s3_slope_i, 1'b0} : '0)}),
      .sum_o(part)
  );
  always_ff @(posedge clk_i) begin
    if (valid_i[0]) begin
      s4_part <= {part, s3_rest_i[2:0]};
      s4_fours <= {s3_ahead_i == 3'd7, s3_ahead_i[2] ^ (s3_ahead_i[1:0] == 2'd3)};
    end
  end

  // Clock 4: the first part. Multiples of a quarter have no bits below SHIFT.
  logic [FAR_W-6:0] far, s5_far;  // above the lowest five bits
  logic [4:0] s5_lowest;
  logic [EDGE_W-1:0] s5_edge, s6_edge, s7_edge, s8_edge;
  assign far = s4_part[FAR_W-1:5] + ((s4_fours[0] ? s4_slope_i : '0) |
                                     (s4_fours[1] ? {s4_slope_i[REST_W-1:0], 1'b0} : '0));
  always_ff @(posedge clk_i) begin
    if (valid_i[1]) begin
      s5_far <= far;
      s5_lowest <= s4_part[4:0];
      s5_edge <= s4_edge_i;
    end
  end

  // Clock 5: 32 and 16 quarters off. What is at most n quarters away from 0 needs two bits more than n
  // edges.
  logic [EDGE_W-1:0] less_32, sum_16, sum_8, sum_4, sum_2, sum_1;
  logic [SHIFT-1:0] s6_low, s7_low, s8_low;
  assign less_32 = s5_far[FAR_W-6:SHIFT] - s5_edge;
  gridrt_add_sub #(
      .WIDTH(EDGE_W)
  ) i_16 (
      .sub_i(!less_32[EDGE_W-1]),
      .a_i  ({less_32[EDGE_W-2:0], s5_far[SHIFT-1]}),
      .b_i  (s5_edge),
      .sum_o(sum_16)
  );
  logic [EDGE_W+3:0] s6_at;
  logic [5:4] s6_quarters;
  always_ff @(posedge clk_i) begin
    if (valid_i[2]) begin
      s6_at <= {sum_16, s5_far[SHIFT-2:SHIFT-5]};
      s6_quarters <= ~{less_32[EDGE_W-1], sum_16[EDGE_W-1]};
      s6_low <= {s5_far[SHIFT-6:0], s5_lowest};
      s6_edge <= s5_edge;
    end
  end

  // Clock 6: 8 and 4.
  gridrt_add_sub #(
      .WIDTH(EDGE_W)
  ) i_8 (
      .sub_i(!s6_at[EDGE_W+3]),
      .a_i  (s6_at[EDGE_W+2:3]),
      .b_i  (s6_edge),
      .sum_o(sum_8)
  );
  gridrt_add_sub #(
      .WIDTH(EDGE_W)
  ) i_4 (
      .sub_i(!sum_8[EDGE_W-1]),
      .a_i  ({sum_8[EDGE_W-2:0], s6_at[2]}),
      .b_i  (s6_edge),
      .sum_o(sum_4)
  );
  logic [EDGE_W+1:0] s7_at;
  logic [5:2] s7_quarters;
  always_ff @(posedge clk_i) begin
    if (valid_i[3]) begin
      s7_at <= {sum_4, s6_at[1:0]};
      s7_quarters <= {s6_quarters, ~{sum_8[EDGE_W-1], sum_4[EDGE_W-1]}};
      s7_low <= s6_low;
      s7_edge <= s6_edge;
    end
  end

  // Clock 7: 2 and 1.
  gridrt_add_sub #(
      .WIDTH(EDGE_W)
  ) i_2 (
      .sub_i(!s7_at[EDGE_W+1]),
      .a_i  (s7_at[EDGE_W:1]),
      .b_i  (s7_edge),
      .sum_o(sum_2)
  );
  gridrt_add_sub #(
      .WIDTH(EDGE_W)
  ) i_1 (
      .sub_i(!sum_2[EDGE_W-1]),
      .a_i  ({sum_2[EDGE_W-2:0], s7_at[0]}),
      .b_i  (s7_edge),
      .sum_o(sum_1)
  );
  logic [EDGE_W-1:0] s8_at;
  logic [5:0] s8_quarters;
  always_ff @(posedge clk_i) begin
    if (valid_i[4]) begin
      s8_at <= sum_1;
      s8_quarters <= {s7_quarters, ~{sum_2[EDGE_W-1], sum_1[EDGE_W-1]}};
      s8_low <= s7_low;
      s8_edge <= s7_edge;
    end
  end

  // Clock 8: the rest is not negative.
  logic [HIGH_W-1:0] high;
  gridrt_add_gated #(
      .WIDTH(HIGH_W)
  ) i_rest (
      .a_valid_i(1'b1),
      .a_i(s8_at[HIGH_W-1:0]),
      .b_valid_i(s8_at[EDGE_W-1]),
      .b_i(s8_edge[HIGH_W-1:0]),
      .sum_o(high)
  );
  always_ff @(posedge clk_i) begin
    if (valid_i[5]) begin
      s9_rest_o <= {high, s8_low};
      s9_quarters_o <= s8_quarters;
    end
  end

  logic unused;
  assign unused = &{1'b0, s8_at, s8_edge};
endmodule
