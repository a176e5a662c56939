// A register in a stream, for an element every other clock: what is offered and whether there is room
// both come from registers. What has left stays for a clock more, for those who learn of it late.
module gridrt_hold #(
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
    $error("gridrt_hold: WIDTH must be positive");
  end

  assign in_ready_o = !out_valid_o;

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) out_valid_o <= 1'b0;
    else out_valid_o <= out_valid_o ? !out_ready_i : in_valid_i;
  end
  always_ff @(posedge clk_i) begin
    if (!out_valid_o) out_data_o <= in_data_i;
  end
endmodule
