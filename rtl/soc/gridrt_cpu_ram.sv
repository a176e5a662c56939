// The soft core's memory, with firmware in it at power-up: a word a clock, bytes can be written on
// their own. gridrt_firmware_image.svh is made by the build (firmware/soft_core).
module gridrt_cpu_ram #(
    parameter int unsigned WORDS = 4096,
    localparam int unsigned ADDRESS_W = $clog2(WORDS)
) (
    input  logic                 clk_i,
    input  logic                 select_i,
    input  logic [          3:0] write_i,  // of each byte
    input  logic [ADDRESS_W-1:0] address_i,
    input  logic [         31:0] write_data_i,
    output logic [         31:0] read_data_o  // a clock later
);
  (* ram_style = "block" *)
  logic [7:0] lane0[WORDS];
  (* ram_style = "block" *)
  logic [7:0] lane1[WORDS];
  (* ram_style = "block" *)
  logic [7:0] lane2[WORDS];
  (* ram_style = "block" *)
  logic [7:0] lane3[WORDS];

`ifdef GRIDRT_FIRMWARE
  initial begin
`include "gridrt_firmware_image.svh"
  end
`endif

  always_ff @(posedge clk_i) begin
    if (select_i) begin
      if (write_i[0]) lane0[address_i] <= write_data_i[7:0];
      if (write_i[1]) lane1[address_i] <= write_data_i[15:8];
      if (write_i[2]) lane2[address_i] <= write_data_i[23:16];
      if (write_i[3]) lane3[address_i] <= write_data_i[31:24];
      read_data_o <= {lane3[address_i], lane2[address_i], lane1[address_i], lane0[address_i]};
    end
  end

  if (WORDS < 256 || WORDS != 1 << ADDRESS_W) begin : gen_illegal
    $error("gridrt_cpu_ram: WORDS must be a power of two, 256 or more");
  end
endmodule
