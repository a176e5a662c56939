// The device on an ECPIX-5 (LFE5UM5G-85F, USB3300 PHY): pins, clock, reset, lamps. Everything runs
// on the PHY's 60 MHz, which come in at a dedicated clock pin; that pin is no PLL's, so a PLL would
// not take the delay of the clock out. docs/bring-up.md tells what the lamps mean. The voltage of the
// cable is not looked at: the device is always connected.
module gridrt_ecpix5 #(
    parameter int unsigned B = 17,
    parameter int unsigned PES = 4
) (
    input  logic        clk_100_i,
    input  logic        ulpi_clk_i,
    inout  wire  [ 7:0] ulpi_data_io,
    input  logic        ulpi_dir_i,
    input  logic        ulpi_nxt_i,
    output logic        ulpi_stp_o,
    output logic        ulpi_rst_o,
    output logic        flash_cs_no,  // its clock is a pin of configuration
    output logic        flash_mosi_o,
    input  logic        flash_miso_i,
    output logic        flash_wp_no,
    output logic        flash_hold_no,
    output logic [11:0] led_no  // red, green, blue of four lamps
);
  localparam logic [63:0] NAME = 64'h35_78_69_70_63_65;  // "ecpix5", the first letter lowest
  localparam logic [127:0] SERIAL = 128'h31_58_49_50_43_45;  // "ECPIX1"; LUNA's is the same
  localparam int unsigned GLOW = 22;  // a lamp stays on for 2^(GLOW-1) clocks, 35 ms

  logic clk, hold;
  assign clk = ulpi_clk_i;
  gridrt_power_up u_power_up (
      .clk_i(clk_100_i),
      .phy_rst_o(ulpi_rst_o),
      .hold_o(hold)
  );

  // The translator's reset ends some clocks after the PHY's clock has had time to start. The device's
  // lasts longer: LUNA leaves the PHY alone for 1 ms and then sets its registers, and the device must
  // not take lines that nobody pulls up yet for a reset of the bus.
  logic ulpi_rst_n, rst_n;
  gridrt_late_reset u_ulpi_reset (
      .clk_i (clk),
      .rst_ni(!hold),
      .rst_no(ulpi_rst_n)
  );
  gridrt_late_reset #(
      .CLOCKS(1 << 17)
  ) u_device_reset (
      .clk_i (clk),
      .rst_ni(ulpi_rst_n),
      .rst_no(rst_n)
  );

  logic [7:0] ulpi_in, ulpi_out;
  logic ulpi_drive;
  for (genvar i = 0; i < 8; ++i) begin : gen_pin
    TRELLIS_IO #(
        .DIR("BIDIR")
    ) u_pin (
        .I(ulpi_out[i]),
        .T(!ulpi_drive),
        .O(ulpi_in[i]),
        .B(ulpi_data_io[i])
    );
  end

  logic [7:0] rx_data, tx_data, sent_data;
  logic rx_active, rx_valid, rx_error, tx_valid, tx_ready, sent_valid, sent_ready, busy, term_select;
  logic [1:0] line_state, xcvr_select, op_mode;
  gridrt_ulpi u_ulpi (
      .clk_i(clk),
      .rst_i(!ulpi_rst_n),
      .ulpi_data_i(ulpi_in),
      .ulpi_data_o(ulpi_out),
      .ulpi_drive_o(ulpi_drive),
      .ulpi_dir_i(ulpi_dir_i),
      .ulpi_nxt_i(ulpi_nxt_i),
      .ulpi_stp_o(ulpi_stp_o),
      .utmi_rx_data_o(rx_data),
      .utmi_rx_active_o(rx_active),
      .utmi_rx_valid_o(rx_valid),
      .utmi_rx_error_o(rx_error),
      .utmi_tx_data_i(sent_data),
      .utmi_tx_valid_i(sent_valid),
      .utmi_tx_ready_o(sent_ready),
      .utmi_line_state_o(line_state),
      .utmi_busy_o(busy),
      .utmi_xcvr_select_i(xcvr_select),
      .utmi_term_select_i(term_select),
      .utmi_op_mode_i(op_mode)
  );

  // The pins' data come from registers near them, or the way to them would begin in the firmware's
  // memories. A packet that ends is followed by others after a token only.
  gridrt_skid #(
      .WIDTH(8)
  ) u_sent (
      .clk_i(clk),
      .rst_ni(ulpi_rst_n),
      .in_valid_i(tx_valid),
      .in_ready_o(tx_ready),
      .in_data_i(tx_data),
      .out_valid_o(sent_valid),
      .out_ready_i(sent_ready),
      .out_data_o(sent_data)
  );

  logic suspended, hears, waits, speaks, blocked, flash_clk;
  logic [1:0] speed;
  gridrt_device #(
      .B(B),
      .PES(PES),
      .CLOCK_HZ(60000000),
      .NAME(NAME),
      .SERIAL(SERIAL)
  ) u_device (
      .clk_i(clk),
      .rst_ni(rst_n),
      .utmi_rx_data_i(rx_data),
      .utmi_rx_active_i(rx_active),
      .utmi_rx_valid_i(rx_valid),
      .utmi_rx_error_i(rx_error),
      .utmi_tx_data_o(tx_data),
      .utmi_tx_valid_o(tx_valid),
      .utmi_tx_ready_i(tx_ready),
      .utmi_line_state_i(line_state),
      .utmi_busy_i(busy),
      .utmi_xcvr_select_o(xcvr_select),
      .utmi_term_select_o(term_select),
      .utmi_op_mode_o(op_mode),
      .flash_cs_no,
      .flash_clk_o(flash_clk),
      .flash_mosi_o,
      .flash_miso_i,
      .suspended_o(suspended),
      .speed_o(speed),
      .hears_o(hears),
      .waits_o(waits),
      .speaks_o(speaks),
      .blocked_o(blocked)
  );

  assign flash_wp_no = 1'b1;
  assign flash_hold_no = 1'b1;
  USRMCLK u_flash_clk (
      .USRMCLKI (flash_clk),
      .USRMCLKTS(1'b0)
  );

  // Lamps. The first two show the link, the third the clock; the fourth is dark.
  logic [GLOW-1:0] heard, spoken;
  logic [24:0] beat;
  always_ff @(posedge clk or negedge rst_n) begin
    if (!rst_n) begin
      heard <= '0;
      spoken <= '0;
      beat <= '0;
    end else begin
      heard <= hears ? '1 : heard - GLOW'(heard[GLOW-1]);
      spoken <= speaks ? '1 : spoken - GLOW'(spoken[GLOW-1]);
      beat <= beat + 1'b1;
    end
  end
  assign led_no[2:0] = ~{rst_n && speed == 2'd0, rst_n && speed == 2'd1 && !suspended, suspended};
  assign led_no[5:3] = ~{spoken[GLOW-1], heard[GLOW-1], 1'b0};
  assign led_no[8:6] = ~{1'b0, beat[24], !rst_n};
  assign led_no[11:9] = '1;

  logic unused;
  assign unused = &{1'b0, waits, blocked};
endmodule
