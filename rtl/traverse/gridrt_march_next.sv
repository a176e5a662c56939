// Where a ray goes on, clocks 3 to 8 of a step: to a neighbour of its block, sideways in the same
// block-slab, or to a block of a slab ahead; and the state with which it gets there.
module gridrt_march_next (
    input  logic                                     clk_i,
    input  logic [4:0]                               valid_i,      // of clocks 7 to 3
    input  logic [2:1][gridrt_pkg::BLOCK_W-1:0]      stride_i,     // of the grid's y and z; x: 1
    input  logic [1:0]                               s3_axis_i,
    input  logic [2:0]                               s3_neg_i,
    input  logic [2:0]                               s5_ahead_i,   // block-slabs on, 1 .. 7
    input  logic [gridrt_state_pkg::SLABS_W-1:0]     s5_slabs_i,
    input  logic                                     s7_on_i,      // to another slab
    input  logic [1:0]                               s7_sub_i,     // else to this neighbour
    input  logic [1:0][2:0]                          s7_half_i,    // signed
    input  logic [1:0][4:0]                          s7_halves_i,  // half-voxels passed
    input  logic [1:0][gridrt_state_pkg::REST_W-1:0] s7_rest_i,
    input  logic [gridrt_pkg::DIST_W:0]              s7_enter_i,   // of the slab
    input  gridrt_state_pkg::start_t                 s8_state_i,
    output gridrt_state_pkg::start_t                 s8_next_o,
    output logic [1:0]                               s8_sub_o,
    output logic [gridrt_pkg::BLOCK_W-1:0]           s8_look_o     // address of the block
);
  localparam int unsigned BLOCK_W = gridrt_pkg::BLOCK_W;
  localparam int unsigned DIST_W = gridrt_pkg::DIST_W;
  localparam int unsigned AXIS_W = gridrt_pkg::AXIS_W;
  localparam int unsigned REST_W = gridrt_state_pkg::REST_W;
  localparam int unsigned SLABS_W = gridrt_state_pkg::SLABS_W;

  // Strides in the order dominant axis, b, c; taken away on mirrored axes.
  logic [2:0][BLOCK_W-1:0] stride, s4_stride, s5_stride;
  logic [2:1][BLOCK_W-1:0] s6_stride, s7_stride;
  assign stride = {stride_i, BLOCK_W'(1)};
  logic [2:0] s4_neg, s5_neg, s6_neg, s7_neg, s8_neg;
  logic [BLOCK_W-1:0] s5_main, s6_main, s7_main, s8_main;
  logic [1:0][BLOCK_W-1:0] s7_side, s8_side;
  logic [1:0][2:0] s7_off, s7_steps, s8_off;  // blocks passed sideways; strides sideways
  logic [1:0][4:0] s7_half, s8_half;
  always_comb begin
    for (int unsigned n = 0; n < 2; n++) begin
      s7_half[n] = {{2{s7_half_i[n][2]}}, s7_half_i[n]} + s7_halves_i[n];
      s7_off[n] = s7_half[n][4:2];
      s7_steps[n] = s7_on_i ? s7_off[n] : {2'b00, s7_sub_i[n]};
    end
  end
  gridrt_times #(
      .WIDTH(BLOCK_W)
  ) i_main (
      .factor_i(s5_ahead_i),
      .value_i(s5_stride[0]),
      .product_o(s5_main)
  );
  for (genvar n = 0; n < 2; n++) begin : gen_side
    gridrt_times #(
        .WIDTH(BLOCK_W)
    ) i_side (
        .factor_i(s7_steps[n]),
        .value_i(s7_stride[n+1]),
        .product_o(s7_side[n])
    );
  end
  logic s8_on;
  logic [1:0][REST_W-1:0] s8_rest;
  logic [SLABS_W-1:0] s6_slabs, s7_slabs, s8_slabs;
  logic [DIST_W:0] s8_enter;
  always_ff @(posedge clk_i) begin
    if (valid_i[0]) begin
      for (int unsigned a = 0; a < 3; a++) begin
        for (int unsigned k = 0; k < 3; k++) begin
          if (s3_axis_i == 2'(a)) begin
            s4_stride[k] <= stride[(a+k)%3];
            s4_neg[k] <= s3_neg_i[(a+k)%3];
          end
        end
      end
    end
    if (valid_i[1]) begin
      s5_stride <= s4_stride;
      s5_neg <= s4_neg;
    end
    if (valid_i[2]) begin
      s6_stride <= s5_stride[2:1];
      s6_neg <= s5_neg;
      s6_main <= s5_main;
      s6_slabs <= s5_slabs_i - SLABS_W'(s5_ahead_i);
    end
    if (valid_i[3]) begin
      s7_stride <= s6_stride;
      s7_neg <= s6_neg;
      s7_main <= s6_main;
      s7_slabs <= s6_slabs;
    end
    if (valid_i[4]) begin
      s8_on <= s7_on_i;
      s8_neg <= s7_neg;
      s8_main <= s7_on_i ? s7_main : '0;
      s8_side <= s7_side;
      s8_off <= s7_off;
      s8_half <= s7_half;
      s8_rest <= s7_rest_i;
      s8_slabs <= s7_slabs;
      s8_enter <= s7_enter_i;
      s8_sub_o <= s7_sub_i;
    end
  end
  logic [3:0][BLOCK_W-1:0] s8_look;
  assign s8_look[0] = s8_state_i.block;
  for (genvar k = 0; k < 3; k++) begin : gen_look
    gridrt_add_sub #(
        .WIDTH(BLOCK_W)
    ) i_look (
        .sub_i(s8_neg[k]),
        .a_i  (s8_look[k]),
        .b_i  ((k == 0) ? s8_main : s8_side[(k+1)%2]),
        .sum_o(s8_look[k+1])
    );
  end
  assign s8_look_o = s8_look[3];
  always_comb begin
    s8_next_o = s8_state_i;
    if (s8_on) begin
      s8_next_o.block = s8_look_o;
      s8_next_o.slabs = s8_slabs;
      s8_next_o.first = 2'd0;
      s8_next_o.enter = s8_enter;
      s8_next_o.low = '0;
      s8_next_o.rest = s8_rest;
      for (int unsigned n = 0; n < 2; n++) begin
        s8_next_o.half[n] = {1'b0, s8_half[n][1:0]};
        s8_next_o.limit[n] = s8_state_i.limit[n] - AXIS_W'({s8_off[n], 2'b00});
      end
    end
  end
endmodule
