// How far the march has come on the dominant axis, clocks 3 to 6 of a step: where the ray enters the
// block's near and far voxels and the next block-slab to be looked at, and whether there is such a
// slab. Distances are those from P0, in lattice steps.
module gridrt_march_way (
    input  logic                                 clk_i,
    input  logic [4:0]                           valid_i,          // of clocks 6 to 2
    input  logic [gridrt_state_pkg::EDGE_W-1:0]  s2_edge_i,        // of a voxel
    input  logic [2:0]                           s3_ahead_i,       // block-slabs on, 1 .. 7
    input  logic [gridrt_pkg::DIST_W:0]          s5_enter_i,       // of the block
    input  logic [gridrt_state_pkg::SLABS_W-1:0] s5_slabs_i,       // left after this one
    output logic [2:0]                           s5_ahead_o,
    output logic [gridrt_pkg::DIST_W:0]          s6_enter_o,       // of the slab ahead
    output logic [gridrt_pkg::DIST_W-1:0]        s6_near_enter_o,
    output logic [gridrt_pkg::DIST_W-1:0]        s7_near_enter_o,
    output logic [gridrt_pkg::DIST_W-1:0]        s7_far_enter_o,
    output logic                                 s7_over_o         // no such slab
);
  localparam int unsigned DIST_W = gridrt_pkg::DIST_W;
  localparam int unsigned EDGE_W = gridrt_state_pkg::EDGE_W;
  localparam int unsigned SLABS_W = gridrt_state_pkg::SLABS_W;

  logic [EDGE_W-1:0] s3_edge, s4_edge, s5_edge;
  logic [2:0] s4_ahead;
  logic [EDGE_W+2:0] s4_way, s5_way;  // `ahead` edges
  logic [DIST_W:0] s5_far;
  logic [DIST_W-1:0] s6_far_enter;
  logic s6_over;
  gridrt_times #(
      .WIDTH(EDGE_W + 3)
  ) i_way (
      .factor_i(s4_ahead),
      .value_i({3'b000, s4_edge}),
      .product_o(s4_way)
  );
  assign s5_far = s5_enter_i + {1'b0, s5_edge};
  always_ff @(posedge clk_i) begin
    if (valid_i[0]) s3_edge <= s2_edge_i;
    if (valid_i[1]) begin
      s4_edge <= s3_edge;
      s4_ahead <= s3_ahead_i;
    end
    if (valid_i[2]) begin
      s5_edge <= s4_edge;
      s5_ahead_o <= s4_ahead;
      s5_way <= s4_way;
    end
    if (valid_i[3]) begin
      // A carry out of it belongs to a slab behind the last one.
      s6_enter_o <= s5_enter_i + {s5_way[DIST_W-1:0], 1'b0};
      s6_over <= SLABS_W'(s5_ahead_o) > s5_slabs_i;
      s6_near_enter_o <= s5_enter_i[DIST_W] ? '0 : s5_enter_i[DIST_W-1:0];
      s6_far_enter <= s5_far[DIST_W] ? '0 : s5_far[DIST_W-1:0];
    end
    if (valid_i[4]) begin
      s7_near_enter_o <= s6_near_enter_o;
      s7_far_enter_o <= s6_far_enter;
      s7_over_o <= s6_over;
    end
  end

  logic unused;
  assign unused = &{1'b0, s5_way};
endmodule
