// Who speaks with the shell: the link, or firmware in its place (hal/protocol/protocol.toml, Feed).
// Firmware's words become bytes, the shell's answers wait for firmware. After power-up firmware
// speaks, so that it can load an image from flash before a host interferes.
module gridrt_feed (
    input  logic        clk_i,
    input  logic        rst_ni,
    input  logic        clear_i,      // the core is being reset
    input  logic        quiet_i,      // the shell has no frame, ray or answer under way
    // The link.
    input  logic        rx_valid_i,
    output logic        rx_ready_o,
    input  logic [ 7:0] rx_data_i,
    output logic        tx_valid_o,
    input  logic        tx_ready_i,
    output logic [ 7:0] tx_data_o,
    // The shell.
    output logic        rx_valid_o,
    input  logic        rx_ready_i,
    output logic [ 7:0] rx_data_o,
    input  logic        tx_valid_i,
    output logic        tx_ready_o,
    input  logic [ 7:0] tx_data_i,
    // The soft core.
    input  logic        select_i,     // one clock an access
    input  logic        write_i,
    input  logic [ 5:2] address_i,    // from Feed on
    input  logic [31:0] write_data_i,
    output logic [31:0] read_data_o   // of this clock
);
  localparam logic [31:0] BASE = 32'(gridrt_protocol_pkg::FEED_SOURCE_ADDRESS);
  localparam logic [3:0] SOURCE = 4'd0;
  localparam logic [3:0] ROOM = 4'((gridrt_protocol_pkg::FEED_ROOM_ADDRESS - BASE) >> 2);
  localparam logic [3:0] DATA = 4'((gridrt_protocol_pkg::FEED_DATA_ADDRESS - BASE) >> 2);
  localparam logic [3:0] ANSWER = 4'((gridrt_protocol_pkg::FEED_ANSWER_ADDRESS - BASE) >> 2);
  localparam int unsigned WORDS = 4;
  localparam int unsigned ANSWERS = 16;

  logic write, wanted, granted, change;
  assign write = select_i && write_i;
  // In the clock of a change no byte of the link goes through.
  assign change = wanted != granted && quiet_i;
  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      wanted  <= 1'b1;
      granted <= 1'b1;
    end else begin
      if (change) granted <= wanted;
      if (write && address_i == SOURCE) begin
        wanted <= write_data_i[gridrt_protocol_pkg::FEED_SOURCE_WANTED_BIT];
        if (write_data_i[gridrt_protocol_pkg::FEED_SOURCE_FORCED_BIT]) begin
          granted <= write_data_i[gridrt_protocol_pkg::FEED_SOURCE_WANTED_BIT];
        end
      end
    end
  end

  // Words from firmware, a byte a clock.
  logic word_valid, word_ready, room, byte_taken;
  logic [31:0] word;
  logic [2:0] words;
  logic [1:0] place;
  gridrt_fifo #(
      .WIDTH(32),
      .DEPTH(WORDS)
  ) u_words (
      .clk_i,
      .rst_ni,
      .in_valid_i(write && address_i == DATA && granted),
      .in_ready_o(room),
      .in_data_i(write_data_i),
      .out_valid_o(word_valid),
      .out_ready_i(word_ready),
      .out_data_o(word),
      .count_o(words)
  );
  assign byte_taken = granted && rx_valid_o && rx_ready_i;
  // What is left when the core is reset, or when the link's turn has come, is dropped.
  assign word_ready = (byte_taken && place == '1) || clear_i || !granted;
  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) place <= '0;
    else if (clear_i || !granted) place <= '0;
    else if (byte_taken) place <= place + 1'b1;
  end
  assign rx_valid_o = granted ? word_valid : rx_valid_i && !change;
  assign rx_data_o = granted ? word[8*place+:8] : rx_data_i;
  assign rx_ready_o = !granted && rx_ready_i && !change;

  // Answers to firmware.
  logic answer_valid, answer_ready, answer_take;
  logic [7:0] answer;
  logic [4:0] answers;
  gridrt_fifo #(
      .WIDTH(8),
      .DEPTH(ANSWERS)
  ) u_answers (
      .clk_i,
      .rst_ni,
      .in_valid_i(granted && tx_valid_i && !clear_i),
      .in_ready_o(answer_ready),
      .in_data_i(tx_data_i),
      .out_valid_o(answer_valid),
      .out_ready_i(answer_take || clear_i || !granted),
      .out_data_o(answer),
      .count_o(answers)
  );
  assign answer_take = select_i && !write_i && address_i == ANSWER;
  assign tx_valid_o = !granted && tx_valid_i;
  assign tx_data_o = tx_data_i;
  assign tx_ready_o = granted ? answer_ready : tx_ready_i;

  always_comb begin
    read_data_o = '0;
    case (address_i)
      SOURCE: begin
        read_data_o[gridrt_protocol_pkg::FEED_SOURCE_WANTED_BIT]  = wanted;
        read_data_o[gridrt_protocol_pkg::FEED_SOURCE_GRANTED_BIT] = granted;
      end
      ROOM: read_data_o[2:0] = 3'(WORDS) - words;
      ANSWER: begin
        read_data_o[gridrt_protocol_pkg::FEED_ANSWER_BYTE_BIT+:8] = answer_valid ? answer : 8'd0;
        read_data_o[gridrt_protocol_pkg::FEED_ANSWER_VALID_BIT] = answer_valid;
      end
      default: ;
    endcase
  end

  logic unused;
  assign unused = &{1'b0, room, answers};

`ifdef GRIDRT_ASSERT
  always_ff @(posedge clk_i) begin
    if (rst_ni) begin
      assert (!(write && address_i == DATA && granted && !room));
    end
  end
`endif
endmodule
