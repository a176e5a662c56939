// CRC-32C (Castagnoli, reflected 0x82F63B78), a byte a clock: the register's next value. It starts
// with all ones; the CRC is its complement.
module gridrt_crc32c (
    input  logic [31:0] crc_i,
    input  logic [ 7:0] data_i,
    output logic [31:0] crc_o
);
  always_comb begin
    crc_o = crc_i ^ {24'd0, data_i};
    for (int unsigned i = 0; i < 8; i++) begin
      crc_o = {1'b0, crc_o[31:1]} ^ (crc_o[0] ? 32'h82F63B78 : 32'd0);
    end
  end
endmodule
