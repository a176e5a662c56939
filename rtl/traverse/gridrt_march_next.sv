// Where a ray goes on, clocks 5 to 10 of a step: to a neighbour of its block, sideways in the same
// block-slab, or to a block of a slab ahead; and the state with which it gets there.
module gridrt_march_next (
    input  logic                                     clk_i,
    input  logic [4:0]                               valid_i,      // of clocks 9 to 5
    input  logic [2:1][gridrt_pkg::BLOCK_W-1:0]      stride_i,     // of the grid's y and z; x: 1
    input  logic [1:0]                               s5_axis_i,
    input  logic [2:0]                               s5_neg_i,
    input  logic [2:0]                               s7_ahead_i,   // block-slabs on, 1 .. 7
    input  logic [gridrt_state_pkg::SLABS_W-1:0]     s7_slabs_i,
    input  logic                                     s9_on_i,      // to another slab
    input  logic [1:0]                               s9_sub_i,     // else to this neighbour
    input  logic [1:0][3:0]                          s9_quarter_i,   // signed
    input  logic [1:0][5:0]                          s9_quarters_i,  // passed
    input  logic [1:0][gridrt_state_pkg::REST_W-1:0] s9_rest_i,
    input  logic [gridrt_pkg::DIST_W:0]              s9_enter_i,   // of the slab
    input  gridrt_state_pkg::start_t                 s10_state_i,
    output gridrt_state_pkg::start_t                 s10_next_o,
    output logic [1:0]                               s10_sub_o,
    output logic [gridrt_pkg::BLOCK_W-1:0]           s10_look_o     // address of the block
);
  localparam int unsigned BLOCK_W = gridrt_pkg::BLOCK_W;
  localparam int unsigned DIST_W = gridrt_pkg::DIST_W;
  localparam int unsigned AXIS_W = gridrt_pkg::AXIS_W;
  localparam int unsigned REST_W = gridrt_state_pkg::REST_W;
  localparam int unsigned SLABS_W = gridrt_state_pkg::SLABS_W;

  // Strides in the order dominant axis, b, c; taken away on mirrored axes.
  logic [2:0][BLOCK_W-1:0] stride, s6_stride, s7_stride;
  logic [2:1][BLOCK_W-1:0] s8_stride, s9_stride;
  assign stride = {stride_i, BLOCK_W'(1)};
  logic [2:0] s6_neg, s7_neg, s8_neg, s9_neg, s10_neg;
  logic [BLOCK_W-1:0] s7_main, s8_main, s9_main, s10_main;
  logic [1:0][BLOCK_W-1:0] s9_side, s10_side;
  logic [1:0][2:0] s9_off, s9_steps, s10_off;  // blocks passed sideways; strides sideways
  logic [1:0][5:0] s9_quarter, s10_quarter;
  always_comb begin
    for (int unsigned n = 0; n < 2; n++) begin
      s9_quarter[n] = {{2{s9_quarter_i[n][3]}}, s9_quarter_i[n]} + s9_quarters_i[n];
      s9_off[n] = s9_quarter[n][5:3];
      s9_steps[n] = s9_on_i ? s9_off[n] : {2'b00, s9_sub_i[n]};
    end
  end
  gridrt_times #(
      .WIDTH(BLOCK_W)
  ) i_main (
      .factor_i(s7_ahead_i),
      .value_i(s7_stride[0]),
      .product_o(s7_main)
  );
  for (genvar n = 0; n < 2; n++) begin : gen_side
    gridrt_times #(
        .WIDTH(BLOCK_W)
    ) i_side (
        .factor_i(s9_steps[n]),
        .value_i(s9_stride[n+1]),
        .product_o(s9_side[n])
    );
  end
  logic s10_on;
  logic [1:0][REST_W-1:0] s10_rest;
  logic [SLABS_W-1:0] s8_slabs, s9_slabs, s10_slabs;
  logic [DIST_W:0] s10_enter;
  always_ff @(posedge clk_i) begin
    if (valid_i[0]) begin
      s6_stride <= stride;
      s6_neg <= s5_neg_i;
      for (int unsigned a = 0; a < 3; a++) begin
        for (int unsigned k = 0; k < 3; k++) begin
          if (s5_axis_i == 2'(a)) begin
            s6_stride[k] <= stride[(a+k)%3];
            s6_neg[k] <= s5_neg_i[(a+k)%3];
          end
        end
      end
    end
    if (valid_i[1]) begin
      s7_stride <= s6_stride;
      s7_neg <= s6_neg;
    end
    if (valid_i[2]) begin
      s8_stride <= s7_stride[2:1];
      s8_neg <= s7_neg;
      s8_main <= s7_main;
      s8_slabs <= s7_slabs_i - SLABS_W'(s7_ahead_i);
    end
    if (valid_i[3]) begin
      s9_stride <= s8_stride;
      s9_neg <= s8_neg;
      s9_main <= s8_main;
      s9_slabs <= s8_slabs;
    end
    if (valid_i[4]) begin
      s10_on <= s9_on_i;
      s10_neg <= s9_neg;
      s10_main <= s9_on_i ? s9_main : '0;
      s10_side <= s9_side;
      s10_off <= s9_off;
      s10_quarter <= s9_quarter;
      s10_rest <= s9_rest_i;
      s10_slabs <= s9_slabs;
      s10_enter <= s9_enter_i;
      s10_sub_o <= s9_sub_i;
    end
  end
  logic [3:0][BLOCK_W-1:0] s10_look;
  assign s10_look[0] = s10_state_i.block;
  for (genvar k = 0; k < 3; k++) begin : gen_look
    gridrt_add_sub #(
        .WIDTH(BLOCK_W)
    ) i_look (
        .sub_i(s10_neg[k]),
        .a_i  (s10_look[k]),
        .b_i  ((k == 0) ? s10_main : s10_side[(k+1)%2]),
        .sum_o(s10_look[k+1])
    );
  end
  assign s10_look_o = s10_look[3];
  always_comb begin
    s10_next_o = s10_state_i;
    if (s10_on) begin
      s10_next_o.block = s10_look_o;
      s10_next_o.slabs = s10_slabs;
      s10_next_o.first = 3'd0;
      s10_next_o.enter = s10_enter;
      s10_next_o.low = '0;
      s10_next_o.rest = s10_rest;
      for (int unsigned n = 0; n < 2; n++) begin
        s10_next_o.quarter[n] = {1'b0, s10_quarter[n][2:0]};
        s10_next_o.limit[n] = s10_state_i.limit[n] - (AXIS_W + 1)'({s10_off[n], 3'b000});
      end
    end
  end
endmodule
