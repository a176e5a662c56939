// Ray setup: from a segment's two ends to the state in which its traversal starts, one ray a clock,
// 29 clocks long. It stands still while its result is not taken.
//
//   clock  1- 3  lengths and signs; mirrored ends
//          4- 9  half-voxels of both ends on each axis (dividers); meanwhile the dominant axis: the
//                one with the largest length / edge, compared by cross products
//         10-24  increments per half-slab and for the first, partial one (dividers); block address
//         25-29  back from the first half-face to the block's entry face, where traversal starts
//
// 8 multipliers: six cross products, which are the increments' dividends as well, two for the partial
// half-slab. What is needed later rides along in distributed memory (gridrt_delay).
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
  localparam int unsigned BLOCK_W = gridrt_pkg::BLOCK_W;
  localparam int unsigned DIST_W = gridrt_pkg::DIST_W;
  localparam int unsigned SLABS_W = gridrt_state_pkg::SLABS_W;
  localparam int unsigned ID_W = gridrt_pkg::ID_W;
  localparam int unsigned MAX_B = gridrt_pkg::MAX_B;
  localparam int unsigned UNIT_SHIFT = gridrt_state_pkg::UNIT_SHIFT;
  localparam int unsigned REST_W = gridrt_state_pkg::REST_W;
  localparam int unsigned HALF_W = AXIS_W + 1;  // half-voxels, 0 .. 1024
  localparam int unsigned PRODUCT_W = EDGE_W + MAX_B;
  localparam int unsigned SLOPE_W = REST_W + 1;
  localparam int unsigned LATENCY = 29;
  localparam int unsigned RAY_W = 6 * B + ID_W + 1;

  if (B < 4 || B > MAX_B) begin : gen_illegal
    $error("gridrt_setup: B must be 4 to 17");
  end
  if (gridrt_state_pkg::AXIS_W != AXIS_W || gridrt_state_pkg::BLOCK_W != BLOCK_W ||
      gridrt_state_pkg::DIST_W != DIST_W || EDGE_W != MAX_B + 1 || SPAN_W != MAX_B + 2 ||
      SLABS_W != AXIS_W - 2 || UNIT_SHIFT != gridrt_pkg::FRACTION - 1 ||
      REST_W != MAX_B + UNIT_SHIFT) begin : gen_illegal_widths
    $error("gridrt_setup: gridrt_state_pkg and gridrt_pkg disagree about widths");
  end

  logic enable;
  logic [LATENCY:1] valid;
  assign enable = !out_valid_o || out_ready_i;
  assign ray_ready_o = enable;
  assign out_valid_o = valid[LATENCY];
  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) valid <= '0;
    else if (enable) valid <= {valid[LATENCY-1:1], ray_valid_i};
  end

  // 1-3: lengths, signs, mirrored ends (twice the coordinate: half-voxels are counted).
  logic [2:0][B-1:0] s1_p0, s1_p1, s2_p0, s2_p1;
  logic [2:0][MAX_B-1:0] s2_length;
  logic [2:0] s2_neg, s3_neg;
  logic [2:0][SPAN_W:0] s3_start, s3_end;
  always_ff @(posedge clk_i) begin
    if (enable && ray_valid_i) begin
      s1_p0 <= p0_i;
      s1_p1 <= p1_i;
    end
    if (enable && valid[1]) begin
      s2_p0 <= s1_p0;
      s2_p1 <= s1_p1;
      for (int unsigned a = 0; a < 3; a++) begin
        s2_neg[a] <= s1_p1[a] < s1_p0[a];
        s2_length[a] <= (s1_p1[a] < s1_p0[a])
            ? MAX_B'(s1_p0[a]) - MAX_B'(s1_p1[a])
            : MAX_B'(s1_p1[a]) - MAX_B'(s1_p0[a]);
      end
    end
    if (enable && valid[2]) begin
      s3_neg <= s2_neg;
      for (int unsigned a = 0; a < 3; a++) begin
        s3_start[a] <= {s2_neg[a] ? grid_i.span[a] - SPAN_W'(s2_p0[a]) : SPAN_W'(s2_p0[a]), 1'b0};
        s3_end[a] <= {s2_neg[a] ? grid_i.span[a] - SPAN_W'(s2_p1[a]) : SPAN_W'(s2_p1[a]), 1'b0};
      end
    end
  end

  // 4-9: half-voxels and what remains.
  logic [2:0][HALF_W-1:0] s9_start, s9_end;
  logic [2:0][EDGE_W-1:0] s9_start_rest, s9_end_rest;
  for (genvar a = 0; a < 3; a++) begin : gen_half
    logic unused_start, unused_end;
    gridrt_divide_pipe #(
        .DIVIDEND_W(SPAN_W + 1),
        .DIVISOR_W(EDGE_W),
        .QUOTIENT_W(HALF_W),
        .STEP(2),
        .CONSTANT(1'b1)
    ) i_start (
        .clk_i,
        .rst_ni,
        .enable_i(enable),
        .valid_i(valid[3]),
        .dividend_i(s3_start[a]),
        .divisor_i(grid_i.edges[a]),
        .valid_o(unused_start),
        .quotient_o(s9_start[a]),
        .remainder_o(s9_start_rest[a])
    );
    gridrt_divide_pipe #(
        .DIVIDEND_W(SPAN_W + 1),
        .DIVISOR_W(EDGE_W),
        .QUOTIENT_W(HALF_W),
        .STEP(2),
        .CONSTANT(1'b1)
    ) i_end (
        .clk_i,
        .rst_ni,
        .enable_i(enable),
        .valid_i(valid[3]),
        .dividend_i(s3_end[a]),
        .divisor_i(grid_i.edges[a]),
        .valid_o(unused_end),
        .quotient_o(s9_end[a]),
        .remainder_o(s9_end_rest[a])
    );
    logic unused;
    assign unused = unused_start && unused_end;
  end

  // The dominant axis, with rotated lengths and dividends of the increments, in clock 9.
  logic [2:0] s9_neg;
  logic [1:0] s9_axis;
  logic [MAX_B-1:0] s9_length;
  logic [1:0][MAX_B-1:0] s9_lateral;
  logic [1:0][PRODUCT_W-1:0] s9_product;
  gridrt_setup_axis i_axis (
      .clk_i,
      .rst_ni,
      .enable_i(enable),
      .valid_i(valid[8:6]),
      .edges_i(grid_i.edges),
      .s2_length_i(s2_length),
      .s9_axis_o(s9_axis),
      .s9_length_o(s9_length),
      .s9_lateral_o(s9_lateral),
      .s9_product_o(s9_product)
  );
  gridrt_delay #(
      .WIDTH(3),
      .CLOCKS(6)
  ) i_neg (
      .clk_i,
      .rst_ni,
      .enable_i(enable),
      .data_i(s3_neg),
      .data_o(s9_neg)
  );

  // 10: everything in the order dominant axis, b, c; ends on the far face belong to the last half.
  logic [2:0] s10_neg;
  logic [1:0] s10_axis;
  logic [2:0][HALF_W-1:0] s10_start;
  logic [2:0][EDGE_W-1:0] s10_rest;
  logic [1:0] s10_far;  // per lateral axis: P0 on the far face
  logic [2:0][HALF_W-1:0] s10_end;
  logic [EDGE_W-1:0] s10_ahead;  // twice the distance to the next half-face
  logic [MAX_B-1:0] s10_length;
  logic [1:0][MAX_B-1:0] s10_lateral;
  logic [2:0][AXIS_W-3:0] s10_block;  // per axis x, y, z: block of P0, not mirrored
  logic [2:0] s9_far;
  logic [2:0][HALF_W-1:0] s9_start_in;
  always_comb begin
    for (int unsigned a = 0; a < 3; a++) begin
      s9_far[a] = s9_start[a] >= {grid_i.half_blocks[a][HALF_W-3:0], 2'b00};
      s9_start_in[a] = s9_start[a] - HALF_W'(s9_far[a]);
    end
  end
  always_ff @(posedge clk_i) begin
    if (enable && valid[9]) begin
      s10_neg <= s9_neg;
      s10_axis <= s9_axis;
      s10_length <= s9_length;
      s10_lateral <= s9_lateral;
      for (int unsigned k = 0; k < 3; k++) begin
        for (int unsigned a = 0; a < 3; a++) begin
          if (2'((32'(s9_axis) + k) % 3) == 2'(a)) begin
            s10_start[k] <= s9_start_in[a];
            s10_rest[k] <= s9_far[a] ? grid_i.edges[a] - 1'b1 : s9_start_rest[a];
            // On the dominant axis P1 belongs to the half-slab before a face; on others to the one
            // behind it, if there is one.
            if (k == 0) begin
              s10_end[k] <= s9_end[a] - HALF_W'(s9_end_rest[a] == '0);
              s10_ahead <= grid_i.edges[a] - s9_start_rest[a];
            end else begin
              s10_end[k] <= s9_end[a] -
                            HALF_W'(s9_end[a] >= {grid_i.half_blocks[a][HALF_W-3:0], 2'b00});
              s10_far[k-1] <= s9_far[a];
            end
          end
        end
      end
      for (int unsigned a = 0; a < 3; a++) begin
        s10_block[a] <= s9_neg[a]
            ? grid_i.half_blocks[a][AXIS_W-3:0] - 1'b1 - s9_start_in[a][HALF_W-2:2]
            : s9_start_in[a][HALF_W-2:2];
      end
    end
  end

  // 10-24: increments per half-slab and for the partial one.
  logic [1:0] s24_moving;  // P0 and P1 differ
  logic [1:0][SLOPE_W-1:0] s24_slope, s24_partial;
  for (genvar n = 0; n < 2; n++) begin : gen_increment
    gridrt_setup_increment i_increment (
        .clk_i,
        .rst_ni,
        .enable_i(enable),
        .valid_i(valid[11:9]),
        .s9_product_i(s9_product[n]),
        .s9_length_i(s9_length),
        .s10_ahead_i(s10_ahead),
        .s10_lateral_i(s10_lateral[n]),
        .s10_length_i(s10_length),
        .s24_moving_o(s24_moving[n]),
        .s24_slope_o(s24_slope[n]),
        .s24_partial_o(s24_partial[n])
    );
  end

  // What the last part needs, from clock 10 to 24.
  logic [1:0] s24_axis, s24_first, s24_far;
  logic [1:0][1:0] s24_low;
  logic [1:0][EDGE_W-1:0] s24_rest;
  gridrt_delay #(
      .WIDTH(10 + 2 * EDGE_W),
      .CLOCKS(14)
  ) i_late (
      .clk_i,
      .rst_ni,
      .enable_i(enable),
      .data_i({
        s10_axis, s10_start[0][1:0], s10_far, s10_start[2][1:0], s10_start[1][1:0], s10_rest[2:1]
      }),
      .data_o({s24_axis, s24_first, s24_far, s24_low, s24_rest})
  );

  // 25-29: where traversal starts on the lateral axes.
  logic [1:0][2:0] s29_half;
  logic [1:0][REST_W-1:0] s29_rest;
  logic [1:0][SLOPE_W-1:0] s29_slope;
  logic [1:0] s29_first;
  logic [1:0][1:0] s29_low;
  gridrt_setup_back i_back (
      .clk_i,
      .rst_ni,
      .enable_i(enable),
      .moving_i(&s24_moving),
      .edges_i(grid_i.edges),
      .s24_axis_i(s24_axis),
      .s24_first_i(s24_first),
      .s24_far_i(s24_far),
      .s24_low_i(s24_low),
      .s24_rest_i(s24_rest),
      .s24_slope_i(s24_slope),
      .s24_partial_i(s24_partial),
      .s29_half_o(s29_half),
      .s29_rest_o(s29_rest),
      .s29_slope_o(s29_slope),
      .s29_first_o(s29_first),
      .s29_low_o(s29_low)
  );

  // 11-14: entry face, block-slabs, limits, block address; then to the end.
  logic [1:0] s29_axis, s29_last;
  logic [2:0] s29_neg;
  logic [BLOCK_W-1:0] s29_block;
  logic [SLABS_W-1:0] s29_slabs;
  logic [DIST_W:0] s29_enter;
  logic [1:0][AXIS_W-1:0] s29_end;
  gridrt_setup_block i_block (
      .clk_i,
      .rst_ni,
      .enable_i(enable),
      .valid_i(valid[13:10]),
      .grid_i,
      .s10_axis_i(s10_axis),
      .s10_neg_i(s10_neg),
      .s10_start_i(s10_start),
      .s10_end_i(s10_end),
      .s10_rest_i(s10_rest[0]),
      .s10_block_i(s10_block),
      .s29_axis_o(s29_axis),
      .s29_neg_o(s29_neg),
      .s29_block_o(s29_block),
      .s29_slabs_o(s29_slabs),
      .s29_last_o(s29_last),
      .s29_enter_o(s29_enter),
      .s29_end_o(s29_end)
  );

  always_comb begin
    start_o.axis = s29_axis;
    start_o.neg = s29_neg;
    start_o.block = s29_block;
    start_o.slabs = s29_slabs;
    start_o.first = s29_first;
    start_o.last = s29_last;
    start_o.enter = s29_enter;
    start_o.half = s29_half;
    start_o.low = s29_low;
    start_o.rest = s29_rest;
    start_o.slope = s29_slope;
    start_o.limit = s29_end;
  end

  // The ray itself, from clock 1 to 28.
  logic [ID_W-1:0] s1_ignore, s28_ignore;
  logic s1_any, s28_any;
  logic [2:0][B-1:0] s28_p0, s28_p1;
  always_ff @(posedge clk_i) begin
    if (enable && ray_valid_i) begin
      s1_ignore <= ignore_i;
      s1_any <= any_hit_i;
    end
  end
  gridrt_delay #(
      .WIDTH (RAY_W),
      .CLOCKS(27)
  ) i_ray (
      .clk_i,
      .rst_ni,
      .enable_i(enable),
      .data_i({s1_ignore, s1_any, s1_p0, s1_p1}),
      .data_o({s28_ignore, s28_any, s28_p0, s28_p1})
  );
  always_ff @(posedge clk_i) begin
    if (enable && valid[28]) begin
      p0_o <= s28_p0;
      ignore_o <= s28_ignore;
      any_hit_o <= s28_any;
      miss_o <= s28_p0 == s28_p1;
      for (int unsigned a = 0; a < 3; a++) d_o[a] <= {1'b0, s28_p1[a]} - {1'b0, s28_p0[a]};
    end
  end
  always_comb begin
    length_o = '0;
    for (int unsigned a = 0; a < 3; a++) begin
      if (s29_axis == 2'(a)) length_o = d_o[a][B] ? B'(-d_o[a]) : d_o[a][B-1:0];
    end
  end

`ifdef GRIDRT_ASSERT
  always_ff @(posedge clk_i) begin
    if (rst_ni && enable && valid[9]) begin
      assert (s9_axis < 2'd3);
    end
    if (rst_ni && out_valid_o && !miss_o) begin
      assert (length_o != '0);
      assert (start_o.neg[start_o.axis] == d_o[start_o.axis][B]);
    end
  end
`endif
endmodule
