// The whole device between a UTMI PHY and a serial flash: the USB block and the board behind it.
module gridrt_device #(
    parameter int unsigned B = 17,  // of gridrt_board, as those below
    parameter int unsigned PES = 4,
    parameter int unsigned CLOCK_HZ = 60000000,
    parameter logic [63:0] NAME = 64'h6D6973,  // ASCII, the first letter lowest: "sim"
    parameter int unsigned HANG_CLOCKS = 1 << 20,
    parameter int unsigned BUS_CLOCKS = 1 << 20,
    parameter logic [127:0] SERIAL = 128'h304D4953  // as in LUNA's descriptors: "SIM0"
) (
    input  logic       clk_i,  // 60 MHz, of the PHY
    input  logic       rst_ni,
    input  logic [7:0] utmi_rx_data_i,
    input  logic       utmi_rx_active_i,
    input  logic       utmi_rx_valid_i,
    input  logic       utmi_rx_error_i,
    output logic [7:0] utmi_tx_data_o,
    output logic       utmi_tx_valid_o,
    input  logic       utmi_tx_ready_i,
    input  logic [1:0] utmi_line_state_i,
    input  logic       utmi_busy_i,
    output logic [1:0] utmi_xcvr_select_o,
    output logic       utmi_term_select_o,
    output logic [1:0] utmi_op_mode_o,
    output logic       flash_cs_no,
    output logic       flash_clk_o,
    output logic       flash_mosi_o,
    input  logic       flash_miso_i,
    // What is going on, for lamps and tests.
    output logic       suspended_o,
    output logic [1:0] speed_o,  // 0: high, 1: full
    output logic       hears_o,  // the board takes a byte of the host's
    output logic       waits_o,  // it would, but the host has sent none
    output logic       speaks_o,  // the USB block takes a byte of the board's
    output logic       blocked_o  // it does not take the byte that is there
);
  logic rx_valid, rx_ready, tx_valid, tx_ready;
  logic [7:0] rx_data, tx_data;
  logic request_valid, request_set, answer_valid, answer_good, body_write, event_valid, event_taken;
  logic [7:0] request_id, body_wdata, body_rdata, event_id, event_data;
  logic [6:0] request_length, answer_length;
  logic [5:0] body_address, event_address;
  logic unused_bus_reset;

  assign hears_o = rx_valid && rx_ready;
  assign waits_o = !rx_valid && rx_ready;
  assign speaks_o = tx_valid && tx_ready;
  assign blocked_o = tx_valid && !tx_ready;

  gridrt_usb u_usb (
      .clk_i,
      .rst_ni,
      .utmi_rx_data_i,
      .utmi_rx_active_i,
      .utmi_rx_valid_i,
      .utmi_rx_error_i,
      .utmi_tx_data_o,
      .utmi_tx_valid_o,
      .utmi_tx_ready_i,
      .utmi_line_state_i,
      .utmi_busy_i,
      .utmi_xcvr_select_o,
      .utmi_term_select_o,
      .utmi_op_mode_o,
      .suspended_o,
      .bus_reset_o(unused_bus_reset),
      .speed_o,
      .rx_valid_o(rx_valid),
      .rx_ready_i(rx_ready),
      .rx_data_o(rx_data),
      .tx_valid_i(tx_valid),
      .tx_ready_o(tx_ready),
      .tx_data_i(tx_data),
      .request_valid_o(request_valid),
      .request_set_o(request_set),
      .request_id_o(request_id),
      .request_length_o(request_length),
      .answer_valid_i(answer_valid),
      .answer_good_i(answer_good),
      .answer_length_i(answer_length),
      .body_write_o(body_write),
      .body_address_o(body_address),
      .body_data_o(body_wdata),
      .body_data_i(body_rdata),
      .event_valid_i(event_valid),
      .event_id_i(event_id),
      .event_taken_o(event_taken),
      .event_address_o(event_address),
      .event_data_i(event_data)
  );

  gridrt_board #(
      .B(B),
      .PES(PES),
      .CLOCK_HZ(CLOCK_HZ),
      .NAME(NAME),
      .HANG_CLOCKS(HANG_CLOCKS),
      .BUS_CLOCKS(BUS_CLOCKS),
      .SERIAL(SERIAL)
  ) u_board (
      .clk_i,
      .rst_ni,
      .rx_valid_i(rx_valid),
      .rx_ready_o(rx_ready),
      .rx_data_i(rx_data),
      .tx_valid_o(tx_valid),
      .tx_ready_i(tx_ready),
      .tx_data_o(tx_data),
      .request_valid_i(request_valid),
      .request_set_i(request_set),
      .request_id_i(request_id),
      .request_length_i(request_length),
      .answer_valid_o(answer_valid),
      .answer_good_o(answer_good),
      .answer_length_o(answer_length),
      .body_write_i(body_write),
      .body_address_i(body_address),
      .body_data_i(body_wdata),
      .body_data_o(body_rdata),
      .event_valid_o(event_valid),
      .event_id_o(event_id),
      .event_taken_i(event_taken),
      .event_address_i(event_address),
      .event_data_o(event_data),
      .flash_cs_no,
      .flash_clk_o,
      .flash_mosi_o,
      .flash_miso_i
  );

  logic unused;
  assign unused = &{1'b0, unused_bus_reset};
endmodule
