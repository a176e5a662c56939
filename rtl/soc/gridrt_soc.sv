// The soft core with its memory and neighbours; docs/firmware.md has the map. Byte addresses:
// 0 on: memory; 1000_0000 on: the registers of hal/protocol/protocol.toml, those of the shell first.
module gridrt_soc #(
    parameter int unsigned HANG_CLOCKS = 1 << 20,  // of gridrt_watch
    parameter int unsigned BUS_CLOCKS = 1 << 20,  // the shell has for a register
    parameter logic [127:0] SERIAL = '0  // ASCII, the first letter lowest
) (
    input  logic        clk_i,
    input  logic        rst_ni,
    // The USB side: gridrt_mailbox.
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
    // The link, and the shell's end of it: gridrt_feed.
    input  logic        rx_valid_i,
    output logic        rx_ready_o,
    input  logic [ 7:0] rx_data_i,
    output logic        tx_valid_o,
    input  logic        tx_ready_i,
    output logic [ 7:0] tx_data_o,
    output logic        core_rx_valid_o,
    input  logic        core_rx_ready_i,
    output logic [ 7:0] core_rx_data_o,
    input  logic        core_tx_valid_i,
    output logic        core_tx_ready_o,
    input  logic [ 7:0] core_tx_data_i,
    // The shell's registers.
    output logic        reg_valid_o,
    output logic        reg_write_o,
    output logic [11:0] reg_address_o,
    output logic [31:0] reg_write_data_o,
    input  logic        reg_ready_i,
    input  logic [31:0] reg_read_data_i,
    // The core's state.
    output logic        core_rst_no,
    input  logic        core_quiet_i,
    input  logic        core_busy_i,
    input  logic        core_answered_i,
    input  logic        core_image_i,
    // The flash.
    output logic        flash_cs_no,
    output logic        flash_clk_o,
    output logic        flash_mosi_o,
    input  logic        flash_miso_i
);
  localparam int unsigned RAM_WORDS = 4096;
  localparam logic [11:0] MAILBOX = 12'(gridrt_protocol_pkg::MAILBOX_REQUEST_ADDRESS);
  localparam logic [11:0] FEED = 12'(gridrt_protocol_pkg::FEED_SOURCE_ADDRESS);
  localparam logic [11:0] FLASH = 12'(gridrt_protocol_pkg::FLASH_ADDRESS_ADDRESS);
  localparam logic [11:0] WATCH = 12'(gridrt_protocol_pkg::WATCH_STUCK_ADDRESS);
  localparam int unsigned BUS_W = $clog2(BUS_CLOCKS + 1);

  logic cpu_rst_n, trap, mem_valid, mem_instr, mem_ready;
  logic [31:0] mem_address, mem_write_data, mem_read_data;
  logic [3:0] mem_write;
  logic unused_la_read, unused_la_write, unused_pcpi_valid, unused_trace;
  logic [31:0] unused_la_address, unused_la_data, unused_pcpi_insn, unused_pcpi_rs1;
  logic [31:0] unused_pcpi_rs2, unused_eoi;
  logic [3:0] unused_la_strobe;
  logic [35:0] unused_trace_data;
  picorv32 #(
      .ENABLE_COUNTERS(0),
      .ENABLE_COUNTERS64(0),
      .COMPRESSED_ISA(1),
      .CATCH_MISALIGN(1),
      .CATCH_ILLINSN(1),
      .PROGADDR_RESET(32'd0),
      .STACKADDR(32'(4 * RAM_WORDS))
  ) u_cpu (
      .clk(clk_i),
      .resetn(cpu_rst_n),
      .trap(trap),
      .mem_valid(mem_valid),
      .mem_instr(mem_instr),
      .mem_ready(mem_ready),
      .mem_addr(mem_address),
      .mem_wdata(mem_write_data),
      .mem_wstrb(mem_write),
      .mem_rdata(mem_read_data),
      .mem_la_read(unused_la_read),
      .mem_la_write(unused_la_write),
      .mem_la_addr(unused_la_address),
      .mem_la_wdata(unused_la_data),
      .mem_la_wstrb(unused_la_strobe),
      .pcpi_valid(unused_pcpi_valid),
      .pcpi_insn(unused_pcpi_insn),
      .pcpi_rs1(unused_pcpi_rs1),
      .pcpi_rs2(unused_pcpi_rs2),
      .pcpi_wr(1'b0),
      .pcpi_rd(32'd0),
      .pcpi_wait(1'b0),
      .pcpi_ready(1'b0),
      .irq(32'd0),
      .eoi(unused_eoi),
      .trace_valid(unused_trace),
      .trace_data(unused_trace_data)
  );

  // Where an access goes. Elsewhere nothing is: firmware that strays is stopped.
  logic ram, registers, shell, wild;
  logic [11:0] address;
  assign address = mem_address[11:0];
  assign ram = mem_address[31:14] == '0;
  assign registers = mem_address[31:12] == 20'h10000 && !mem_instr;
  assign shell = registers && address < MAILBOX;
  assign wild = mem_valid && !ram && !registers;

  // The memory answers a clock later.
  logic [31:0] ram_data;
  logic ram_ready;
  gridrt_cpu_ram #(
      .WORDS(RAM_WORDS)
  ) u_ram (
      .clk_i,
      .select_i(mem_valid && ram),
      .write_i(mem_write),
      .address_i(mem_address[13:2]),
      .write_data_i(mem_write_data),
      .read_data_o(ram_data)
  );
  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) ram_ready <= 1'b0;
    else ram_ready <= mem_valid && ram && !ram_ready;
  end

  // The shell answers when it can, or never.
  logic shell_late, write;
  logic [BUS_W-1:0] bus_clocks;
  assign write = mem_write != '0;
  assign reg_valid_o = mem_valid && shell && core_rst_no;
  assign reg_write_o = write;
  assign reg_address_o = address;
  assign reg_write_data_o = mem_write_data;
  assign shell_late = mem_valid && shell && bus_clocks == BUS_W'(BUS_CLOCKS) && !reg_ready_i;
  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) bus_clocks <= '0;
    else if (!(mem_valid && shell) || mem_ready) bus_clocks <= '0;
    else bus_clocks <= bus_clocks + 1'b1;
  end

  // Neighbours that answer at once; each sees an access for one clock.
  logic near, at_mailbox, at_feed, at_flash, at_watch, watch_ready;
  logic [31:0] mailbox_data, feed_data, flash_data, watch_data, near_data;
  assign near = mem_valid && registers && !shell;
  assign at_mailbox = near && address < FEED;
  assign at_feed = near && address[11:6] == FEED[11:6];
  assign at_flash = near && address[11:6] == FLASH[11:6];
  assign at_watch = near && address[11:6] == WATCH[11:6];
  assign near_data = at_mailbox ? mailbox_data : at_feed ? feed_data : at_flash ? flash_data :
                     at_watch ? watch_data : '0;

  always_comb begin
    mem_ready = 1'b0;
    mem_read_data = ram_data;
    if (ram) begin
      mem_ready = ram_ready;
    end else if (mem_valid && shell) begin
      mem_ready = reg_ready_i || shell_late;
      mem_read_data = shell_late ? '0 : reg_read_data_i;
    end else if (near) begin
      mem_ready = !at_watch || watch_ready;
      mem_read_data = near_data;
    end
  end

  gridrt_mailbox u_mailbox (
      .clk_i,
      .rst_ni,
      .request_valid_i,
      .request_set_i,
      .request_id_i,
      .request_length_i,
      .answer_valid_o,
      .answer_good_o,
      .answer_length_o,
      .body_write_i,
      .body_address_i,
      .body_data_i,
      .body_data_o,
      .event_valid_o,
      .event_id_o,
      .event_taken_i,
      .event_address_i,
      .event_data_o,
      .select_i(at_mailbox),
      .write_i(write),
      .address_i(address[7:2]),
      .write_data_i(mem_write_data),
      .read_data_o(mailbox_data)
  );

  gridrt_feed u_feed (
      .clk_i,
      .rst_ni,
      .clear_i(!core_rst_no),
      .quiet_i(core_quiet_i && core_rst_no),
      .rx_valid_i,
      .rx_ready_o,
      .rx_data_i,
      .tx_valid_o,
      .tx_ready_i,
      .tx_data_o,
      .rx_valid_o(core_rx_valid_o),
      .rx_ready_i(core_rx_ready_i && core_rst_no),
      .rx_data_o(core_rx_data_o),
      .tx_valid_i(core_tx_valid_i),
      .tx_ready_o(core_tx_ready_o),
      .tx_data_i(core_tx_data_i),
      .select_i(at_feed),
      .write_i(write),
      .address_i(address[5:2]),
      .write_data_i(mem_write_data),
      .read_data_o(feed_data)
  );

  gridrt_flash u_flash (
      .clk_i,
      .rst_ni,
      .flash_cs_no,
      .flash_clk_o,
      .flash_mosi_o,
      .flash_miso_i,
      .select_i(at_flash),
      .write_i(write),
      .address_i(address[5:2]),
      .write_data_i(mem_write_data),
      .read_data_o(flash_data)
  );

  gridrt_watch #(
      .HANG_CLOCKS(HANG_CLOCKS),
      .ALIVE_CLOCKS(2 * (HANG_CLOCKS + BUS_CLOCKS)),
      .SERIAL(SERIAL)
  ) u_watch (
      .clk_i,
      .rst_ni,
      .busy_i(core_busy_i),
      .answered_i(core_answered_i),
      .blocked_i(core_tx_valid_i && !core_tx_ready_o),
      .image_i(core_image_i),
      .core_rst_no,
      .trap_i(trap || wild),
      .bus_timeout_i(shell_late),
      .bus_address_i(address),
      .wake_i(request_valid_i),
      .cpu_rst_no(cpu_rst_n),
      .select_i(at_watch),
      .write_i(write),
      .address_i(address[5:2]),
      .write_data_i(mem_write_data),
      .ready_o(watch_ready),
      .read_data_o(watch_data)
  );

  if (BUS_CLOCKS < 1024) begin : gen_illegal
    $error("gridrt_soc: BUS_CLOCKS must be 1024 or more");
  end
  logic unused;
  assign unused = &{1'b0, unused_la_read, unused_la_write, unused_pcpi_valid, unused_trace,
                    unused_la_address, unused_la_data, unused_pcpi_insn, unused_pcpi_rs1,
                    unused_pcpi_rs2, unused_eoi, unused_la_strobe, unused_trace_data};
endmodule
