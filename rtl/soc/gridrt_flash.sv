// Reads a serial flash (command 03, 24-bit addresses, mode 0) word by word at half the clock
// (hal/protocol/protocol.toml, Flash). Writing the address starts a read; the word behind the one
// that is taken is fetched at once. The flash stays selected until the next address.
module gridrt_flash (
    input  logic        clk_i,
    input  logic        rst_ni,
    output logic        flash_cs_no,
    output logic        flash_clk_o,
    output logic        flash_mosi_o,
    input  logic        flash_miso_i,
    input  logic        select_i,      // one clock an access
    input  logic        write_i,
    input  logic [ 5:2] address_i,     // from Flash on
    input  logic [31:0] write_data_i,
    output logic [31:0] read_data_o    // of this clock
);
  localparam logic [31:0] BASE = 32'(gridrt_protocol_pkg::FLASH_ADDRESS_ADDRESS);
  localparam logic [3:0] ADDRESS = 4'd0;
  localparam logic [3:0] STATUS = 4'((gridrt_protocol_pkg::FLASH_STATUS_ADDRESS - BASE) >> 2);
  localparam logic [3:0] DATA = 4'((gridrt_protocol_pkg::FLASH_DATA_ADDRESS - BASE) >> 2);
  localparam logic [7:0] READ = 8'h03;

  typedef enum logic [2:0] {
    IDLE,
    RELEASE,
    SEND,
    FETCH,
    FULL
  } state_e;
  state_e state;

  logic high;  // the serial clock
  logic [4:0] bits;  // done of a word
  logic [31:0] shift;
  logic begins, takes;

  assign begins = select_i && write_i && address_i == ADDRESS;
  assign takes = select_i && !write_i && address_i == DATA && state == FULL;
  assign flash_clk_o = high;
  assign flash_mosi_o = shift[31];

  // The serial clock rises in the middle of a bit, where both sides take it, and falls at its end,
  // where both put out the next one.
  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      state <= IDLE;
      high <= 1'b0;
      bits <= '0;
      flash_cs_no <= 1'b1;
    end else if (begins) begin
      state <= RELEASE;
      high <= 1'b0;
      bits <= '0;
      flash_cs_no <= 1'b1;
    end else begin
      case (state)
        RELEASE: begin  // some clocks between two commands
          bits <= bits + 1'b1;
          if (bits == 5'd7) begin
            state <= SEND;
            bits <= '0;
            flash_cs_no <= 1'b0;
          end
        end
        SEND, FETCH: begin
          high <= !high;
          if (high) begin
            bits <= bits + 1'b1;
            if (bits == '1) state <= (state == SEND) ? FETCH : FULL;
          end
        end
        FULL: if (takes) state <= FETCH;
        default: ;
      endcase
    end
  end
  logic sample;
  always_ff @(posedge clk_i) begin
    if (begins) shift <= {READ, write_data_i[23:0]};
    else if ((state == SEND || state == FETCH) && high) shift <= {shift[30:0], sample};
    if (!high) sample <= flash_miso_i;
  end

  always_comb begin
    read_data_o = '0;
    if (address_i == STATUS) begin
      read_data_o[gridrt_protocol_pkg::FLASH_STATUS_READY_BIT] = state == FULL;
    end
    // The first byte came first, its highest bit first.
    if (address_i == DATA) read_data_o = {shift[7:0], shift[15:8], shift[23:16], shift[31:24]};
  end

  logic unused;
  assign unused = &{1'b0, write_data_i[31:24]};
endmodule
