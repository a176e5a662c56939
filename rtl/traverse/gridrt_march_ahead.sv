// Where a ray is on a lateral axis when it has gone on by one to seven block-slabs, clocks 3 to 7 of a
// step: the position after 4 ahead increments, as half-voxels passed and the rest. A division that
// does not restore: half-voxels are taken off a position that is not negative and given back to a
// negative one, 16 of them, then 8, 4, 2 and 1.
module gridrt_march_ahead (
    input  logic                                clk_i,
    input  logic [3:0]                          valid_i,     // of clocks 6 to 3
    input  logic [2:0]                          s3_ahead_i,  // 1 .. 7
    input  logic [gridrt_state_pkg::REST_W-1:0] s3_rest_i,
    input  logic [gridrt_state_pkg::REST_W:0]   s3_slope_i,
    input  logic [gridrt_state_pkg::REST_W:0]   s4_slope_i,
    input  logic [gridrt_state_pkg::EDGE_W-1:0] s4_edge_i,
    output logic [gridrt_state_pkg::REST_W-1:0] s7_rest_o,
    output logic [4:0]                          s7_halves_o
);
  localparam int unsigned REST_W = gridrt_state_pkg::REST_W;
  localparam int unsigned EDGE_W = gridrt_state_pkg::EDGE_W;
  localparam int unsigned SHIFT = gridrt_state_pkg::UNIT_SHIFT;
  localparam int unsigned FAR_W = REST_W + 5;  // a position up to 29 half-voxels ahead
  localparam int unsigned HIGH_W = REST_W - SHIFT;

  // Clock 3: `ahead` is 4 times 0, 1 or 2 plus -1, 0, 1 or 2. The second part first.
  logic [FAR_W-3:0] part;
  logic [FAR_W-1:0] s4_part;  // signed
  logic [1:0] s4_fours;
  gridrt_add_sub #(
      .WIDTH(FAR_W - 2)
  ) i_part (
      .sub_i(s3_ahead_i[1:0] == 2'd3),
      .a_i  ({5'b0, s3_rest_i[REST_W-1:2]}),
      .b_i  ({1'b0, (s3_ahead_i[0] ? {1'b0, s3_slope_i} : '0) |
              ((s3_ahead_i[1:0] == 2'd2) ? {s3_slope_i, 1'b0} : '0)}),
      .sum_o(part)
  );
  always_ff @(posedge clk_i) begin
    if (valid_i[0]) begin
      s4_part <= {part, s3_rest_i[1:0]};
      s4_fours <= {s3_ahead_i == 3'd7, s3_ahead_i[2] ^ (s3_ahead_i[1:0] == 2'd3)};
    end
  end

  // Clock 4: the first part; 16 half-voxels off. Multiples of a half-voxel have no bits below SHIFT.
  logic [FAR_W-5:0] far;  // above the lowest four bits
  logic [EDGE_W-1:0] less_16;
  logic [EDGE_W+3:0] s5_at;
  logic [SHIFT-1:0] s5_low, s6_low;
  logic [EDGE_W-1:0] s5_edge, s6_edge;
  assign far = s4_part[FAR_W-1:4] + ((s4_fours[0] ? s4_slope_i : '0) |
                                     (s4_fours[1] ? {s4_slope_i[REST_W-1:0], 1'b0} : '0));
  assign less_16 = far[FAR_W-5:SHIFT] - s4_edge_i;
  always_ff @(posedge clk_i) begin
    if (valid_i[1]) begin
      s5_at <= {less_16, far[SHIFT-1:SHIFT-4]};
      s5_low <= {far[SHIFT-5:0], s4_part[3:0]};
      s5_edge <= s4_edge_i;
    end
  end

  // Clock 5: 8, 4 and 2. What is at most n half-voxels away from 0 needs two bits more than n edges.
  logic [EDGE_W-1:0] sum_8, sum_4, sum_2, sum_1;
  gridrt_add_sub #(
      .WIDTH(EDGE_W)
  ) i_8 (
      .sub_i(!s5_at[EDGE_W+3]),
      .a_i  (s5_at[EDGE_W+2:3]),
      .b_i  (s5_edge),
      .sum_o(sum_8)
  );
  gridrt_add_sub #(
      .WIDTH(EDGE_W)
  ) i_4 (
      .sub_i(!sum_8[EDGE_W-1]),
      .a_i  ({sum_8[EDGE_W-2:0], s5_at[2]}),
      .b_i  (s5_edge),
      .sum_o(sum_4)
  );
  gridrt_add_sub #(
      .WIDTH(EDGE_W)
  ) i_2 (
      .sub_i(!sum_4[EDGE_W-1]),
      .a_i  ({sum_4[EDGE_W-2:0], s5_at[1]}),
      .b_i  (s5_edge),
      .sum_o(sum_2)
  );
  logic [EDGE_W:0] s6_at;
  logic [4:1] s6_halves;
  always_ff @(posedge clk_i) begin
    if (valid_i[2]) begin
      s6_at <= {sum_2, s5_at[0]};
      s6_halves <= ~{s5_at[EDGE_W+3], sum_8[EDGE_W-1], sum_4[EDGE_W-1], sum_2[EDGE_W-1]};
      s6_low <= s5_low;
      s6_edge <= s5_edge;
    end
  end

  // Clock 6: 1, and the rest is not negative.
  logic [HIGH_W-1:0] high;
  gridrt_add_sub #(
      .WIDTH(EDGE_W)
  ) i_1 (
      .sub_i(!s6_at[EDGE_W]),
      .a_i  (s6_at[EDGE_W-1:0]),
      .b_i  (s6_edge),
      .sum_o(sum_1)
  );
  assign high = sum_1[HIGH_W-1:0] + (s6_edge[HIGH_W-1:0] & {HIGH_W{sum_1[EDGE_W-1]}});
  always_ff @(posedge clk_i) begin
    if (valid_i[3]) begin
      s7_rest_o <= {high, s6_low};
      s7_halves_o <= {s6_halves, !sum_1[EDGE_W-1]};
    end
  end
endmodule
