// The whole board but its link: the core, and the soft core whose firmware serves control reports.
// Frames from the host come in on rx, frames to the host go out on tx, a byte a clock; control and
// input reports pass through the mailbox's ports (soc/gridrt_mailbox.sv says how).
module gridrt_board #(
    parameter int unsigned B = 17,  // lattice bits, 4 to 17
    parameter int unsigned PES = 4,  // 1, 2 or 4
    parameter int unsigned TUS = 3,  // of the engine, as those below: gridrt_engine.sv
    parameter int unsigned SLOTS = 63,
    parameter int unsigned ROB = 256,
    parameter int unsigned QUEUE = 16,
    parameter int unsigned AHEAD = 2,
    parameter int unsigned BLOCKS = 4096,
    parameter int unsigned CELLS = 6144,
    parameter int unsigned REFS = 8192,
    parameter int unsigned TRIS = 4096,
    parameter int unsigned VERTS = 2560,
    parameter int unsigned DIVIDERS = 2,
    parameter bit MASK = 1'b1,
    parameter bit CANCEL = 1'b1,
    parameter bit FEEDBACK = 1'b1,
    parameter int unsigned MAX_PAYLOAD = 16384,  // bytes of a frame's payload
    parameter int unsigned CLOCK_HZ = 60000000,
    parameter logic [63:0] NAME = 64'h6D6973,  // ASCII, the first letter lowest: "sim"
    parameter int unsigned LOG_WORDS = 512,  // of the event log
    parameter int unsigned HANG_CLOCKS = 1 << 20,  // of the watchdog: gridrt_soc.sv
    parameter int unsigned BUS_CLOCKS = 1 << 20,
    parameter logic [127:0] SERIAL = 128'h304D4953  // ASCII, the first letter lowest: "SIM0"
) (
    input  logic       clk_i,
    input  logic       rst_ni,
    input  logic       rx_valid_i,
    output logic       rx_ready_o,
    input  logic [7:0] rx_data_i,
    output logic       tx_valid_o,
    input  logic       tx_ready_i,
    output logic [7:0] tx_data_o,
    input  logic       request_valid_i,
    input  logic       request_set_i,
    input  logic [7:0] request_id_i,
    input  logic [6:0] request_length_i,
    output logic       answer_valid_o,
    output logic       answer_good_o,
    output logic [6:0] answer_length_o,
    input  logic       body_write_i,
    input  logic [5:0] body_address_i,
    input  logic [7:0] body_data_i,
    output logic [7:0] body_data_o,
    output logic       event_valid_o,
    output logic [7:0] event_id_o,
    input  logic       event_taken_i,
    input  logic [5:0] event_address_i,
    output logic [7:0] event_data_o,
    // A serial flash.
    output logic       flash_cs_no,
    output logic       flash_clk_o,
    output logic       flash_mosi_o,
    input  logic       flash_miso_i
);
  logic core_rst_n, core_rx_valid, core_rx_ready, core_tx_valid, core_tx_ready;
  logic [7:0] core_rx_data, core_tx_data;
  logic reg_valid, reg_write, reg_ready, quiet, busy, answered, image;
  logic [11:0] reg_address;
  logic [31:0] reg_write_data, reg_read_data;

  gridrt_soc #(
      .HANG_CLOCKS(HANG_CLOCKS),
      .BUS_CLOCKS(BUS_CLOCKS),
      .SERIAL(SERIAL)
  ) u_soc (
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
      .rx_valid_i,
      .rx_ready_o,
      .rx_data_i,
      .tx_valid_o,
      .tx_ready_i,
      .tx_data_o,
      .core_rx_valid_o(core_rx_valid),
      .core_rx_ready_i(core_rx_ready),
      .core_rx_data_o(core_rx_data),
      .core_tx_valid_i(core_tx_valid),
      .core_tx_ready_o(core_tx_ready),
      .core_tx_data_i(core_tx_data),
      .reg_valid_o(reg_valid),
      .reg_write_o(reg_write),
      .reg_address_o(reg_address),
      .reg_write_data_o(reg_write_data),
      .reg_ready_i(reg_ready),
      .reg_read_data_i(reg_read_data),
      .core_rst_no(core_rst_n),
      .core_quiet_i(quiet),
      .core_busy_i(busy),
      .core_answered_i(answered),
      .core_image_i(image),
      .flash_cs_no,
      .flash_clk_o,
      .flash_mosi_o,
      .flash_miso_i
  );

  gridrt_core #(
      .B(B),
      .PES(PES),
      .TUS(TUS),
      .SLOTS(SLOTS),
      .ROB(ROB),
      .QUEUE(QUEUE),
      .AHEAD(AHEAD),
      .BLOCKS(BLOCKS),
      .CELLS(CELLS),
      .REFS(REFS),
      .TRIS(TRIS),
      .VERTS(VERTS),
      .DIVIDERS(DIVIDERS),
      .MASK(MASK),
      .CANCEL(CANCEL),
      .FEEDBACK(FEEDBACK),
      .MAX_PAYLOAD(MAX_PAYLOAD),
      .CLOCK_HZ(CLOCK_HZ),
      .NAME(NAME),
      .LOG_WORDS(LOG_WORDS)
  ) u_core (
      .clk_i,
      .rst_ni(core_rst_n),
      .rx_valid_i(core_rx_valid),
      .rx_ready_o(core_rx_ready),
      .rx_data_i(core_rx_data),
      .tx_valid_o(core_tx_valid),
      .tx_ready_i(core_tx_ready),
      .tx_data_o(core_tx_data),
      .reg_valid_i(reg_valid),
      .reg_write_i(reg_write),
      .reg_address_i(reg_address),
      .reg_write_data_i(reg_write_data),
      .reg_ready_o(reg_ready),
      .reg_read_data_o(reg_read_data),
      .quiet_o(quiet),
      .busy_o(busy),
      .answered_o(answered),
      .image_o(image)
  );
endmodule
