// Small memory of distributed RAM: one write port, one read port without a clock.
module gridrt_lutram #(
    parameter int unsigned WIDTH = 8,
    parameter int unsigned DEPTH = 16,
    localparam int unsigned ADDRESS_W = (DEPTH > 1) ? $clog2(DEPTH) : 1
) (
    input  logic                 clk_i,
    input  logic                 write_i,
    input  logic [ADDRESS_W-1:0] write_address_i,
    input  logic [    WIDTH-1:0] write_data_i,
    input  logic [ADDRESS_W-1:0] read_address_i,
    output logic [    WIDTH-1:0] read_data_o
);
  if (WIDTH < 1 || DEPTH < 1) begin : gen_illegal
    $error("gridrt_lutram: WIDTH and DEPTH must be positive");
  end

  (* ram_style = "distributed" *)
  logic [WIDTH-1:0] memory[DEPTH];

  always_ff @(posedge clk_i) begin
    if (write_i) memory[write_address_i] <= write_data_i;
  end
  assign read_data_o = memory[read_address_i];
endmodule
