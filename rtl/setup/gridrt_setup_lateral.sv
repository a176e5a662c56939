// The lateral axes of a ray: the one behind the dominant axis in its even clock, the next one in the
// clock after that; so a word of theirs is picked from three in the two clocks that follow.
module gridrt_setup_lateral (
    input  logic       clk_i,
    input  logic       enable_i,
    input  logic       odd_i,     // gridrt_setup says what this is
    input  logic [1:0] axis_i,    // dominant, from an odd clock on
    output logic [1:0] lateral_o
);
  logic [1:0] lateral;
  always_comb begin
    case ({odd_i, axis_i})
      {1'b1, 2'd0}, {1'b0, 2'd2} : lateral = 2'd1;
      {1'b1, 2'd1}, {1'b0, 2'd0} : lateral = 2'd2;
      default: lateral = 2'd0;
    endcase
  end
  always_ff @(posedge clk_i) begin
    if (enable_i) lateral_o <= lateral;
  end
endmodule
