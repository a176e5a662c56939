// The dominant axis of a ray in setup: the one with the largest length / edge, compared exactly by
// cross products; the first one wins ties. Clocks 2 to 9 of gridrt_setup.
module gridrt_setup_axis (
    input  logic                                                                      clk_i,
    input  logic                                                                      rst_ni,
    input  logic                                                                      enable_i,
    input  logic [2:0]                                                                valid_i, // of clocks 8 to 6
    input  logic [2:0][gridrt_state_pkg::EDGE_W-1:0]                                  edges_i,
    input  logic [2:0][gridrt_pkg::MAX_B-1:0]                                         s2_length_i,
    output logic [1:0]                                                                s9_axis_o,
    output logic [gridrt_pkg::MAX_B-1:0]                                              s9_length_o,
    output logic [1:0][gridrt_pkg::MAX_B-1:0]                                         s9_lateral_o,
    // Length on a lateral axis times the dominant axis's edge.
    output logic [1:0][gridrt_state_pkg::EDGE_W+gridrt_pkg::MAX_B-1:0]                s9_product_o
);
  localparam int unsigned MAX_B = gridrt_pkg::MAX_B;
  localparam int unsigned PRODUCT_W = gridrt_state_pkg::EDGE_W + MAX_B;

  logic [2:0][MAX_B-1:0] s6_length, s7_length, s8_length;
  // ahead[a]: length of axis a + 1 times edge of a; behind[a]: length of axis a + 2 times edge of a.
  logic [2:0][PRODUCT_W-1:0] s7_ahead, s7_behind, s8_ahead, s8_behind;
  logic s8_1_over_0, s8_2_over_0, s8_2_over_1;
  logic [1:0] s8_axis;

  gridrt_delay #(
      .WIDTH (3 * MAX_B),
      .CLOCKS(4)
  ) i_length (
      .clk_i,
      .rst_ni,
      .enable_i,
      .data_i(s2_length_i),
      .data_o(s6_length)
  );

  always_comb begin
    s8_axis = s8_2_over_0 ? 2'd2 : 2'd0;
    if (s8_1_over_0) s8_axis = s8_2_over_1 ? 2'd2 : 2'd1;
  end

  always_ff @(posedge clk_i) begin
    if (enable_i && valid_i[0]) begin
      s7_length <= s6_length;
      for (int unsigned a = 0; a < 3; a++) begin
        s7_ahead[a]  <= s6_length[(a+1)%3] * edges_i[a];
        s7_behind[a] <= s6_length[(a+2)%3] * edges_i[a];
      end
    end
    if (enable_i && valid_i[1]) begin
      s8_length <= s7_length;
      s8_ahead <= s7_ahead;
      s8_behind <= s7_behind;
      s8_1_over_0 <= s7_ahead[0] > s7_behind[1];
      s8_2_over_0 <= s7_behind[0] > s7_ahead[2];
      s8_2_over_1 <= s7_ahead[1] > s7_behind[2];
    end
    if (enable_i && valid_i[2]) begin
      s9_axis_o <= s8_axis;
      for (int unsigned a = 0; a < 3; a++) begin
        if (s8_axis == 2'(a)) begin
          s9_length_o <= s8_length[a];
          s9_lateral_o <= {s8_length[(a+2)%3], s8_length[(a+1)%3]};
          s9_product_o <= {s8_behind[a], s8_ahead[a]};
        end
      end
    end
  end
endmodule
