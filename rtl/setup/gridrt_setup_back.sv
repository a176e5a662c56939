// Where the march starts on the lateral axes, in clocks 23 to 31 of gridrt_setup, one axis after the
// other. The position at the first quarter-face behind P0 is P0's plus the partial increment; from there
// it goes back, an increment for each quarter-slab, to the block's entry face, so that traversal treats
// all blocks alike. (It may get below the block; samples before P0 are held at P0's quarter by `low`.)
module gridrt_setup_back #(
    localparam int unsigned EDGE_W = gridrt_state_pkg::EDGE_W,
    localparam int unsigned REST_W = gridrt_state_pkg::REST_W,
    localparam int unsigned PARTIAL_W = EDGE_W + 2
) (
    input  logic                   clk_i,
    input  logic                   rst_ni,
    input  logic                   enable_i,
    input  logic [2:0][EDGE_W-1:0] edges_i,
    input  logic                   s23_far_i,     // P0 on the far face
    input  logic [2:0]             s23_low_i,     // quarter of P0
    input  logic [EDGE_W-2:0]      s23_rest_i,    // in quarter steps
    input  logic [PARTIAL_W-1:0]   s23_partial_i,
    input  logic                   s24_moving_i,
    input  logic [REST_W:0]        s24_slope_i,
    input  logic [2:0]             s24_first_i,   // quarter-slab of P0
    input  logic [1:0]             s26_lateral_i, // 26 and 27: a lateral axis
    output logic [1:0][3:0]        s31_quarter_o,
    output logic [1:0][REST_W-1:0] s31_rest_o,
    output logic [1:0][REST_W:0]   s31_slope_o,
    output logic [1:0][2:0]        s31_low_o
);
  localparam int unsigned SHIFT = gridrt_state_pkg::UNIT_SHIFT;
  localparam int unsigned FINE = REST_W + 1 - PARTIAL_W;  // bits below the partial increment's
  localparam int unsigned AT_W = REST_W + 4;  // from -8 quarters to almost one, signed
  localparam int unsigned LOW_W = 18;  // of the slope, for one multiplier

  logic [5:0] far;  // of clocks 24 to 29
  logic [6:0][2:0] low;  // of clocks 24 to 30

  // 24-27: position - quarter-slabs * slope. On the far face it is a unit before that face.
  logic [PARTIAL_W:0] s24_here, s25_here;
  logic [3:0] steps;
  logic [LOW_W+2:0] s25_low_part;
  logic [REST_W+3-LOW_W:0] s25_high_part, s26_high_part;
  logic [AT_W:0] less;
  logic [AT_W-1:0] s26_at, s27_at;
  assign steps = {1'b0, s24_first_i} + 4'd1;
  assign less = {1'b0, s25_here, FINE'(0), 1'b0} - (AT_W + 1)'({s25_low_part, far[1]});
  always_ff @(posedge clk_i) begin
    if (enable_i) begin
      s24_here <= {2'b00, s23_rest_i, (SHIFT - FINE)'(0)} + {1'b0, s23_partial_i};
      s25_here <= s24_here;
      s25_low_part <= (LOW_W + 3)'(s24_slope_i[LOW_W-1:0]) * (LOW_W + 3)'(steps);
      s25_high_part <= (REST_W + 4 - LOW_W)'(s24_slope_i[REST_W:LOW_W]) *
                       (REST_W + 4 - LOW_W)'(steps);
      s26_at <= less[AT_W:1];
      s26_high_part <= s25_high_part;
      s27_at <= {s26_at[AT_W-1:LOW_W] - s26_high_part, s26_at[LOW_W-1:0]};
    end
  end

  // 28-30: quarters and the rest within one: 8 quarters' edge added to what is below the block, then 4, 2
  // and 1 taken away.
  logic [EDGE_W-1:0] s27_edge, s28_edge, s29_edge;
  logic s27_below;
  logic [EDGE_W+2:0] less8;
  logic [EDGE_W+2:0] less4;
  logic [EDGE_W+1:0] less2, after4;
  logic [EDGE_W:0] less1;
  logic [EDGE_W+1:0] s28_high;
  logic [EDGE_W-1:0] s29_high;
  logic [EDGE_W-2:0] s30_high;
  logic [2:0][SHIFT-1:0] fraction;  // of clocks 28 to 30
  logic s28_above, s29_above;
  logic s29_four, s29_two;
  logic [3:0] s30_quarter;
  assign s27_below = s27_at[AT_W-1];
  gridrt_add_gated #(
      .WIDTH(EDGE_W + 3)
  ) i_less8 (
      .a_valid_i(1'b1),
      .a_i(s27_at[AT_W-1:SHIFT]),
      .b_valid_i(s27_below),
      .b_i({s27_edge, 3'b000}),
      .sum_o(less8)
  );
  assign less4 = {1'b0, s28_high} - {1'b0, s28_edge, 2'b00};
  assign after4 = less4[EDGE_W+2] ? s28_high : less4[EDGE_W+1:0];
  assign less2 = after4 - {1'b0, s28_edge, 1'b0};
  assign less1 = {1'b0, s29_high} - {1'b0, s29_edge};
  always_ff @(posedge clk_i) begin
    if (enable_i) begin
      s27_edge <= s26_lateral_i[1] ? edges_i[2] : s26_lateral_i[0] ? edges_i[1] : edges_i[0];
      s28_edge <= s27_edge;
      s29_edge <= s28_edge;
      fraction <= {fraction[1:0], s27_at[SHIFT-1:0]};
      s28_high <= less8[EDGE_W+1:0];
      s28_above <= far[3] ^ s27_below;
      s29_high <= less2[EDGE_W+1] ? after4[EDGE_W-1:0] : less2[EDGE_W-1:0];
      s29_above <= s28_above;
      s29_four <= !less4[EDGE_W+2];
      s29_two <= !less2[EDGE_W+1];
      s30_high <= less1[EDGE_W] ? s29_high[EDGE_W-2:0] : less1[EDGE_W-2:0];
      s30_quarter <= {s29_above, low[5] & ~{3{far[5]}}} +
                     {1'b0, s29_four, s29_two, !less1[EDGE_W]};
    end
  end

  // What rides along.
  logic [REST_W:0] s30_slope;
  always_ff @(posedge clk_i) begin
    if (enable_i) begin
      far <= {far[4:0], s23_far_i};
      low <= {low[5:0], s23_low_i};
    end
  end
  gridrt_delay #(
      .WIDTH (REST_W + 1),
      .CLOCKS(6)
  ) i_slope (
      .clk_i,
      .rst_ni,
      .enable_i,
      .data_i(s24_slope_i),
      .data_o(s30_slope)
  );

  // After clock 31 the second axis is in the registers of clock 30.
  logic [3:0] s31_quarter;
  logic [REST_W-1:0] s31_rest;
  logic [REST_W:0] s31_slope;
  logic [2:0] s31_low;
  always_ff @(posedge clk_i) begin
    if (enable_i) begin
      s31_quarter <= s30_quarter;
      s31_rest  <= {s30_high, fraction[2]};
      s31_slope <= s30_slope;
      s31_low   <= low[6];
    end
  end
  assign s31_quarter_o = {s30_quarter, s31_quarter};
  assign s31_rest_o  = {s30_high, fraction[2], s31_rest};
  assign s31_slope_o = {s30_slope, s31_slope};
  assign s31_low_o   = {low[6], s31_low};

`ifdef GRIDRT_ASSERT
  logic [4:0] moving;  // of clocks 25 to 29
  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) moving <= '0;
    else if (enable_i) moving <= {moving[3:0], s24_moving_i};
  end
  always_ff @(posedge clk_i) begin
    if (rst_ni && enable_i && moving[2]) assert (!less8[EDGE_W+2]);
    if (rst_ni && enable_i && moving[4]) begin
      assert ((less1[EDGE_W] ? s29_high : less1[EDGE_W-1:0]) < s29_edge);
    end
  end
`endif
  logic unused;
  assign unused = &{1'b0, s24_moving_i, less, less8, less4, less2, less1, far};
endmodule
