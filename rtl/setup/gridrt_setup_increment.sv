// How much a lateral axis moves, in clocks 10 to 24 of gridrt_setup: per half-slab, and within the
// partial half-slab from P0 to the next half-face.
module gridrt_setup_increment #(
    localparam int unsigned EDGE_W = gridrt_state_pkg::EDGE_W,
    localparam int unsigned MAX_B = gridrt_pkg::MAX_B,
    localparam int unsigned PRODUCT_W = EDGE_W + MAX_B,
    localparam int unsigned SLOPE_W = gridrt_state_pkg::REST_W + 1
) (
    input  logic                 clk_i,
    input  logic                 rst_ni,
    input  logic                 enable_i,
    input  logic [2:0]           valid_i,        // of clocks 11 to 9
    input  logic [PRODUCT_W-1:0] s9_product_i,   // length on this axis * edge of the dominant axis
    input  logic [MAX_B-1:0]     s9_length_i,    // of the dominant axis
    input  logic [EDGE_W-1:0]    s10_ahead_i,    // twice the distance to the next half-face
    input  logic [MAX_B-1:0]     s10_lateral_i,  // length on this axis
    input  logic [MAX_B-1:0]     s10_length_i,
    output logic                 s24_moving_o,   // the ray has a length
    output logic [SLOPE_W-1:0]   s24_slope_o,
    output logic [SLOPE_W-1:0]   s24_partial_o
);
  localparam int unsigned UNIT_SHIFT = gridrt_state_pkg::UNIT_SHIFT;
  // The partial half-slab needs fewer bits behind the point: its error does not grow.
  localparam int unsigned PARTIAL_BITS = 3;
  localparam int unsigned PARTIAL_W = EDGE_W + PARTIAL_BITS - 1;

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
      .valid_i(valid_i[0] && s9_length_i != '0),
      .dividend_i({s9_product_i, UNIT_SHIFT'(0)}),
      .divisor_i(s9_length_i),
      .valid_o(s24_moving_o),
      .quotient_o(s24_slope_o),
      .remainder_o(rest_slope)
  );

  // 11 product, 12-21 division.
  logic [PRODUCT_W-1:0] s11_product;
  logic [MAX_B-1:0] s11_length;
  logic [PARTIAL_W-1:0] s21_partial, s24_partial;
  logic unused_partial;
  always_ff @(posedge clk_i) begin
    if (enable_i && valid_i[1]) begin
      s11_product <= s10_ahead_i * s10_lateral_i;
      s11_length  <= s10_length_i;
    end
  end
  gridrt_divide_pipe #(
      .DIVIDEND_W(PRODUCT_W + PARTIAL_BITS - 1),
      .DIVISOR_W(MAX_B),
      .QUOTIENT_W(PARTIAL_W),
      .STEP(2)
  ) i_partial (
      .clk_i,
      .rst_ni,
      .enable_i,
      .valid_i(valid_i[2] && s11_length != '0),
      .dividend_i({s11_product, (PARTIAL_BITS - 1)'(0)}),
      .divisor_i(s11_length),
      .valid_o(unused_partial),
      .quotient_o(s21_partial),
      .remainder_o(rest_partial)
  );
  gridrt_delay #(
      .WIDTH(PARTIAL_W),
      .CLOCKS(3)
  ) i_wait (
      .clk_i,
      .rst_ni,
      .enable_i,
      .data_i(s21_partial),
      .data_o(s24_partial)
  );
  assign s24_partial_o = {s24_partial, (gridrt_pkg::FRACTION - PARTIAL_BITS)'(0)};

  logic unused;
  assign unused = &{1'b0, unused_partial, rest_slope, rest_partial};
endmodule
