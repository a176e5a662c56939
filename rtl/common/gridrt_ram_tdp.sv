// Block memory with two ports that each read every clock; port A writes too (while loading). Read
// data comes one clock after the address, or two with OUTPUT_REGISTER. Depths above BANK are cut
// into banks, so that no bits of the device's block memories are left unused. A bank that is not
// read puts out zeros (the reset of a block memory's output), so the banks are joined by OR.
module gridrt_ram_tdp #(
    parameter int unsigned WIDTH = 18,
    parameter int unsigned DEPTH = 1024,
    parameter int unsigned BANK = DEPTH,  // a power of two where it is below DEPTH
    parameter bit OUTPUT_REGISTER = 1'b0,
    localparam int unsigned ADDRESS_W = (DEPTH > 1) ? $clog2(DEPTH) : 1
) (
    input  logic                 clk_i,
    input  logic                 a_write_i,
    input  logic                 a_enable_i,
    input  logic [ADDRESS_W-1:0] a_address_i,
    input  logic [    WIDTH-1:0] a_data_i,
    output logic [    WIDTH-1:0] a_data_o,
    input  logic                 b_enable_i,
    input  logic [ADDRESS_W-1:0] b_address_i,
    output logic [    WIDTH-1:0] b_data_o
);
  localparam int unsigned BANKS = (DEPTH + BANK - 1) / BANK;
  localparam int unsigned BANK_W = (BANK > 1) ? $clog2(BANK) : 1;

  if (WIDTH < 1 || DEPTH < 1) begin : gen_illegal
    $error("gridrt_ram_tdp: WIDTH and DEPTH must be positive");
  end
  if (BANKS > 1 && (1 << BANK_W) != BANK) begin : gen_illegal_bank
    $error("gridrt_ram_tdp: BANK must be a power of two");
  end

  logic [BANKS-1:0][WIDTH-1:0] a_bank, b_bank;
  logic [WIDTH-1:0] a_now, b_now;

  // With an output register the enables, which often come late, are needed there only.
  logic a_read, b_read;
  assign a_read = OUTPUT_REGISTER || a_enable_i;
  assign b_read = OUTPUT_REGISTER || b_enable_i;

  for (genvar i = 0; i < BANKS; i++) begin : gen_bank
    localparam int unsigned WORDS = (i == BANKS - 1) ? DEPTH - i * BANK : BANK;
    localparam int unsigned LOW_W = (WORDS > 1) ? $clog2(WORDS) : 1;
    // Nothing reads while the memory is loaded, so no logic is wanted for that case.
    (* no_rw_check *)
    logic [WIDTH-1:0] memory[WORDS];
    logic [LOW_W-1:0] a_low, b_low;
    logic a_here, b_here;
    assign a_low = LOW_W'(a_address_i);
    assign b_low = LOW_W'(b_address_i);
    if (BANKS > 1) begin : gen_select
      assign a_here = (a_address_i >> BANK_W) == ADDRESS_W'(i);
      assign b_here = (b_address_i >> BANK_W) == ADDRESS_W'(i);
    end else begin : gen_always
      assign a_here = 1'b1;
      assign b_here = 1'b1;
    end
    always_ff @(posedge clk_i) begin
      if (a_enable_i && a_write_i && a_here) memory[a_low] <= a_data_i;
      if (a_read && !a_here) a_bank[i] <= '0;
      else if (a_read && !a_write_i) a_bank[i] <= memory[a_low];
    end
    always_ff @(posedge clk_i) begin
      if (b_read && !b_here) b_bank[i] <= '0;
      else if (b_read) b_bank[i] <= memory[b_low];
    end
  end

  always_comb begin
    a_now = '0;
    b_now = '0;
    for (int unsigned i = 0; i < BANKS; i++) begin
      a_now = a_now | a_bank[i];
      b_now = b_now | b_bank[i];
    end
  end

  if (OUTPUT_REGISTER) begin : gen_register
    // The register follows the enables by one clock.
    logic a_enable_q, b_enable_q;
    always_ff @(posedge clk_i) begin
      a_enable_q <= a_enable_i;
      b_enable_q <= b_enable_i;
      if (a_enable_q) a_data_o <= a_now;
      if (b_enable_q) b_data_o <= b_now;
    end
  end else begin : gen_direct
    assign a_data_o = a_now;
    assign b_data_o = b_now;
  end
endmodule
