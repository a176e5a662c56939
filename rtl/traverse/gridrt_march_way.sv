// How far the march has come on the dominant axis, clocks 5 to 8 of a step: where the ray enters the
// block's near and far voxels and the next block-slab to be looked at, and whether there is such a
// slab. Distances are those from P0, in lattice steps.
module gridrt_march_way (
    input  logic                                 clk_i,
    input  logic [4:0]                           valid_i,          // of clocks 8 to 4
    input  logic [gridrt_state_pkg::EDGE_W-1:0]  s4_edge_i,        // of a voxel
    input  logic [2:0]                           s5_ahead_i,       // block-slabs on, 1 .. 7
    input  logic [gridrt_pkg::DIST_W:0]          s7_enter_i,       // of the block
    input  logic [gridrt_state_pkg::SLABS_W-1:0] s7_slabs_i,       // left after this one
    output logic [2:0]                           s7_ahead_o,
    output logic [gridrt_pkg::DIST_W:0]          s8_enter_o,       // of the slab ahead
    output logic [gridrt_pkg::DIST_W-1:0]        s8_near_enter_o,
    output logic [gridrt_pkg::DIST_W-1:0]        s9_near_enter_o,
    output logic [gridrt_pkg::DIST_W-1:0]        s9_far_enter_o,
    output logic                                 s9_over_o         // no such slab
);
  localparam int unsigned DIST_W = gridrt_pkg::DIST_W;
  localparam int unsigned EDGE_W = gridrt_state_pkg::EDGE_W;
  localparam int unsigned SLABS_W = gridrt_state_pkg::SLABS_W;

  logic [EDGE_W-1:0] s5_edge, s6_edge, s7_edge;
  logic [2:0] s6_ahead;
  logic [EDGE_W+2:0] s6_way, s7_way;  // `ahead` edges
  logic [DIST_W:0] s7_far;
  logic [DIST_W-1:0] s8_far_enter;
  logic s8_over;
  gridrt_times #(
      .WIDTH(EDGE_W + 3)
  ) i_way (
      .factor_i(s6_ahead),
      .value_i({3'b000, s6_edge}),
      .product_o(s6_way)
  );
  assign s7_far = s7_enter_i + {1'b0, s7_edge};
  always_ff @(posedge clk_i) begin
    if (valid_i[0]) s5_edge <= s4_edge_i;
    if (valid_i[1]) begin
      s6_edge <= s5_edge;
      s6_ahead <= s5_ahead_i;
    end
    if (valid_i[2]) begin
      s7_edge <= s6_edge;
      s7_ahead_o <= s6_ahead;
      s7_way <= s6_way;
    end
    if (valid_i[3]) begin
      // A carry out of it belongs to a slab behind the last one.
      s8_enter_o <= s7_enter_i + {s7_way[DIST_W-1:0], 1'b0};
      s8_over <= SLABS_W'(s7_ahead_o) > s7_slabs_i;
      s8_near_enter_o <= s7_enter_i[DIST_W] ? '0 : s7_enter_i[DIST_W-1:0];
      s8_far_enter <= s7_far[DIST_W] ? '0 : s7_far[DIST_W-1:0];
    end
    if (valid_i[4]) begin
      s9_near_enter_o <= s8_near_enter_o;
      s9_far_enter_o <= s8_far_enter;
      s9_over_o <= s8_over;
    end
  end

  logic unused;
  assign unused = &{1'b0, s7_way};
endmodule
