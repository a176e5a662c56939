// How much the lateral axes move, in clocks 9 to 25 of gridrt_setup: per quarter-slab, and within
// the partial quarter-slab from P0 to the next quarter-face. One axis after the other.
module gridrt_setup_increment #(
    localparam int unsigned EDGE_W = gridrt_state_pkg::EDGE_W,
    localparam int unsigned MAX_B = gridrt_pkg::MAX_B,
    localparam int unsigned PRODUCT_W = EDGE_W + MAX_B,
    localparam int unsigned SLOPE_W = gridrt_state_pkg::REST_W + 1,
    localparam int unsigned PARTIAL_W = EDGE_W + 2
) (
    input  logic                 clk_i,
    input  logic                 rst_ni,
    input  logic                 enable_i,
    input  logic                 s9_valid_i,     // in clocks 9 and 10
    input  logic [PRODUCT_W-1:0] s9_product_i,   // length on this axis * edge of the dominant axis
    input  logic [MAX_B-1:0]     s9_length_i,    // of the dominant axis
    input  logic [EDGE_W-1:0]    s12_ahead_i,    // four times the distance to the next quarter-face
    input  logic [MAX_B-1:0]     s12_lateral_i,  // length on this axis
    input  logic                 s13_valid_i,    // in clocks 13 and 14
    input  logic [MAX_B-1:0]     s13_length_i,
    output logic [PARTIAL_W-1:0] s23_partial_o,  // in units of 2^(SLOPE_W - PARTIAL_W) of the slope's
    output logic                 s24_moving_o,   // the ray has a length
    output logic [SLOPE_W-1:0]   s24_slope_o
);
  localparam int unsigned UNIT_SHIFT = gridrt_state_pkg::UNIT_SHIFT;
  // The partial quarter-slab needs fewer bits behind the point: its error does not grow.
  localparam int unsigned PARTIAL_BITS = 4;
  if (gridrt_pkg::FRACTION - PARTIAL_BITS != SLOPE_W - PARTIAL_W) begin : gen_illegal
    $error("gridrt_setup_increment: the partial increment has %0d bits behind the point",
           PARTIAL_BITS);
  end

  logic [MAX_B-1:0] rest_slope, rest_partial;
  gridrt_divide_pipe #(
      .DIVIDEND_W(PRODUCT_W + UNIT_SHIFT),
      .DIVISOR_W(MAX_B),
      .QUOTIENT_W(SLOPE_W),
      .STEP(2)
  ) i_slope (
      .clk_i,
      .rst_ni,
      .enable_i,
      .valid_i(s9_valid_i && s9_length_i != '0),
      .dividend_i({s9_product_i, UNIT_SHIFT'(0)}),
      .divisor_i(s9_length_i),
      .valid_o(s24_moving_o),
      .quotient_o(s24_slope_o),
      .remainder_o(rest_slope)
  );

  logic [PRODUCT_W-1:0] s13_product;
  logic s23_moving;
  always_ff @(posedge clk_i) begin
    if (enable_i) s13_product <= s12_ahead_i * s12_lateral_i;
  end
  gridrt_divide_pipe #(
      .DIVIDEND_W(PRODUCT_W + PARTIAL_BITS - 2),
      .DIVISOR_W(MAX_B),
      .QUOTIENT_W(PARTIAL_W),
      .STEP(2)
  ) i_partial (
      .clk_i,
      .rst_ni,
      .enable_i,
      .valid_i(s13_valid_i && s13_length_i != '0),
      .dividend_i({s13_product, (PARTIAL_BITS - 2)'(0)}),
      .divisor_i(s13_length_i),
      .valid_o(s23_moving),
      .quotient_o(s23_partial_o),
      .remainder_o(rest_partial)
  );

`ifdef GRIDRT_ASSERT
  logic [PARTIAL_W-1:0] s24_partial;
  logic s24_partial_moving;
  always_ff @(posedge clk_i) begin
    if (enable_i) begin
      s24_partial <= s23_partial_o;
      s24_partial_moving <= s23_moving;
    end
    if (rst_ni && enable_i && s24_moving_o) begin
      assert (s24_partial_moving);
      assert ({s24_partial, (SLOPE_W - PARTIAL_W)'(0)} <= s24_slope_o);
    end
  end
`endif
  logic unused;
  assign unused = &{1'b0, s23_moving, rest_slope, rest_partial};
endmodule
