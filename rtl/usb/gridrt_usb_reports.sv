// HID's class requests (HID 1.11, 7.2) and the two interrupt endpoints, at the board's mailbox. LUNA
// (rtl/usb/make_luna.py) does packets, standard requests and descriptors; what it asks comes as
// pulses: data_requested and status_requested, one clock each, are answered with a packet, NAK or
// STALL. Until firmware has answered, that is NAK. Reports are 64 bytes, the id first.
module gridrt_usb_reports (
    input  logic        clk_i,
    input  logic        rst_ni,
    input  logic        bus_reset_i,
    input  logic        configured_i,
    // Endpoint 0.
    input  logic        setup_i,  // a new request
    input  logic [ 1:0] kind_i,  // standard, class, vendor
    input  logic        is_in_i,
    input  logic [ 7:0] request_i,
    input  logic [15:0] value_i,
    input  logic [15:0] index_i,
    input  logic [15:0] length_i,
    input  logic        data_requested_i,
    input  logic        status_requested_i,
    input  logic        rx_valid_i,  // a packet is coming in
    input  logic        rx_next_i,  // a byte of it
    input  logic [ 7:0] rx_data_i,
    input  logic        rx_ready_for_response_i,
    input  logic        rx_invalid_i,
    input  logic        acked_i,
    input  logic        tx_ready_i,
    output logic        tx_valid_o,
    output logic        tx_first_o,
    output logic        tx_last_o,
    output logic [ 7:0] tx_data_o,
    output logic        tx_pid_o,
    output logic        ack_o,
    output logic        nak_o,
    output logic        stall_o,
    // Interrupt endpoints.
    input  logic        out_valid_i,
    output logic        out_ready_o,
    input  logic [ 7:0] out_data_i,
    input  logic        out_last_i,
    output logic        in_valid_o,
    input  logic        in_ready_i,
    output logic [ 7:0] in_data_o,
    // The board's mailbox.
    output logic        request_valid_o,
    output logic        request_set_o,
    output logic [ 7:0] request_id_o,
    output logic [ 6:0] request_length_o,
    input  logic        answer_valid_i,
    input  logic        answer_good_i,
    input  logic [ 6:0] answer_length_i,
    output logic        body_write_o,
    output logic [ 5:0] body_address_o,
    output logic [ 7:0] body_data_o,
    input  logic [ 7:0] body_data_i,
    input  logic        event_valid_i,
    input  logic [ 7:0] event_id_i,
    output logic        event_taken_o,
    output logic [ 5:0] event_address_o,
    input  logic [ 7:0] event_data_i
);
  localparam logic [1:0] CLASS = 2'd1;
  localparam logic [7:0] GET_REPORT = 8'h01;
  localparam logic [7:0] SET_REPORT = 8'h09;
  localparam logic [7:0] SET_IDLE = 8'h0A;
  localparam logic [6:0] BYTES = 7'(gridrt_protocol_pkg::REPORT_BYTES);
  localparam logic [7:0] INTERFACE = 8'(gridrt_usb_pkg::USB_HID_INTERFACE);

  typedef enum logic [3:0] {
    IDLE,     // no request of ours
    ASK,      // a report is to be got
    REPLY,    // and can be sent
    SEND,
    SENT,     // not acknowledged yet
    DONE,     // acknowledged
    CLOSED,   // status was acknowledged; it may be asked for again
    DATA,     // a report is to be set
    PUT,      // it has come
    GOOD,     // status: an empty packet
    REFUSE
  } state_e;
  state_e state;

  logic ours, get, set, idle, mailbox_free, out_busy, wrong, refused;
  logic [6:0] place, total, got;
  logic [7:0] id;
  assign ours = kind_i == CLASS && index_i[7:0] == INTERFACE;
  assign get = ours && is_in_i && request_i == GET_REPORT && length_i != '0;
  assign set = ours && !is_in_i && request_i == SET_REPORT && length_i >= 16'd2 &&
               length_i <= 16'(BYTES);
  assign idle = ours && !is_in_i && request_i == SET_IDLE && length_i == '0;

  // A packet of a report that is set: its bytes go to the mailbox at once, unless it is in use.
  logic in_packet, refuse_packet, take_byte, ends_well, came, again;
  // With its first byte refuse_packet is still that of the packet before.
  assign take_byte = state == DATA && rx_valid_i && rx_next_i && !(refuse_packet && in_packet) &&
                     !out_busy && place != BYTES;
  // The host has not heard that its packet was taken.
  assign again = came && state != DATA && rx_ready_for_response_i;
  assign ends_well = state == DATA && rx_ready_for_response_i && !wrong && !rx_invalid_i;

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      state <= IDLE;
      place <= '0;
      total <= '0;
      got <= '0;
      id <= '0;
      tx_pid_o <= 1'b1;
      in_packet <= 1'b0;
      refuse_packet <= 1'b0;
      wrong <= 1'b0;
      came <= 1'b0;
    end else begin
      in_packet <= rx_valid_i;
      // A packet that comes while the mailbox is in use is refused as a whole.
      if (rx_valid_i && !in_packet) begin
        refuse_packet <= out_busy;
        wrong <= 1'b0;
      end else if (rx_valid_i && out_busy) begin
        refuse_packet <= 1'b1;
      end
      if (rx_invalid_i) wrong <= 1'b1;
      case (state)
        ASK: begin
          if (answer_valid_i && !out_busy) begin
            got   <= answer_length_i;
            state <= answer_good_i ? REPLY : REFUSE;
          end
        end
        REPLY: begin
          place <= '0;
          if (data_requested_i) state <= SEND;
          if (status_requested_i) state <= CLOSED;
        end
        SEND: begin
          if (tx_ready_i) begin
            place <= place + 1'b1;
            if (tx_last_o) state <= SENT;
          end
        end
        SENT: begin
          place <= '0;
          if (acked_i) begin
            tx_pid_o <= !tx_pid_o;
            state <= DONE;
          end else if (data_requested_i) begin
            state <= SEND;
          end
          if (status_requested_i) state <= CLOSED;
        end
        DONE: if (status_requested_i) state <= CLOSED;
        DATA: begin
          if (take_byte) begin
            if (place == '0) id <= rx_data_i;
            place <= place + 1'b1;
          end
          if (ends_well && !refuse_packet) begin
            state <= (place < 7'd2) ? REFUSE : PUT;
            came  <= 1'b1;
          end
          if (rx_invalid_i) place <= '0;  // the packet comes again
          if (status_requested_i) state <= REFUSE;
        end
        PUT: begin
          if (answer_valid_i && !out_busy) state <= answer_good_i ? GOOD : REFUSE;
        end
        default: ;
      endcase
      if (setup_i) begin
        tx_pid_o <= 1'b1;
        refuse_packet <= 1'b0;
        wrong <= 1'b0;
        place <= '0;
        came <= 1'b0;
        total <= (length_i < 16'(BYTES)) ? length_i[6:0] : BYTES;
        if (kind_i != CLASS) state <= IDLE;
        else if (get) state <= ASK;
        else if (set) state <= DATA;
        else if (idle) state <= GOOD;
        else state <= REFUSE;
        if (get) id <= value_i[7:0];
      end
      if (bus_reset_i) state <= IDLE;
    end
  end

  assign refused = state == REFUSE && (data_requested_i || status_requested_i ||
                                       (rx_ready_for_response_i && !came));
  assign stall_o = refused;
  assign nak_o = ((state == ASK) && data_requested_i) || ((state == PUT) && status_requested_i) ||
                 (ends_well && refuse_packet);
  assign ack_o = (ends_well && !refuse_packet) || again ||
                 (status_requested_i &&
                  (state == REPLY || state == SENT || state == DONE || state == CLOSED));
  // A packet is empty if it has a last byte and no first one, for one clock.
  logic empty;
  assign empty = (state == GOOD && status_requested_i) || (state == DONE && data_requested_i);
  assign tx_valid_o = state == SEND || empty;
  assign tx_first_o = state == SEND && place == '0;
  assign tx_last_o = empty || (state == SEND && place == total - 1'b1);
  always_comb begin
    tx_data_o = '0;
    if (place == '0) tx_data_o = id;
    else if (place <= got) tx_data_o = body_data_i;
  end

  // Output reports: a packet of up to 64 bytes. They have the mailbox to themselves from their
  // first byte to firmware's answer.
  typedef enum logic [1:0] {
    OUT_IDLE,
    OUT_BYTES,
    OUT_ASK
  } out_e;
  out_e out;
  logic [6:0] out_place;
  logic [7:0] out_id;
  logic out_take;
  assign mailbox_free = state == IDLE || state == REFUSE || state == GOOD || state == DONE ||
                        state == CLOSED;
  assign out_busy = out != OUT_IDLE;
  assign out_ready_o = out == OUT_BYTES || (out == OUT_IDLE && mailbox_free && !setup_i);
  assign out_take = out_valid_i && out_ready_o;
  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      out <= OUT_IDLE;
      out_place <= '0;
      out_id <= '0;
    end else begin
      if (out_take) begin
        if (out_place == '0) out_id <= out_data_i;
        out_place <= out_place + 1'b1;
        out <= (out_last_i || out_place == BYTES - 1'b1) ? OUT_ASK : OUT_BYTES;
      end
      if (out == OUT_ASK && answer_valid_i) begin
        out <= OUT_IDLE;
        out_place <= '0;
      end
      if (bus_reset_i) begin
        out <= OUT_IDLE;
        out_place <= '0;
      end
    end
  end

  // A request that follows another at once is another to the mailbox, too: its tag changes with the
  // gap, or firmware's answer to the first would be taken for one to the second.
  assign request_valid_o = (out == OUT_ASK) ||
                           ((state == ASK || state == PUT) && !out_busy && !setup_i);
  assign request_set_o = (out == OUT_ASK) || state == PUT;
  assign request_id_o = (out == OUT_ASK) ? out_id : id;
  assign request_length_o = (out == OUT_ASK) ? out_place - 1'b1 : place - 1'b1;
  assign body_write_o = (out_take && out_place != '0) || (take_byte && place != '0);
  assign body_address_o = 6'((out_busy ? out_place : place) - 7'd1);
  assign body_data_o = out_busy ? out_data_i : rx_data_i;

  // Input reports. One that went to the endpoint before a configuration is chosen would be lost.
  logic [6:0] in_place;
  assign in_valid_o = event_valid_i && configured_i;
  assign in_data_o = (in_place == '0) ? event_id_i : event_data_i;
  assign event_address_o = 6'(in_place - 7'd1);
  assign event_taken_o = in_valid_o && in_ready_i && in_place == BYTES - 1'b1;
  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) in_place <= '0;
    else if (bus_reset_i) in_place <= '0;
    else if (in_valid_o && in_ready_i) in_place <= event_taken_o ? '0 : in_place + 1'b1;
  end

  logic unused;
  assign unused = &{1'b0, value_i[15:8], index_i[15:8]};
endmodule
