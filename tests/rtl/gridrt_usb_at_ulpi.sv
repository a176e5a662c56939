// The USB block with LUNA's translator before it, as rtl/board has them: from ULPI pins to the board.
module gridrt_usb_at_ulpi (
    input  logic       clk_i,
    input  logic       rst_ni,
    input  logic [7:0] ulpi_data_i,
    output logic [7:0] ulpi_data_o,
    output logic       ulpi_drive_o,
    input  logic       ulpi_dir_i,
    input  logic       ulpi_nxt_i,
    output logic       ulpi_stp_o,
    output logic       suspended_o,
    output logic [1:0] speed_o,
    output logic       rx_valid_o,
    input  logic       rx_ready_i,
    output logic [7:0] rx_data_o,
    input  logic       tx_valid_i,
    output logic       tx_ready_o,
    input  logic [7:0] tx_data_i,
    output logic       request_valid_o,
    output logic       request_set_o,
    output logic [7:0] request_id_o,
    output logic [6:0] request_length_o,
    input  logic       answer_valid_i,
    input  logic       answer_good_i,
    input  logic [6:0] answer_length_i,
    output logic       body_write_o,
    output logic [5:0] body_address_o,
    output logic [7:0] body_data_o,
    input  logic [7:0] body_data_i,
    input  logic       event_valid_i,
    input  logic [7:0] event_id_i,
    output logic       event_taken_o,
    output logic [5:0] event_address_o,
    input  logic [7:0] event_data_i
);
  logic [7:0] rx_data, tx_data, sent_data;
  logic rx_active, rx_valid, rx_error, tx_valid, tx_ready, sent_valid, sent_ready;
  logic busy, term_select, unused_bus_reset;
  logic [1:0] line_state, xcvr_select, op_mode;

  logic late_rst_n;
  gridrt_late_reset #(
      .CLOCKS(1 << 17)
  ) u_device_reset (
      .clk_i,
      .rst_ni,
      .rst_no(late_rst_n)
  );
  gridrt_ulpi u_ulpi (
      .clk_i(clk_i),
      .rst_i(!rst_ni),
      .ulpi_data_i(ulpi_data_i),
      .ulpi_data_o(ulpi_data_o),
      .ulpi_drive_o(ulpi_drive_o),
      .ulpi_dir_i(ulpi_dir_i),
      .ulpi_nxt_i(ulpi_nxt_i),
      .ulpi_stp_o(ulpi_stp_o),
      .utmi_rx_data_o(rx_data),
      .utmi_rx_active_o(rx_active),
      .utmi_rx_valid_o(rx_valid),
      .utmi_rx_error_o(rx_error),
      .utmi_tx_data_i(sent_data),
      .utmi_tx_valid_i(sent_valid),
      .utmi_tx_ready_o(sent_ready),
      .utmi_line_state_o(line_state),
      .utmi_busy_o(busy),
      .utmi_xcvr_select_i(xcvr_select),
      .utmi_term_select_i(term_select),
      .utmi_op_mode_i(op_mode)
  );
  gridrt_skid #(
      .WIDTH(8)
  ) u_sent (
      .clk_i,
      .rst_ni,
      .in_valid_i(tx_valid),
      .in_ready_o(tx_ready),
      .in_data_i(tx_data),
      .out_valid_o(sent_valid),
      .out_ready_i(sent_ready),
      .out_data_o(sent_data)
  );
  gridrt_usb u_usb (
      .rst_ni(late_rst_n),
      .utmi_rx_data_i(rx_data),
      .utmi_rx_active_i(rx_active),
      .utmi_rx_valid_i(rx_valid),
      .utmi_rx_error_i(rx_error),
      .utmi_tx_data_o(tx_data),
      .utmi_tx_valid_o(tx_valid),
      .utmi_tx_ready_i(tx_ready),
      .utmi_line_state_i(line_state),
      .utmi_busy_i(busy),
      .utmi_xcvr_select_o(xcvr_select),
      .utmi_term_select_o(term_select),
      .utmi_op_mode_o(op_mode),
      .bus_reset_o(unused_bus_reset),
      .*
  );

  logic unused;
  assign unused = &{1'b0, unused_bus_reset};
endmodule
