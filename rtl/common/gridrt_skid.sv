// Registers in a stream that may stand on a long way: what is offered and whether there is room both
// come from registers. Takes and gives one element a clock.
module gridrt_skid #(
    parameter int unsigned WIDTH = 8
) (
    input  logic             clk_i,
    input  logic             rst_ni,
    input  logic             in_valid_i,
    output logic             in_ready_o,
    input  logic [WIDTH-1:0] in_data_i,
    output logic             out_valid_o,
    input  logic             out_ready_i,
    output logic [WIDTH-1:0] out_data_o
);
  if (WIDTH < 1) begin : gen_illegal
    $error("gridrt_skid: WIDTH must be positive");
  end

  logic spare_valid, moves;  // spare: came while the one before could not leave
  logic [WIDTH-1:0] spare;
  assign in_ready_o = !spare_valid;
  assign moves = !out_valid_o || out_ready_i;

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      out_valid_o <= 1'b0;
      spare_valid <= 1'b0;
    end else if (moves) begin
      out_valid_o <= in_valid_i || spare_valid;
      spare_valid <= 1'b0;
    end else if (in_valid_i) begin
      spare_valid <= 1'b1;
    end
  end
  always_ff @(posedge clk_i) begin
    if (moves) out_data_o <= spare_valid ? spare : in_data_i;
    if (!spare_valid) spare <= in_data_i;
  end
endmodule
