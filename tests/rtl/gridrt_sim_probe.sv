// A board for the tests of its link: says the bytes again that it hears. Byte 0xFF: takes no more;
// 0xFE: goes on taking and says nothing more; writing register 0x140 ends both. Registers read as
// their address plus 256 times the bytes heard; those above 0x7FF are never served.
module gridrt_sim_probe (
    input  logic        clk_i,
    input  logic        rst_ni,
    input  logic        rx_valid_i,
    output logic        rx_ready_o,
    input  logic [ 7:0] rx_data_i,
    output logic        tx_valid_o,
    input  logic        tx_ready_i,
    output logic [ 7:0] tx_data_o,
    input  logic        reg_valid_i,
    input  logic        reg_write_i,
    input  logic [11:0] reg_address_i,
    input  logic [31:0] reg_write_data_i,
    output logic        reg_ready_o,
    output logic [31:0] reg_read_data_o
);
  logic deaf, mute;
  logic fifo_ready, push;
  logic [15:0] heard;
  logic [3:0] wait_count;
  logic [4:0] unused_count;

  assign rx_ready_o = fifo_ready && !deaf;
  assign push = rx_valid_i && rx_ready_o;

  gridrt_fifo #(
      .WIDTH(8),
      .DEPTH(16)
  ) u_bytes (
      .clk_i,
      .rst_ni,
      .in_valid_i(push && !mute),
      .in_ready_o(fifo_ready),
      .in_data_i(rx_data_i),
      .out_valid_o(tx_valid_o),
      .out_ready_i(tx_ready_i),
      .out_data_o(tx_data_o),
      .count_o(unused_count)
  );

  assign reg_ready_o = reg_valid_i && wait_count == '1 && !reg_address_i[11];
  assign reg_read_data_o = {8'd0, heard, 8'd0} + 32'(reg_address_i);

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      deaf <= 1'b0;
      mute <= 1'b0;
      heard <= '0;
      wait_count <= '0;
    end else begin
      wait_count <= (reg_valid_i && !reg_ready_o) ? wait_count + 1'b1 : '0;
      if (push) begin
        heard <= heard + 16'd1;
        if (rx_data_i == 8'hFF) deaf <= 1'b1;
        if (rx_data_i == 8'hFE) mute <= 1'b1;
      end
      if (reg_ready_o && reg_write_i && reg_address_i == 12'h140 &&
          reg_write_data_i == gridrt_protocol_pkg::RESET_KEY) begin
        deaf <= 1'b0;
        mute <= 1'b0;
      end
    end
  end
endmodule
