// The dominant axis of a ray in setup: the one with the largest length / edge, compared exactly by
// cross products; the first one wins ties. Clocks 2 to 13 of gridrt_setup. Three multipliers make
// three products in each of two clocks; those that the lateral axes' increments need leave one by one.
module gridrt_setup_axis #(
    parameter int unsigned B = 17,  // lattice bits
    localparam int unsigned EDGE_W = gridrt_state_pkg::EDGE_W,
    localparam int unsigned MAX_B = gridrt_pkg::MAX_B,
    localparam int unsigned PRODUCT_W = EDGE_W + MAX_B
) (
    input  logic                       clk_i,
    input  logic                       enable_i,
    input  logic                       odd_i,         // gridrt_setup says what this is
    input  logic [2:0][    EDGE_W-1:0] edges_i,
    input  logic [2:0][           B:0] s2_d_i,
    output logic [1:0]                 s8_axis_o,
    output logic [1:0]                 s9_axis_o,
    output logic [1:0]                 s10_lateral_o, // 10 and 11: a lateral axis
    output logic [     MAX_B-1:0]      s9_length_o,   // of the dominant axis
    output logic [     MAX_B-1:0]      s12_length_o,  // on a lateral axis: 12 and 13
    // Length on a lateral axis times the dominant axis's edge: 9 and 10.
    output logic [ PRODUCT_W-1:0]      s9_product_o
);
  logic even_clock, odd_clock;
  assign even_clock = enable_i && odd_i;
  assign odd_clock  = enable_i && !odd_i;

  logic [2:0][B-1:0] length;
  logic [2:0][MAX_B-1:0] factor;
  logic [2:0][MAX_B-1:0] s4_length, s6_length, s8_length, s9_length, s11_length;
  // Clocks 5 and 6, then on: first the length of axis a + 1 times the edge of a (ahead), then the
  // length of axis a + 2 times that edge (behind).
  logic [2:0][PRODUCT_W-1:0] s5_product, s6_product, s7_product, s8_product;
  logic s7_1_over_0, s7_2_over_0, s7_2_over_1;
  logic [1:0] s8_axis, s9_axis, s10_lateral, s11_lateral;
  assign s8_axis_o = s8_axis;
  assign s9_axis_o = s9_axis;
  assign s10_lateral_o = s10_lateral;

  always_comb begin
    for (int unsigned a = 0; a < 3; a++) begin
      length[a] = s2_d_i[a][B] ? B'(-s2_d_i[a]) : s2_d_i[a][B-1:0];
      factor[a] = odd_i ? s4_length[(a+2)%3] : s4_length[(a+1)%3];
    end
  end
  always_ff @(posedge clk_i) begin
    if (enable_i) begin
      for (int unsigned a = 0; a < 3; a++) begin
        s5_product[a] <= factor[a] * edges_i[a];
      end
      s6_product <= s5_product;
      s7_product <= s6_product;
      s8_product <= s7_product;
      s9_product_o <= s8_axis[1] ? s8_product[2] : s8_axis[0] ? s8_product[1] : s8_product[0];
      s11_lateral <= s10_lateral;
      s12_length_o <= s11_lateral[1] ? s11_length[2]
          : s11_lateral[0] ? s11_length[1] : s11_length[0];
    end
    if (even_clock) begin
      for (int unsigned a = 0; a < 3; a++) begin
        s4_length[a] <= MAX_B'(length[a]);
      end
      s6_length <= s4_length;
      s8_length <= s6_length;
      s8_axis <= s7_2_over_0 ? 2'd2 : 2'd0;
      if (s7_1_over_0) s8_axis <= s7_2_over_1 ? 2'd2 : 2'd1;
    end
    // Before clock 7 the ray's `behind` is in s5_product and its `ahead` in s6_product. (For > yosys
    // would need more logic than for <.)
    if (odd_clock) begin
      s7_1_over_0 <= s5_product[1] < s6_product[0];
      s7_2_over_0 <= s6_product[2] < s5_product[0];
      s7_2_over_1 <= s5_product[2] < s6_product[1];
      s9_length_o <= s8_axis[1] ? s8_length[2] : s8_axis[0] ? s8_length[1] : s8_length[0];
      s9_length <= s8_length;
      s9_axis <= s8_axis;
      s11_length <= s9_length;
    end
  end
  gridrt_setup_lateral i_lateral (
      .clk_i,
      .enable_i,
      .odd_i,
      .axis_i(s9_axis),
      .lateral_o(s10_lateral)
  );
endmodule
