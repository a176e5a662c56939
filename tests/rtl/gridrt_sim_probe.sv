// A board for the tests of its link: says the bytes again that it hears. Byte 0xFF: takes no more;
// 0xFE: goes on taking and says nothing more; writing a Reset ends both. A report's body is the
// bytes heard (two bytes), the length that came with the latest write, that write's first byte, then
// the id plus the place. Report 200 is never answered; ids 1 to 15 can be read, but for Reset, and
// Reset (with the first byte of its key) and Control (8 bytes) written.
module gridrt_sim_probe (
    input  logic        clk_i,
    input  logic        rst_ni,
    input  logic        rx_valid_i,
    output logic        rx_ready_o,
    input  logic [ 7:0] rx_data_i,
    output logic        tx_valid_o,
    input  logic        tx_ready_i,
    output logic [ 7:0] tx_data_o,
    input  logic        request_valid_i,
    input  logic        request_set_i,
    input  logic [ 7:0] request_id_i,
    input  logic [ 6:0] request_length_i,
    output logic        answer_valid_o,
    output logic        answer_good_o,
    output logic [ 6:0] answer_length_o,
    input  logic        body_write_i,
    input  logic [ 5:0] body_address_i,
    input  logic [ 7:0] body_data_i,
    output logic [ 7:0] body_data_o,
    output logic        event_valid_o,
    output logic [ 7:0] event_id_o,
    input  logic        event_taken_i,
    input  logic [ 5:0] event_address_i,
    output logic [ 7:0] event_data_o,
    output logic        flash_cs_no,
    output logic        flash_clk_o,
    output logic        flash_mosi_o,
    input  logic        flash_miso_i
);
  localparam logic [7:0] RESET = 8'(gridrt_protocol_pkg::RESET_REPORT_ID);
  localparam logic [7:0] CONTROL = 8'(gridrt_protocol_pkg::CONTROL_REPORT_ID);

  logic deaf, mute, input_waits;
  logic fifo_ready, push, good;
  logic [15:0] heard;
  logic [3:0] wait_count;
  logic [4:0] unused_count;
  logic [7:0] first, id;
  logic [6:0] length;

  // Whoever offers a byte waits until it is taken, or for a Reset.
  gridrt_stream_check #(
      .WIDTH(8)
  ) u_rx_check (
      .clk_i,
      .rst_ni(rst_ni && !deaf),
      .valid_i(rx_valid_i),
      .ready_i(rx_ready_o),
      .data_i(rx_data_i)
  );

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

  always_comb begin
    good = request_id_i != '0 && request_id_i < 8'd16 && request_id_i != RESET;
    if (request_set_i) begin
      good = (request_id_i == RESET && first == gridrt_protocol_pkg::RESET_KEY[7:0]) ||
             (request_id_i == CONTROL && request_length_i >= 7'd8);
    end
    case (body_address_i)
      6'd0: body_data_o = heard[7:0];
      6'd1: body_data_o = heard[15:8];
      6'd2: body_data_o = {1'b0, length};
      6'd3: body_data_o = first;
      default: body_data_o = id + {2'd0, body_address_i};
    endcase
  end
  assign answer_valid_o = request_valid_i && wait_count == '1 && request_id_i != 8'd200;
  assign answer_good_o = good;
  assign answer_length_o = 7'd40;
  assign event_valid_o = input_waits;
  assign event_id_o = 8'd32;
  assign event_data_o = 8'd100 + {2'd0, event_address_i};
  assign flash_cs_no = 1'b1;
  assign flash_clk_o = 1'b0;
  assign flash_mosi_o = 1'b0;

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      deaf <= 1'b0;
      mute <= 1'b0;
      input_waits <= 1'b1;
      heard <= '0;
      wait_count <= '0;
      first <= '0;
      id <= '0;
      length <= '0;
    end else begin
      wait_count <= (request_valid_i && !answer_valid_o) ? wait_count + 1'b1 : '0;
      if (body_write_i && body_address_i == '0) first <= body_data_i;
      if (event_taken_i) input_waits <= 1'b0;
      if (push) begin
        heard <= heard + 16'd1;
        if (rx_data_i == 8'hFF) deaf <= 1'b1;
        if (rx_data_i == 8'hFE) mute <= 1'b1;
      end
      if (answer_valid_o) id <= request_id_i;
      if (answer_valid_o && request_set_i) length <= request_length_i;
      if (answer_valid_o && request_set_i && request_id_i == RESET && good) begin
        deaf <= 1'b0;
        mute <= 1'b0;
      end
    end
  end

  logic unused;
  assign unused = &{1'b0, flash_miso_i, unused_count};
endmodule
