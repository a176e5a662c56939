// Free slots: one slot, whichever it is, is never given to a second ray while it is used, never
// lost, and always given in the end.
module formal_slots #(
    parameter int unsigned SLOTS = 4,
    parameter int unsigned TUS   = 2,
    localparam int unsigned SLOT_W = gridrt_pkg::SLOT_W
) (
    input logic              clk_i,
    input logic              take_i,
    input logic              free_i,
    input logic [SLOT_W-1:0] free_slot_i
);
  logic rst_n = 1'b0;
  always_ff @(posedge clk_i) rst_n <= 1'b1;
  (* anyconst *) logic [SLOT_W-1:0] watched;

  logic valid;
  logic [SLOT_W-1:0] slot;
  logic [TUS-1:0] unit;
  gridrt_slots #(
      .SLOTS(SLOTS),
      .TUS  (TUS)
  ) dut (
      .clk_i,
      .rst_ni(rst_n),
      .valid_o(valid),
      .slot_o(slot),
      .unit_o(unit),
      .take_i,
      .free_i,
      .free_slot_i
  );

  logic [SLOTS-1:0] used;
  logic [3:0] passed;  // others that were taken while the watched one was free
  logic [3:0] age;  // clocks since reset
  always_ff @(posedge clk_i) begin
    assume (32'(watched) < SLOTS);
    if (!rst_n) begin
      used   <= '0;
      passed <= '0;
      age    <= '0;
    end else begin
      assume (!take_i || valid);
      assume (!free_i || (32'(free_slot_i) < SLOTS && used[free_slot_i]));
      if (free_i) used[free_slot_i] <= 1'b0;
      if (take_i) used[slot] <= 1'b1;
      if (used[watched] || slot == watched) passed <= '0;
      else if (take_i) passed <= passed + 4'd1;
      if (age != '1) age <= age + 4'd1;

      if (valid) begin
        assert (32'(slot) < SLOTS);
        assert (!used[slot]);
        assert (unit == TUS'(1) << (slot % SLOT_W'(TUS)));
      end
      // Filled after SLOTS clocks; then a free slot is on offer at once.
      assert (age < 4'(SLOTS) || valid || used == '1);
      assert (passed < 4'(SLOTS));
      cover (used == '1);
    end
  end
endmodule
