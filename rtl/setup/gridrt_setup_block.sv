// The parts of a ray's state that need no division, in clocks 10 to 14 of gridrt_setup: entry face,
// block-slabs, the halves of P1, and the address of P0's block by shift and add; then they ride along
// to clock 29. Axes are in the order dominant, b, c except for s10_block_i (x, y, z).
module gridrt_setup_block (
    input  logic                                                                clk_i,
    input  logic                                                                rst_ni,
    input  logic                                                                enable_i,
    input  logic                    [3:0]                                       valid_i,  // 13 to 10
    /* verilator lint_off UNUSEDSIGNAL */  // not all of a grid's constants are needed here
    input  gridrt_state_pkg::grid_t                                             grid_i,
    /* verilator lint_on UNUSEDSIGNAL */
    input  logic                    [1:0]                                       s10_axis_i,
    input  logic                    [2:0]                                       s10_neg_i,
    input  logic                    [2:0][gridrt_pkg::AXIS_W:0]                 s10_start_i,
    input  logic                    [2:0][gridrt_pkg::AXIS_W:0]                 s10_end_i,
    input  logic                    [gridrt_state_pkg::EDGE_W-1:0]              s10_rest_i,
    input  logic                    [2:0][gridrt_pkg::AXIS_W-3:0]               s10_block_i,
    output logic                    [1:0]                                       s29_axis_o,
    output logic                    [2:0]                                       s29_neg_o,
    output logic                    [gridrt_pkg::BLOCK_W-1:0]                   s29_block_o,
    output logic                    [gridrt_state_pkg::SLABS_W-1:0]             s29_slabs_o,
    output logic                    [1:0]                                       s29_last_o,
    output logic                    [gridrt_pkg::DIST_W:0]                      s29_enter_o,
    output logic                    [1:0][gridrt_pkg::AXIS_W-1:0]               s29_end_o
);
  localparam int unsigned AXIS_W = gridrt_pkg::AXIS_W;
  localparam int unsigned BLOCK_W = gridrt_pkg::BLOCK_W;
  localparam int unsigned DIST_W = gridrt_pkg::DIST_W;
  localparam int unsigned EDGE_W = gridrt_state_pkg::EDGE_W;
  localparam int unsigned SLABS_W = gridrt_state_pkg::SLABS_W;
  localparam int unsigned INDEX_W = AXIS_W - 2;  // a block's place along an axis
  localparam int unsigned META_W = 5 + SLABS_W + 2 + 2 * AXIS_W;

  // Twice the way from the block's entry face to P0: half-slabs before P0's one, and the rest.
  logic [AXIS_W:0] start_half, end_half, start_b, start_c;
  logic [EDGE_W+1:0] passed, offset;
  logic [EDGE_W:0] s11_offset_half;
  logic [EDGE_W-1:0] axis_edge;
  logic [EDGE_W+1:0] axis_edge3;
  logic [META_W-1:0] s11_meta, s12_meta;
  logic [DIST_W:0] s12_enter;
  always_comb begin
    axis_edge  = grid_i.edges[0];
    axis_edge3 = grid_i.edges3[0];
    for (int unsigned a = 1; a < 3; a++) begin
      if (s10_axis_i == 2'(a)) begin
        axis_edge  = grid_i.edges[a];
        axis_edge3 = grid_i.edges3[a];
      end
    end
    start_half = s10_start_i[0];
    start_b = s10_start_i[1] & ~(AXIS_W + 1)'(3);  // of the block
    start_c = s10_start_i[2] & ~(AXIS_W + 1)'(3);
    end_half = s10_end_i[0];
    case (start_half[1:0])
      2'd0: passed = '0;
      2'd1: passed = {2'b00, axis_edge};
      2'd2: passed = {1'b0, axis_edge, 1'b0};
      default: passed = axis_edge3;
    endcase
    offset = passed + {2'b00, s10_rest_i};  // even
  end
  always_ff @(posedge clk_i) begin
    if (enable_i && valid_i[0]) begin
      s11_offset_half <= (EDGE_W + 1)'(offset >> 1);
      s11_meta <= {
        s10_axis_i,
        s10_neg_i,
        SLABS_W'(end_half[AXIS_W:2] - start_half[AXIS_W:2]),
        end_half[1:0],
        AXIS_W'(s10_end_i[2] - start_c),
        AXIS_W'(s10_end_i[1] - start_b)
      };
    end
    if (enable_i && valid_i[1]) begin
      s12_enter <= -s11_offset_half;
      s12_meta  <= s11_meta;
    end
  end
  gridrt_delay #(
      .WIDTH (META_W + DIST_W + 1),
      .CLOCKS(17)
  ) i_meta (
      .clk_i,
      .rst_ni,
      .enable_i,
      .data_i({s12_meta, s12_enter}),
      .data_o({s29_axis_o, s29_neg_o, s29_slabs_o, s29_last_o, s29_end_o, s29_enter_o})
  );

  // x + stride_y y + stride_z z, two bits of y and z a clock.
  logic [3:0][BLOCK_W-1:0] sum;  // of clocks 11 to 14
  logic [2:0][INDEX_W-1:0] y, z;  // of clocks 11 to 13
  logic [3:0][BLOCK_W-1:0] next;
  always_comb begin
    next[0] = BLOCK_W'(s10_block_i[0]);
    next[3:1] = sum[2:0];
    for (int unsigned j = 0; j < 2; j++) begin
      if (s10_block_i[1][j]) next[0] = next[0] + (grid_i.stride[1] << j);
      if (s10_block_i[2][j]) next[0] = next[0] + (grid_i.stride[2] << j);
      for (int unsigned i = 1; i < 4; i++) begin
        if (y[i-1][2*i+j]) next[i] = next[i] + (grid_i.stride[1] << (2 * i + j));
        if (z[i-1][2*i+j]) next[i] = next[i] + (grid_i.stride[2] << (2 * i + j));
      end
    end
  end
  always_ff @(posedge clk_i) begin
    for (int unsigned i = 0; i < 4; i++) begin
      if (enable_i && valid_i[i]) sum[i] <= next[i];
    end
    if (enable_i && valid_i[0]) begin
      y[0] <= s10_block_i[1];
      z[0] <= s10_block_i[2];
    end
    for (int unsigned i = 1; i < 3; i++) begin
      if (enable_i && valid_i[i]) begin
        y[i] <= y[i-1];
        z[i] <= z[i-1];
      end
    end
  end
  gridrt_delay #(
      .WIDTH (BLOCK_W),
      .CLOCKS(15)
  ) i_block (
      .clk_i,
      .rst_ni,
      .enable_i,
      .data_i(sum[3]),
      .data_o(s29_block_o)
  );
endmodule
