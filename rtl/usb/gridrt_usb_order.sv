// Hides packets that are out of turn from the USB device. Whoever loses a token on the cable must not
// take the data behind it for what the token before had announced, and an ACK is for the device only
// if its own packet was the last thing on the bus: on a hub the host's words to other devices are
// heard as well. LUNA looks at neither.
module gridrt_usb_order (
    input  logic       clk_i,
    input  logic       rst_ni,
    input  logic [7:0] rx_data_i,    // of the PHY; rx_valid_i: a byte within rx_active_i
    input  logic       rx_active_i,
    input  logic       rx_valid_i,
    input  logic       tx_valid_i,   // the device sends
    output logic       rx_active_o,
    output logic       rx_valid_o
);
  localparam logic [3:0] OUT = 4'b0001;
  localparam logic [3:0] SETUP = 4'b1101;
  localparam logic [3:0] PING = 4'b0100;
  localparam logic [3:0] ACK = 4'b0010;
  localparam logic [1:0] TOKEN = 2'b01;  // the lower bits of its PIDs
  localparam logic [1:0] DATA = 2'b11;
  localparam logic [4:0] RESIDUE = 5'b01100;  // of a token with a right CRC

  logic announced;  // a token came that data follow, and none did yet
  logic answered;  // the device has sent since the latest token
  logic [1:0] place;  // bytes of this packet, 3 at most
  logic longer, hidden;  // than that; this packet
  logic [3:0] pid;
  logic [4:0] crc;

  logic first, good_pid, out_of_turn;
  assign first = rx_active_i && rx_valid_i && place == '0;
  assign good_pid = rx_data_i[3:0] == ~rx_data_i[7:4];
  assign out_of_turn = (rx_data_i[1:0] == DATA && !announced) ||
                       (rx_data_i[3:0] == ACK && !answered);
  assign rx_active_o = rx_active_i && !hidden && !(first && out_of_turn);
  assign rx_valid_o = rx_valid_i && !hidden && !(first && out_of_turn);

  // CRC-5 of the two bytes behind a token's PID, the lowest bit first.
  logic [4:0] next_crc;
  always_comb begin
    next_crc = crc;
    for (int i = 0; i < 8; i++) begin
      next_crc = {next_crc[3:0], 1'b0} ^ ((next_crc[4] ^ rx_data_i[i]) ? 5'b00101 : 5'b00000);
    end
  end

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      announced <= 1'b0;
      answered <= 1'b0;
      place <= '0;
      longer <= 1'b0;
      hidden <= 1'b0;
      pid <= '0;
      crc <= '1;
    end else begin
      if (tx_valid_i) answered <= 1'b1;
      if (!rx_active_i) begin
        place  <= '0;
        hidden <= 1'b0;
        longer <= 1'b0;
        if (place == 2'd3 && !longer && (pid == OUT || pid == SETUP) && crc == RESIDUE)
          announced <= 1'b1;
      end else if (rx_valid_i) begin
        if (place != 2'd3) place <= place + 1'b1;
        else longer <= 1'b1;
        crc <= (place == '0) ? '1 : next_crc;
        if (first) begin
          pid <= good_pid ? rx_data_i[3:0] : '0;
          hidden <= out_of_turn;
          announced <= 1'b0;
          if (rx_data_i[1:0] == TOKEN || rx_data_i[3:0] == PING || rx_data_i[3:0] == ACK)
            answered <= 1'b0;
        end
      end
    end
  end
endmodule
