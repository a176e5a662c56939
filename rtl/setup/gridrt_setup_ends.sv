// A ray's two ends in quarters of voxels, in clocks 3 to 14 of gridrt_setup: three dividers take P0's
// coordinates in one clock and P1's in the next.
module gridrt_setup_ends #(
    localparam int unsigned EDGE_W = gridrt_state_pkg::EDGE_W,
    localparam int unsigned SPAN_W = gridrt_state_pkg::SPAN_W,
    localparam int unsigned AXIS_W = gridrt_pkg::AXIS_W
) (
    input  logic                   clk_i,
    input  logic                   rst_ni,
    input  logic                   enable_i,
    input  logic                   odd_i,          // gridrt_setup says what this is
    input  logic                   valid_i,        // in clocks 3 and 4
    input  logic [2:0][EDGE_W-1:0] edges_i,
    input  logic [2:0][AXIS_W-1:0] half_blocks_i,
    input  logic [2:0][SPAN_W+1:0] s3_four_i,      // four times a mirrored end: P0 in clock 3, P1 in 4
    input  logic [1:0]             s9_axis_i,
    input  logic [1:0]             s10_axis_i,
    input  logic [1:0]             s10_lateral_i,  // 10 and 11: a lateral axis
    output logic [EDGE_W-1:0]      s10_edge_o,     // of the dominant axis
    output logic [2:0][AXIS_W-3:0] s10_block_o,    // per axis x, y, z: block of P0; not in clock 11
    output logic [2:0]             s11_first_o,    // quarter-slab of P0 in its block
    // P0 on a lateral axis: 11 and 12.
    output logic                   s11_far_o,      // on the far face
    output logic [2:0]             s11_low_o,      // quarter of the block, 7 on the far face
    output logic [EDGE_W-2:0]      s11_rest_o,     // behind that quarter's face, in quarter steps
    output logic [EDGE_W-1:0]      s12_ahead_o,    // four times the distance to the next quarter-face
    output logic [2:0][AXIS_W:0]   s12_end_o       // quarter of P1, from P0's block's first one
);
  localparam int unsigned QUARTER_W = AXIS_W + 2;  // quarters of voxels, 0 .. 2048

  // 4-10: quarters and what remains.
  logic [2:0] unused_valid;
  logic [2:0][QUARTER_W-1:0] s9_quarter;
  logic [2:0][EDGE_W-1:0] s9_rest;
  for (genvar a = 0; a < 3; a++) begin : gen_quarter
    gridrt_divide_pipe #(
        .DIVIDEND_W(SPAN_W + 2),
        .DIVISOR_W(EDGE_W),
        .QUOTIENT_W(QUARTER_W),
        .STEP(2),
        .REMAINDER(1'b1),
        .CONSTANT(1'b1)
    ) i_quarter (
        .clk_i,
        .rst_ni,
        .enable_i,
        .valid_i,
        .dividend_i(s3_four_i[a]),
        .divisor_i(edges_i[a]),
        .valid_o(unused_valid[a]),
        .quotient_o(s9_quarter[a]),
        .remainder_o(s9_rest[a])
    );
  end

  // An end on the far face belongs to the last quarter. On the dominant axis P1 belongs to the quarter-slab
  // before a face; on others to the one behind it, if there is one.
  logic [2:0] s9_far, s9_less;
  logic [2:0][QUARTER_W-1:0] s10_quarter, s11_quarter;
  logic [2:0][QUARTER_W-1:0] span;
  always_comb begin
    for (int unsigned a = 0; a < 3; a++) begin
      s9_far[a] = !(s9_quarter[a] < {half_blocks_i[a][QUARTER_W-4:0], 3'b000});
      s9_less[a] = s9_far[a];
      if (!odd_i && s9_axis_i == 2'(a)) s9_less[a] = s9_rest[a] == '0;
      s10_block_o[a] = s10_quarter[a][QUARTER_W-2:3];
      span[a] = s10_quarter[a] - {s11_quarter[a][QUARTER_W-1:3], 3'b000};
    end
  end

  logic [2:0] s10_far;
  logic [2:0][2:0] s10_low;
  logic [2:0][EDGE_W-2:0] s10_rest;
  logic [EDGE_W-1:0] s10_dominant_rest;
  always_ff @(posedge clk_i) begin
    if (enable_i) begin
      for (int unsigned a = 0; a < 3; a++) s10_quarter[a] <= s9_quarter[a] - QUARTER_W'(s9_less[a]);
      s11_quarter <= s10_quarter;
      {s11_far_o, s11_low_o, s11_rest_o} <=
          s10_lateral_i[1] ? {s10_far[2], s10_low[2], s10_rest[2]}
          : s10_lateral_i[0] ? {s10_far[1], s10_low[1], s10_rest[1]}
          : {s10_far[0], s10_low[0], s10_rest[0]};
    end
    if (enable_i && odd_i) begin
      s10_far <= s9_far;
      for (int unsigned a = 0; a < 3; a++) begin
        s10_low[a] <= s9_quarter[a][2:0] | {3{s9_far[a]}};
        s10_rest[a] <= s9_rest[a][EDGE_W-2:0];
        s12_end_o[a] <= span[a][AXIS_W:0];
      end
      s10_dominant_rest <= s9_axis_i[1] ? s9_rest[2] : s9_axis_i[0] ? s9_rest[1] : s9_rest[0];
      s10_edge_o <= s9_axis_i[1] ? edges_i[2] : s9_axis_i[0] ? edges_i[1] : edges_i[0];
      s12_ahead_o <= s10_edge_o - s10_dominant_rest;
    end
    if (enable_i && !odd_i) begin
      s11_first_o <= s10_axis_i[1] ? s10_quarter[2][2:0]
          : s10_axis_i[0] ? s10_quarter[1][2:0] : s10_quarter[0][2:0];
    end
  end

  logic unused;
  assign unused = &{1'b0, unused_valid, span, half_blocks_i};
endmodule
