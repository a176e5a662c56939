// Control reports between the USB side and firmware (hal/protocol/protocol.toml, Mailbox,
// MailboxBody, EventBody).
//
// The USB side writes the body of a report that is set, byte by byte, then holds request_valid_i
// with what it asks for until answer_valid_o; if it was good, a body that was asked for can be read.
// It may give up at any time: the request's tag changes, so that a late answer counts for nothing.
// Bodies come without the report's id. Input reports wait until event_taken_i.
module gridrt_mailbox (
    input  logic        clk_i,
    input  logic        rst_ni,
    // The USB side.
    input  logic        request_valid_i,
    input  logic        request_set_i,
    input  logic [ 7:0] request_id_i,
    input  logic [ 6:0] request_length_i,  // of a body that is set
    output logic        answer_valid_o,    // one clock
    output logic        answer_good_o,
    output logic [ 6:0] answer_length_o,
    input  logic        body_write_i,      // not while request_valid_i
    input  logic [ 5:0] body_address_i,
    input  logic [ 7:0] body_data_i,
    output logic [ 7:0] body_data_o,       // at body_address_i, in the same clock
    output logic        event_valid_o,
    output logic [ 7:0] event_id_o,
    input  logic        event_taken_i,
    input  logic [ 5:0] event_address_i,
    output logic [ 7:0] event_data_o,
    // The soft core.
    input  logic        select_i,          // one clock an access
    input  logic        write_i,
    input  logic [ 7:2] address_i,         // from Mailbox on
    input  logic [31:0] write_data_i,
    output logic [31:0] read_data_o        // of this clock
);
  localparam logic [31:0] BASE = 32'(gridrt_protocol_pkg::MAILBOX_REQUEST_ADDRESS);
  localparam logic [5:0] REQUEST = 6'd0;
  localparam logic [5:0] ANSWER =
      6'((gridrt_protocol_pkg::MAILBOX_ANSWER_ADDRESS - BASE) >> 2);
  localparam logic [5:0] EVENT = 6'((gridrt_protocol_pkg::MAILBOX_EVENT_ADDRESS - BASE) >> 2);
  localparam logic [1:0] BODY =
      2'((gridrt_protocol_pkg::MAILBOX_BODY_WORDS_ADDRESS - BASE) >> 6);
  localparam logic [1:0] EVENT_BODY =
      2'((gridrt_protocol_pkg::EVENT_BODY_WORDS_ADDRESS - BASE) >> 6);

  logic write, asked, event_busy, answers;
  logic [6:0] tag;
  logic [7:0] event_id;
  logic [31:0] body, event_body;

  assign write = select_i && write_i;
  assign answers = write && address_i == ANSWER && asked && request_valid_i &&
                   write_data_i[gridrt_protocol_pkg::MAILBOX_ANSWER_TAG_BIT+:7] == tag;
  assign answer_valid_o = answers;
  assign answer_good_o = write_data_i[gridrt_protocol_pkg::MAILBOX_ANSWER_GOOD_BIT];
  assign answer_length_o = write_data_i[gridrt_protocol_pkg::MAILBOX_ANSWER_LENGTH_BIT+:7];
  assign event_valid_o = event_busy;
  assign event_id_o = event_id;

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      asked <= 1'b0;
      tag <= '0;
      event_busy <= 1'b0;
      event_id <= '0;
    end else begin
      // A request that has been answered, or that is gone, makes room for one with another tag.
      asked <= request_valid_i && !answers;
      if (asked && (!request_valid_i || answers)) tag <= tag + 1'b1;
      if (write && address_i == EVENT) begin
        event_busy <= 1'b1;
        event_id <= write_data_i[gridrt_protocol_pkg::MAILBOX_EVENT_ID_BIT+:8];
      end else if (event_taken_i) begin
        event_busy <= 1'b0;
      end
    end
  end

  // While there is a request the body is firmware's, else the USB side's.
  logic [3:0] lanes;
  logic [3:0] body_word;
  logic [31:0] body_in;
  assign body_word = asked ? address_i[5:2] : body_address_i[5:2];
  assign body_in = asked ? write_data_i : {4{body_data_i}};
  for (genvar i = 0; i < 4; i++) begin : gen_lane
    assign lanes[i] = asked ? write && address_i[7:6] == BODY :
                              body_write_i && body_address_i[1:0] == 2'(i);
    gridrt_lutram #(
        .WIDTH(8),
        .DEPTH(16)
    ) u_body (
        .clk_i,
        .write_i(lanes[i]),
        .write_address_i(body_word),
        .write_data_i(body_in[8*i+:8]),
        .read_address_i(body_word),
        .read_data_o(body[8*i+:8])
    );
  end
  assign body_data_o = body[8*body_address_i[1:0]+:8];

  gridrt_lutram #(
      .WIDTH(32),
      .DEPTH(16)
  ) u_event (
      .clk_i,
      .write_i(write && address_i[7:6] == EVENT_BODY),
      .write_address_i(address_i[5:2]),
      .write_data_i,
      .read_address_i(event_address_i[5:2]),
      .read_data_o(event_body)
  );
  assign event_data_o = event_body[8*event_address_i[1:0]+:8];

  always_comb begin
    read_data_o = '0;
    if (address_i == REQUEST) begin
      read_data_o[gridrt_protocol_pkg::MAILBOX_REQUEST_VALID_BIT] = asked;
      read_data_o[gridrt_protocol_pkg::MAILBOX_REQUEST_ID_BIT+:8] = request_id_i;
      read_data_o[gridrt_protocol_pkg::MAILBOX_REQUEST_KIND_BIT] = request_set_i;
      read_data_o[gridrt_protocol_pkg::MAILBOX_REQUEST_LENGTH_BIT+:7] = request_length_i;
      read_data_o[gridrt_protocol_pkg::MAILBOX_REQUEST_TAG_BIT+:7] = tag;
    end else if (address_i == EVENT) begin
      read_data_o[gridrt_protocol_pkg::MAILBOX_EVENT_BUSY_BIT] = event_busy;
    end else if (address_i[7:6] == BODY) begin
      read_data_o = body;
    end
  end

`ifdef GRIDRT_ASSERT
  // What is asked stays until it is answered or given up.
  logic [7:0] asked_id;
  logic asked_set;
  always_ff @(posedge clk_i) begin
    asked_id  <= request_id_i;
    asked_set <= request_set_i;
    if (rst_ni) begin
      assert (!(body_write_i && request_valid_i));
      assert (!(asked && request_valid_i) ||
              (request_id_i == asked_id && request_set_i == asked_set));
    end
  end
`endif
endmodule
