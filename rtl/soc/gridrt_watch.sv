// Who watches whom (hal/protocol/protocol.toml, Watch): firmware the engine, this block firmware.
module gridrt_watch #(
    parameter int unsigned HANG_CLOCKS = 1 << 20,  // rays without an answer
    parameter int unsigned ALIVE_CLOCKS = 1 << 23,  // firmware without a sign of life
    parameter logic [127:0] SERIAL = '0  // ASCII, the first letter lowest
) (
    input  logic        clk_i,
    input  logic        rst_ni,
    // The core.
    input  logic        busy_i,         // the engine has rays
    input  logic        answered_i,     // one of them has been answered
    input  logic        blocked_i,      // the host takes no bytes
    input  logic        image_i,        // an image is ready
    output logic        core_rst_no,
    // The soft core.
    input  logic        trap_i,         // it cannot go on
    input  logic        bus_timeout_i,
    input  logic [11:0] bus_address_i,
    input  logic        wake_i,         // there is something to do
    output logic        cpu_rst_no,
    input  logic        select_i,       // stays until ready
    input  logic        write_i,
    input  logic [ 5:2] address_i,      // from Watch on
    input  logic [31:0] write_data_i,
    output logic        ready_o,        // late for sleep only
    output logic [31:0] read_data_o     // of this clock
);
  localparam logic [31:0] BASE = 32'(gridrt_protocol_pkg::WATCH_STUCK_ADDRESS);
  localparam logic [3:0] STUCK = 4'd0;
  localparam logic [3:0] LIMIT = 4'((gridrt_protocol_pkg::WATCH_LIMIT_ADDRESS - BASE) >> 2);
  localparam logic [3:0] IMAGE = 4'((gridrt_protocol_pkg::WATCH_IMAGE_ADDRESS - BASE) >> 2);
  localparam logic [3:0] RESET = 4'((gridrt_protocol_pkg::WATCH_RESET_ADDRESS - BASE) >> 2);
  localparam logic [3:0] ALIVE = 4'((gridrt_protocol_pkg::WATCH_ALIVE_ADDRESS - BASE) >> 2);
  localparam logic [3:0] CAUSE = 4'((gridrt_protocol_pkg::WATCH_CAUSE_ADDRESS - BASE) >> 2);
  localparam logic [3:0] BUS = 4'((gridrt_protocol_pkg::WATCH_BUS_ADDRESS - BASE) >> 2);
  localparam logic [3:0] CLOCKS = 4'((gridrt_protocol_pkg::WATCH_CLOCKS_ADDRESS - BASE) >> 2);
  localparam logic [3:0] SLEEP = 4'((gridrt_protocol_pkg::WATCH_SLEEP_ADDRESS - BASE) >> 2);
  localparam logic [3:0] REPORTS = 4'((gridrt_protocol_pkg::WATCH_REPORTS_ADDRESS - BASE) >> 2);
  localparam logic [3:0] SERIAL_0 = 4'((gridrt_protocol_pkg::WATCH_SERIAL_ADDRESS - BASE) >> 2);
  localparam int unsigned HANG_W = $clog2(HANG_CLOCKS + 1);
  localparam int unsigned ALIVE_W = $clog2(ALIVE_CLOCKS + 1);
  // Windows of the shell, by report: ids 1 to 8.
  localparam logic [31:0] WINDOWS = 32'h0000_01FE;

  logic write, hung, image_lost, resetting, awake;
  logic [HANG_W-1:0] stuck;
  logic [ALIVE_W-1:0] silent;
  logic [4:0] core_reset, cpu_reset;  // clocks that are left of them
  logic [1:0] cause, serial_word;
  logic [12:0] bus;
  logic [31:0] clocks, slept;

  assign serial_word = 2'(address_i - SERIAL_0);
  assign hung = stuck == HANG_W'(HANG_CLOCKS);
  assign awake = wake_i || hung || slept >= write_data_i;
  assign ready_o = !(write_i && address_i == SLEEP) || awake;
  assign write = select_i && write_i && ready_o;
  assign resetting = write && address_i == RESET &&
                     write_data_i == 32'(gridrt_protocol_pkg::CORE_RESET_KEY);

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      stuck <= '0;
      silent <= '0;
      image_lost <= 1'b1;
      core_reset <= '1;
      core_rst_no <= 1'b0;
      cpu_reset <= '1;
      cpu_rst_no <= 1'b0;
      cause <= gridrt_protocol_pkg::START_CAUSE_POWER_UP[1:0];
      bus <= '0;
      clocks <= '0;
      slept <= '0;
    end else begin
      clocks <= clocks + 1'b1;
      slept <= (select_i && write_i && address_i == SLEEP && !ready_o) ? slept + 1'b1 : '0;

      if (answered_i || !busy_i || resetting) stuck <= '0;
      else if (!blocked_i && !hung) stuck <= stuck + 1'b1;

      if (!image_i) image_lost <= 1'b1;
      else if (write && address_i == IMAGE) image_lost <= 1'b0;

      if (bus_timeout_i && bus == '0) bus <= {1'b0, bus_address_i} + 13'd1;
      else if (write && address_i == BUS) bus <= '0;

      core_rst_no <= core_reset == '0;
      if (resetting) core_reset <= '1;
      else if (core_reset != '0) core_reset <= core_reset - 1'b1;

      // Time asleep is no silence.
      cpu_rst_no <= cpu_reset == '0;
      if (cpu_reset != '0) begin
        cpu_reset <= cpu_reset - 1'b1;
        silent <= '0;
      end else if (trap_i && cpu_rst_no) begin
        cpu_reset <= '1;
        cause <= gridrt_protocol_pkg::START_CAUSE_TRAP[1:0];
      end else if (silent == ALIVE_W'(ALIVE_CLOCKS)) begin
        cpu_reset <= '1;
        cause <= gridrt_protocol_pkg::START_CAUSE_SILENCE[1:0];
      end else if ((write && address_i == ALIVE) || (select_i && !ready_o)) begin
        silent <= '0;
      end else begin
        silent <= silent + 1'b1;
      end
    end
  end

  always_comb begin
    read_data_o = '0;
    case (address_i)
      STUCK: read_data_o = 32'(stuck);
      LIMIT: read_data_o = 32'(HANG_CLOCKS);
      IMAGE: read_data_o = {31'd0, image_lost};
      CAUSE: read_data_o = {30'd0, cause};
      BUS: read_data_o = {19'd0, bus};
      CLOCKS: read_data_o = clocks;
      REPORTS: read_data_o = WINDOWS;
      default: begin
        if (address_i >= SERIAL_0 && address_i < SERIAL_0 + 4'd4) begin
          read_data_o = SERIAL[32*serial_word+:32];
        end
      end
    endcase
  end

  if (HANG_CLOCKS < 1024 || ALIVE_CLOCKS < 2 * HANG_CLOCKS) begin : gen_illegal
    $error("gridrt_watch: HANG_CLOCKS must be 1024 or more, ALIVE_CLOCKS at least twice as many");
  end
endmodule
