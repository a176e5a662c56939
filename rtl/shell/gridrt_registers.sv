// The report windows on the register bus of the soft core, or of what serves reports in its place:
// hal/protocol/protocol.toml, [registers]. A request stays until ready; a Reset is ready when it is
// done. What is not there reads as 0.
module gridrt_registers #(
    parameter int unsigned B = 17,
    parameter int unsigned PES = 4,
    parameter int unsigned BLOCKS = 4096,
    parameter int unsigned CELLS = 6144,
    parameter int unsigned REFS = 8192,
    parameter int unsigned TRIS = 4096,
    parameter int unsigned VERTS = 2560,
    parameter int unsigned MAX_PAYLOAD = 16384,
    parameter int unsigned CLOCK_HZ = 60000000,
    parameter logic [63:0] NAME = 64'h6D6973,  // ASCII, the first letter lowest: "sim"
    parameter int unsigned LOG_W = 10  // bits of the log's count
) (
    input  logic                               clk_i,
    input  logic                               rst_ni,
    input  logic                               reg_valid_i,
    input  logic                               reg_write_i,
    input  logic                       [ 11:0] reg_address_i,
    input  logic                       [ 31:0] reg_write_data_i,
    output logic                               reg_ready_o,
    output logic                       [ 31:0] reg_read_data_o,
    output logic                               reset_o,  // a pulse: back to Empty
    input  logic                               reset_done_i,
    input  logic                       [  7:0] state_i,
    input  gridrt_shell_pkg::refusal_t         error_i,  // the last one
    input  logic                       [ 31:0] bad_frames_i,
    output logic                       [  3:0] total_select_o,
    input  logic                       [ 47:0] total_i,
    output logic                       [ 31:0] idle_clocks_o,
    output logic                               log_begin_o,
    output logic                               log_stop_o,
    input  logic                               log_on_i,
    input  logic                       [LOG_W-1:0] log_count_i,
    input  logic                               log_overflow_i,
    input  logic                       [ 31:0] log_word_i,
    output logic                               log_take_o
);
  localparam logic [5:0] WINDOW_IDENTITY = 6'(gridrt_protocol_pkg::REGISTERS_IDENTITY_BASE >> 6);
  localparam logic [5:0] WINDOW_CAPABILITIES =
      6'(gridrt_protocol_pkg::REGISTERS_CAPABILITIES_BASE >> 6);
  localparam logic [5:0] WINDOW_STATUS = 6'(gridrt_protocol_pkg::REGISTERS_STATUS_BASE >> 6);
  localparam logic [5:0] WINDOW_COUNTERS = 6'(gridrt_protocol_pkg::REGISTERS_COUNTERS_BASE >> 6);
  localparam logic [5:0] WINDOW_RESET = 6'(gridrt_protocol_pkg::REGISTERS_RESET_BASE >> 6);
  localparam logic [5:0] WINDOW_LOG = 6'(gridrt_protocol_pkg::REGISTERS_LOG_BASE >> 6);
  localparam logic [5:0] WINDOW_CONTROL = 6'(gridrt_protocol_pkg::REGISTERS_CONTROL_BASE >> 6);
  localparam logic [5:0] WINDOW_STALLS = 6'(gridrt_protocol_pkg::REGISTERS_STALLS_BASE >> 6);
  localparam logic [3:0] LOG_WORDS = 4'(gridrt_protocol_pkg::REGISTERS_LOG_WORDS - 1);

  logic [5:0] window;
  logic [3:0] word;
  logic ready, waiting, first, write;
  logic [31:0] data, read_data, idle_clocks;
  logic [15:0] high;  // of the total whose low word was read last
  logic [3:0] log_left;  // words of the log that the report at hand still has
  logic [3:0] log_now;

  assign window = reg_address_i[11:6];
  assign word = reg_address_i[5:2];
  assign first = reg_valid_i && !ready && !waiting;
  assign write = first && reg_write_i;

  assign total_select_o = {1'b0, word[3:1]} + ((window == WINDOW_STALLS) ? 4'd7 : 4'd0);
  assign log_now = (log_count_i > LOG_W'(LOG_WORDS)) ? LOG_WORDS : 4'(log_count_i);
  assign log_take_o = first && !reg_write_i && window == WINDOW_LOG && word != '0 &&
                      log_left != '0;
  always_comb begin
    data = '0;
    case (window)
      WINDOW_IDENTITY: begin
        if (word == 4'd0) data = 32'(gridrt_protocol_pkg::VERSION);
        if (word == 4'd1) data = NAME[31:0];
        if (word == 4'd2) data = NAME[63:32];
      end
      WINDOW_CAPABILITIES: begin
        case (word)
          4'd0: data = {8'd0, 8'(PES), 8'(B), 8'd1 << gridrt_protocol_pkg::LAYOUT_COMPACT};
          4'd1: data = 32'(MAX_PAYLOAD);
          4'd2: data = 32'(CLOCK_HZ);
          4'd3: data = 32'(TRIS);
          4'd4: data = 32'(VERTS);
          4'd5: data = 32'(REFS);
          4'd6: data = 32'(CELLS);
          4'd7: data = 32'(BLOCKS);
          default: data = '0;
        endcase
      end
      WINDOW_STATUS: begin
        case (word)
          4'd0: data = {error_i.code, 8'd0, state_i};
          4'd1: data = error_i.detail;
          4'd2: data = bad_frames_i;
          default: data = '0;
        endcase
      end
      WINDOW_COUNTERS, WINDOW_STALLS: begin
        if (word < 4'd14) data = word[0] ? {16'd0, high} : total_i[31:0];
      end
      WINDOW_LOG: begin
        if (word == '0) data = {16'd0, 7'd0, log_overflow_i, 4'd0, log_now};
        else if (log_take_o) data = log_word_i;
      end
      WINDOW_CONTROL: begin
        if (word == 4'd0) data = idle_clocks;
        if (word == 4'd1) data = {31'd0, log_on_i};
      end
      default: data = '0;
    endcase
  end

  assign reset_o = write && window == WINDOW_RESET && word == '0 &&
                   reg_write_data_i == 32'(gridrt_protocol_pkg::RESET_KEY);
  assign log_begin_o = write && window == WINDOW_CONTROL && word == 4'd1 && reg_write_data_i[0];
  assign log_stop_o = write && window == WINDOW_CONTROL && word == 4'd1 && !reg_write_data_i[0];

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      ready <= 1'b0;
      waiting <= 1'b0;
      idle_clocks <= 32'(CLOCK_HZ / 16);
      log_left <= '0;
      high <= '0;
    end else begin
      ready <= (first && !reset_o) || (waiting && reset_done_i);
      if (reset_o) waiting <= 1'b1;
      else if (reset_done_i) waiting <= 1'b0;
      if (write && window == WINDOW_CONTROL && word == 4'd0) begin
        idle_clocks <= (reg_write_data_i == '0) ? 32'd1 : reg_write_data_i;
      end
      if (first && !reg_write_i) begin
        if ((window == WINDOW_COUNTERS || window == WINDOW_STALLS) && !word[0]) begin
          high <= total_i[47:32];
        end
        if (window == WINDOW_LOG) begin
          if (word == '0) log_left <= log_now;
          else if (log_take_o) log_left <= log_left - 1'b1;
        end
      end
      if (log_begin_o) log_left <= '0;
    end
  end
  always_ff @(posedge clk_i) if (first) read_data <= data;

  assign reg_ready_o = ready;
  assign reg_read_data_o = read_data;
  assign idle_clocks_o = idle_clocks;

  if (CLOCK_HZ < 16 || LOG_W < 4) begin : gen_illegal
    $error("gridrt_registers: CLOCK_HZ or LOG_W is too small");
  end
  logic unused;
  assign unused = &{1'b0, reg_address_i[1:0]};
endmodule
