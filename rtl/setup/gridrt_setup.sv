// Ray setup: from a segment's two ends to the state in which its traversal starts, one ray in two
// clocks, 31 clocks long. It stands still while its result is not taken.
//
//   clock  1- 4  lengths and signs; mirrored ends
//          4-10  quarters of voxels of both ends on each axis (dividers); meanwhile the dominant axis: the
//                one with the largest length / edge, compared by cross products
//         10-25  increments per quarter-slab and for the first, partial one (dividers); block address
//         24-31  back from the first quarter-face to the block's entry face, where traversal starts
//
// What is done twice for a ray is done by the same logic in two clocks in a row: for P0, then P1; for
// the first lateral axis, then the second. Registers are named after the clock at whose end they are
// loaded with (the first half of) a ray. Those that hold what both halves share are loaded in every
// second clock: `odd` is 0 while a ray may enter, that is before its odd clocks, and 1 before its
// even ones.
//
// 8 multipliers: three for the cross products, which are the increments' dividends as well, one for
// the partial quarter-slab, one for the block address, one for its entry face, two for the way back.
// What is needed later rides along in distributed memory (gridrt_delay).
module gridrt_setup #(
    parameter int unsigned B = 17  // lattice bits
) (
    input  logic                                                  clk_i,
    input  logic                                                  rst_ni,
    input  gridrt_state_pkg::grid_t                               grid_i,
    input  logic                                                  ray_valid_i,
    output logic                                                  ray_ready_o,
    input  logic                     [2:0][           B-1:0]      p0_i,
    input  logic                     [2:0][           B-1:0]      p1_i,
    input  logic                     [gridrt_pkg::ID_W-1:0]       ignore_i,
    input  logic                                                  any_hit_i,
    output logic                                                  out_valid_o,
    input  logic                                                  out_ready_i,
    output gridrt_state_pkg::start_t                              start_o,
    output logic                     [2:0][           B-1:0]      p0_o,
    output logic                     [2:0][             B:0]      d_o,          // P1 - P0, signed
    output logic                     [               B-1:0]       length_o,     // of the dominant axis
    output logic                     [gridrt_pkg::ID_W-1:0]       ignore_o,
    output logic                                                  any_hit_o,
    output logic                                                  miss_o        // P0 == P1
);
  localparam int unsigned EDGE_W = gridrt_state_pkg::EDGE_W;
  localparam int unsigned SPAN_W = gridrt_state_pkg::SPAN_W;
  localparam int unsigned AXIS_W = gridrt_pkg::AXIS_W;
  localparam int unsigned ID_W = gridrt_pkg::ID_W;
  localparam int unsigned MAX_B = gridrt_pkg::MAX_B;
  localparam int unsigned UNIT_SHIFT = gridrt_state_pkg::UNIT_SHIFT;
  localparam int unsigned REST_W = gridrt_state_pkg::REST_W;
  localparam int unsigned PRODUCT_W = EDGE_W + MAX_B;
  localparam int unsigned SLOPE_W = REST_W + 1;
  localparam int unsigned PARTIAL_W = EDGE_W + 2;

  if (B < 4 || B > MAX_B) begin : gen_illegal
    $error("gridrt_setup: B must be 4 to 17");
  end
  if (gridrt_state_pkg::AXIS_W != AXIS_W || gridrt_state_pkg::BLOCK_W != gridrt_pkg::BLOCK_W ||
      gridrt_state_pkg::DIST_W != gridrt_pkg::DIST_W || EDGE_W != gridrt_pkg::DIST_W ||
      EDGE_W != MAX_B + 1 || SPAN_W != MAX_B + 2 || gridrt_state_pkg::SLABS_W != AXIS_W - 2 ||
      UNIT_SHIFT != gridrt_pkg::FRACTION - 2 || REST_W != MAX_B + UNIT_SHIFT)
  begin : gen_illegal_widths
    $error("gridrt_setup: gridrt_state_pkg and gridrt_pkg disagree about widths");
  end

  logic enable, odd, even_clock, odd_clock;
  logic [14:0] valid;  // after clocks 1, 3, .. 29, for two clocks each
  assign enable = !out_valid_o || out_ready_i;
  assign even_clock = enable && odd;
  assign odd_clock = enable && !odd;
  assign ray_ready_o = odd_clock;
  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      odd <= 1'b0;
      valid <= '0;
      out_valid_o <= 1'b0;
    end else if (enable) begin
      odd <= !odd;
      if (!odd) valid <= {valid[13:0], ray_valid_i};
      out_valid_o <= !odd && valid[14];
    end
  end

  // 1-4: lengths, signs, mirrored ends (four times the coordinate: quarters are counted).
  logic [2:0][B-1:0] s1_p0, s1_p1, s2_end;
  logic [ID_W-1:0] s1_ignore;
  logic s1_any;
  logic [2:0][B:0] s2_d;
  logic [2:0] s2_neg;
  logic [2:0][SPAN_W+1:0] s3_four;
  always_comb begin
    for (int unsigned a = 0; a < 3; a++) s2_neg[a] = s2_d[a][B];
  end
  always_ff @(posedge clk_i) begin
    if (odd_clock) begin
      s1_p0 <= p0_i;
      s1_p1 <= p1_i;
      s1_ignore <= ignore_i;
      s1_any <= any_hit_i;
    end
    if (even_clock) begin
      for (int unsigned a = 0; a < 3; a++) s2_d[a] <= {1'b0, s1_p1[a]} - {1'b0, s1_p0[a]};
    end
    if (enable) begin
      s2_end <= odd ? s1_p0 : s1_p1;
      for (int unsigned a = 0; a < 3; a++) begin
        s3_four[a] <= {s2_neg[a] ? grid_i.span[a] - SPAN_W'(s2_end[a]) : SPAN_W'(s2_end[a]), 2'b00};
      end
    end
  end

  // The dominant axis, which stays with the ray.
  logic [1:0] s8_axis, s9_axis, s10_axis, s12_axis, s14_axis, s24_axis, s25_axis;
  // The lateral axes, one after the other.
  logic [1:0] s10_lateral, s11_lateral, s12_lateral, s26_lateral;
  logic [MAX_B-1:0] s9_length, s11_length, s13_length, s12_length;
  logic [PRODUCT_W-1:0] s9_product;
  logic [2:0] s11_first, s12_first, s13_first, s24_first;
  gridrt_setup_axis #(
      .B(B)
  ) i_axis (
      .clk_i,
      .enable_i(enable),
      .odd_i(odd),
      .edges_i(grid_i.edges),
      .s2_d_i(s2_d),
      .s8_axis_o(s8_axis),
      .s9_axis_o(s9_axis),
      .s9_length_o(s9_length),
      .s10_lateral_o(s10_lateral),
      .s12_length_o(s12_length),
      .s9_product_o(s9_product)
  );
  always_ff @(posedge clk_i) begin
    if (even_clock) begin
      s10_axis  <= s8_axis;
      s12_axis  <= s10_axis;
      s12_first <= s11_first;
      s14_axis  <= s12_axis;
    end
    if (odd_clock) begin
      s11_length <= s9_length;
      s13_length <= s11_length;
      s13_first  <= s11_first;
      s25_axis   <= s24_axis;
    end
    if (enable) begin
      s11_lateral <= s10_lateral;
      s12_lateral <= s11_lateral;
    end
  end
  gridrt_delay #(
      .WIDTH (5),
      .CLOCKS(6)
  ) i_axis_late (
      .clk_i,
      .rst_ni,
      .enable_i(even_clock),  // 14 to 24
      .data_i({s12_axis, s12_first}),
      .data_o({s24_axis, s24_first})
  );
  gridrt_setup_lateral i_lateral (
      .clk_i,
      .enable_i(enable),
      .odd_i(odd),
      .axis_i(s25_axis),
      .lateral_o(s26_lateral)
  );

  logic [EDGE_W-1:0] s10_edge, s12_ahead;
  logic [2:0][AXIS_W-3:0] s10_block;
  logic [2:0][AXIS_W:0] s12_end;
  logic s11_far, s23_far;
  logic [2:0] s11_low, s23_low;
  logic [EDGE_W-2:0] s11_rest, s23_rest;
  gridrt_setup_ends i_ends (
      .clk_i,
      .rst_ni,
      .enable_i(enable),
      .odd_i(odd),
      .valid_i(valid[1]),
      .edges_i(grid_i.edges),
      .half_blocks_i(grid_i.half_blocks),
      .s3_four_i(s3_four),
      .s9_axis_i(s9_axis),
      .s10_axis_i(s10_axis),
      .s10_lateral_i(s10_lateral),
      .s10_edge_o(s10_edge),
      .s10_block_o(s10_block),
      .s11_first_o(s11_first),
      .s11_far_o(s11_far),
      .s11_low_o(s11_low),
      .s11_rest_o(s11_rest),
      .s12_ahead_o(s12_ahead),
      .s12_end_o(s12_end)
  );
  gridrt_delay #(
      .WIDTH (EDGE_W + 3),
      .CLOCKS(12)
  ) i_late (
      .clk_i,
      .rst_ni,
      .enable_i(enable),
      .data_i({s11_far, s11_low, s11_rest}),
      .data_o({s23_far, s23_low, s23_rest})
  );

  logic [PARTIAL_W-1:0] s23_partial;
  logic s24_moving;
  logic [SLOPE_W-1:0] s24_slope;
  gridrt_setup_increment i_increment (
      .clk_i,
      .rst_ni,
      .enable_i(enable),
      .s9_valid_i(valid[4]),
      .s9_product_i(s9_product),
      .s9_length_i(s9_length),
      .s12_ahead_i(s12_ahead),
      .s12_lateral_i(s12_length),
      .s13_valid_i(valid[6]),
      .s13_length_i(s13_length),
      .s23_partial_o(s23_partial),
      .s24_moving_o(s24_moving),
      .s24_slope_o(s24_slope)
  );

  gridrt_setup_back i_back (
      .clk_i,
      .rst_ni,
      .enable_i(enable),
      .edges_i(grid_i.edges),
      .s23_far_i(s23_far),
      .s23_low_i(s23_low),
      .s23_rest_i(s23_rest),
      .s23_partial_i(s23_partial),
      .s24_moving_i(s24_moving),
      .s24_slope_i(s24_slope),
      .s24_first_i(s24_first),
      .s26_lateral_i(s26_lateral),
      .s31_quarter_o(start_o.quarter),
      .s31_rest_o(start_o.rest),
      .s31_slope_o(start_o.slope),
      .s31_low_o(start_o.low)
  );

  gridrt_setup_block i_block (
      .clk_i,
      .rst_ni,
      .enable_i(enable),
      .odd_i(odd),
      .half_blocks_i(grid_i.half_blocks),
      .stride_i(grid_i.stride[2:1]),
      .s2_neg_i(s2_neg),
      .s10_block_i(s10_block),
      .s10_edge_i(s10_edge),
      .s11_first_i(s11_first),
      .s12_axis_i(s12_axis),
      .s12_lateral_i(s12_lateral),
      .s12_ahead_i(s12_ahead),
      .s12_end_i(s12_end),
      .s31_block_o(start_o.block),
      .s31_slabs_o(start_o.slabs),
      .s31_last_o(start_o.last),
      .s31_enter_o(start_o.enter),
      .s31_end_o(start_o.limit)
  );

  // The ray itself and what is known early, to the end.
  gridrt_delay #(
      .WIDTH (ID_W + 1 + 6 * B + 3),
      .CLOCKS(15)
  ) i_ray (
      .clk_i,
      .rst_ni,
      .enable_i(odd_clock),  // 3 to 31
      .data_i({s1_ignore, s1_any, s1_p0, s2_d}),
      .data_o({ignore_o, any_hit_o, p0_o, d_o})
  );
  gridrt_delay #(
      .WIDTH (B + 6),
      .CLOCKS(9)
  ) i_dominant (
      .clk_i,
      .rst_ni,
      .enable_i(odd_clock),  // 15 to 31
      .data_i({s13_length == '0, s13_length[B-1:0], s14_axis, s13_first}),
      .data_o({miss_o, length_o, start_o.axis, start_o.first})
  );
  always_comb begin
    for (int unsigned a = 0; a < 3; a++) start_o.neg[a] = d_o[a][B];
  end

  // Blocks are numbered from x on.
  logic unused;
  assign unused = &{1'b0, grid_i.stride[0]};

`ifdef GRIDRT_ASSERT
  always_ff @(posedge clk_i) begin
    if (rst_ni && enable && valid[4]) begin
      assert (s9_axis < 2'd3);
    end
    if (rst_ni && out_valid_o && !miss_o) begin
      assert (length_o != '0);
      assert (start_o.neg[start_o.axis] == d_o[start_o.axis][B]);
    end
  end
`endif
endmodule
