// Where the march starts on the lateral axes, in clocks 24 to 29 of gridrt_setup. The position at the
// first half-face behind P0 is P0's plus the partial increment; from there it goes back, an increment
// for each half-slab, to the block's entry face, so that traversal treats all blocks alike. (It may
// get below the block; samples before P0 are held at P0's half by `low`.)
module gridrt_setup_back (
    input  logic                                              clk_i,
    input  logic                                              rst_ni,
    input  logic                                              enable_i,
    input  logic                                              moving_i,       // a ray in clock 24
    input  logic [2:0][gridrt_state_pkg::EDGE_W-1:0]          edges_i,
    input  logic [1:0]                                        s24_axis_i,
    input  logic [1:0]                                        s24_first_i,    // half-slab of P0
    input  logic [1:0]                                        s24_far_i,      // P0 on the far face
    input  logic [1:0][1:0]                                   s24_low_i,      // half of P0
    input  logic [1:0][gridrt_state_pkg::EDGE_W-1:0]          s24_rest_i,     // in half steps
    input  logic [1:0][gridrt_state_pkg::REST_W:0]            s24_slope_i,
    input  logic [1:0][gridrt_state_pkg::REST_W:0]            s24_partial_i,
    output logic [1:0][2:0]                                   s29_half_o,
    output logic [1:0][gridrt_state_pkg::REST_W-1:0]          s29_rest_o,
    output logic [1:0][gridrt_state_pkg::REST_W:0]            s29_slope_o,
    output logic [1:0]                                        s29_first_o,
    output logic [1:0][1:0]                                   s29_low_o
);
  localparam int unsigned EDGE_W = gridrt_state_pkg::EDGE_W;
  localparam int unsigned REST_W = gridrt_state_pkg::REST_W;
  localparam int unsigned SHIFT = gridrt_state_pkg::UNIT_SHIFT;

  logic [4:1] held;
  logic [4:0] valid;  // of clocks 24 to 28
  assign valid = {held, moving_i};
  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) held <= '0;
    else if (enable_i) held <= valid[3:0];
  end
  // Registers of clocks 25 to 29.
  logic [4:0][1:0] first;
  logic [4:0][1:0][1:0] low;
  logic [4:0][1:0][2:0] half;
  logic [4:0][1:0][REST_W-1:0] rest;
  logic [4:0][1:0][REST_W:0] slope;
  logic [4:0][1:0][EDGE_W-1:0] edges;
  logic [1:0][REST_W:0] back;  // in clock 25: from P0 to the half-face before it, minus the partial
  assign s29_half_o = half[4];
  assign s29_rest_o = rest[4];
  assign s29_slope_o = slope[4];
  assign s29_first_o = first[4];
  assign s29_low_o = low[4];

  // In clock 25 + i: position minus `back`, with one half-voxel borrowed if that is below 0.
  logic [3:0][1:0][REST_W+1:0] less;
  logic [3:0][1:0][REST_W-1:0] moved;
  always_comb begin
    for (int unsigned i = 0; i < 4; i++) begin
      for (int unsigned n = 0; n < 2; n++) begin
        less[i][n] = {2'b00, rest[i][n]} - {1'b0, (i == 0) ? back[n] : slope[i][n]};
        moved[i][n] = less[i][n][REST_W-1:0];
        if (less[i][n][REST_W+1]) begin
          moved[i][n][REST_W-1:SHIFT] = less[i][n][REST_W-1:SHIFT] + edges[i][n][EDGE_W-2:0];
        end
      end
    end
  end

  always_ff @(posedge clk_i) begin
    if (enable_i && valid[0]) begin
      first[0] <= s24_first_i;
      low[0] <= s24_low_i;
      slope[0] <= s24_slope_i;
      for (int unsigned n = 0; n < 2; n++) begin
        half[0][n] <= {1'b0, s24_low_i[n]};
        rest[0][n] <= {s24_rest_i[n][EDGE_W-2:0], {SHIFT{s24_far_i[n]}}};
        back[n] <= s24_slope_i[n] - s24_partial_i[n];
        for (int unsigned a = 0; a < 3; a++) begin
          if (s24_axis_i == 2'(a)) edges[0][n] <= edges_i[(a+n+1)%3];
        end
      end
    end
    for (int unsigned i = 0; i < 4; i++) begin
      if (enable_i && valid[i+1]) begin
        first[i+1] <= first[i];
        low[i+1] <= low[i];
        slope[i+1] <= slope[i];
        edges[i+1] <= edges[i];
        half[i+1] <= half[i];
        rest[i+1] <= rest[i];
        if (2'(i) <= first[i]) begin
          for (int unsigned n = 0; n < 2; n++) begin
            rest[i+1][n] <= moved[i][n];
            half[i+1][n] <= half[i][n] - 3'(less[i][n][REST_W+1]);
          end
        end
      end
    end
  end

`ifdef GRIDRT_ASSERT
  always_ff @(posedge clk_i) begin
    for (int unsigned n = 0; n < 2; n++) begin
      if (rst_ni && enable_i && valid[0]) assert (s24_partial_i[n] <= s24_slope_i[n]);
      if (rst_ni && enable_i && valid[4]) assert ({1'b0, rest[3][n]} < {edges[3][n], SHIFT'(0)});
    end
  end
`endif
  logic unused;
  assign unused = &{1'b0, edges[4]};
endmodule
