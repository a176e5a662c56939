// The parts of a ray's state that need no division, in clocks 10 to 31 of gridrt_setup: entry face,
// block-slabs, the quarters of P1, and the address of P0's block.
module gridrt_setup_block #(
    localparam int unsigned EDGE_W = gridrt_state_pkg::EDGE_W,
    localparam int unsigned AXIS_W = gridrt_pkg::AXIS_W,
    localparam int unsigned BLOCK_W = gridrt_pkg::BLOCK_W,
    localparam int unsigned DIST_W = gridrt_pkg::DIST_W,
    localparam int unsigned SLABS_W = gridrt_state_pkg::SLABS_W
) (
    input  logic                    clk_i,
    input  logic                    rst_ni,
    input  logic                    enable_i,
    input  logic                    odd_i,         // gridrt_setup says what this is
    input  logic [2:0][ AXIS_W-1:0] half_blocks_i,
    input  logic [2:1][BLOCK_W-1:0] stride_i,
    input  logic [2:0]              s2_neg_i,
    input  logic [2:0][ AXIS_W-3:0] s10_block_i,   // per axis: block of P0, mirrored
    input  logic [EDGE_W-1:0]       s10_edge_i,    // of the dominant axis
    input  logic [2:0]              s11_first_i,   // quarter-slab of P0 in its block
    input  logic [1:0]              s12_axis_i,
    input  logic [1:0]              s12_lateral_i, // 12 and 13: a lateral axis
    input  logic [EDGE_W-1:0]       s12_ahead_i,   // four times the distance to the next quarter-face
    input  logic [2:0][ AXIS_W:0]   s12_end_i,     // quarter of P1, from P0's block's first one
    output logic [BLOCK_W-1:0]      s31_block_o,
    output logic [SLABS_W-1:0]      s31_slabs_o,
    output logic [2:0]              s31_last_o,
    output logic [DIST_W:0]         s31_enter_o,
    output logic [1:0][ AXIS_W:0]   s31_end_o      // on the lateral axes
);
  logic even_clock, odd_clock;
  assign even_clock = enable_i && odd_i;
  assign odd_clock  = enable_i && !odd_i;

  // 11-14: x + stride_y y + stride_z z, one product a clock, y's first. Its factors are chosen a clock
  // before: a multiplier is far from what it takes.
  logic [2:0] s4_neg, s6_neg, s8_neg, s10_neg;
  logic [2:0][AXIS_W-3:0] block;
  logic [AXIS_W-3:0] s11_x, s11_z, factor;
  logic [BLOCK_W-1:0] stride, s12_product, s13_sum, s14_block;
  always_comb begin
    for (int unsigned a = 0; a < 3; a++) begin
      block[a] = s10_neg[a] ? half_blocks_i[a][AXIS_W-3:0] + ~s10_block_i[a] : s10_block_i[a];
    end
  end
  always_ff @(posedge clk_i) begin
    if (even_clock) begin
      s4_neg <= s2_neg_i;
      s6_neg <= s4_neg;
      s8_neg <= s6_neg;
      s10_neg <= s8_neg;
      s14_block <= s13_sum + s12_product;
    end
    if (odd_clock) begin
      s11_x <= block[0];
      s11_z <= block[2];
      s13_sum <= BLOCK_W'(s11_x) + s12_product;
    end
    if (enable_i) begin
      factor <= odd_i ? s11_z : block[1];
      stride <= odd_i ? stride_i[2] : stride_i[1];
      s12_product <= factor * stride;
    end
  end

  // 12-14: four times the way from P0 to the next quarter-face, and from there back to the block's entry
  // face; four divides their difference.
  logic [3:0] steps;
  logic [EDGE_W+2:0] s12_back, enter;
  logic [DIST_W:0] s14_enter;
  logic [AXIS_W:0] s14_end;
  assign steps = {1'b0, s11_first_i} + 4'd1;
  assign enter = {3'b000, s12_ahead_i} - s12_back;
  always_ff @(posedge clk_i) begin
    if (even_clock) begin
      s12_back <= s10_edge_i * steps;
      s14_enter <= enter[EDGE_W+2:2];
      s14_end <= s12_axis_i[1] ? s12_end_i[2] : s12_axis_i[0] ? s12_end_i[1] : s12_end_i[0];
    end
  end
  gridrt_delay #(
      .WIDTH (BLOCK_W + AXIS_W + DIST_W + 2),
      .CLOCKS(9)
  ) i_meta (
      .clk_i,
      .rst_ni,
      .enable_i(odd_clock),  // 15 to 31
      .data_i({s14_block, s14_end, s14_enter}),
      .data_o({s31_block_o, s31_slabs_o, s31_last_o, s31_enter_o})
  );

  // The lateral axes' ends, one after the other.
  logic [AXIS_W:0] s13_end, s30_end, s31_end;
  gridrt_delay #(
      .WIDTH (AXIS_W + 1),
      .CLOCKS(17)
  ) i_end (
      .clk_i,
      .rst_ni,
      .enable_i,
      .data_i(s13_end),
      .data_o(s30_end)
  );
  always_ff @(posedge clk_i) begin
    if (enable_i) begin
      s13_end <= s12_lateral_i[1] ? s12_end_i[2]
          : s12_lateral_i[0] ? s12_end_i[1] : s12_end_i[0];
      s31_end <= s30_end;
    end
  end
  assign s31_end_o = {s30_end, s31_end};

  logic unused;
  assign unused = &{1'b0, half_blocks_i, enter[1:0]};
endmodule
