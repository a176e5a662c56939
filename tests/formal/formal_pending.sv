// The counts of pending tasks against a plain counter of one slot, whichever it is: the right count
// at the right clock, and "none" only if no task is left.
module formal_pending #(
    parameter int unsigned SLOTS = 4,
    parameter int unsigned TUS   = 2,
    parameter int unsigned ENDS  = 6,
    parameter int unsigned AHEAD = 4,
    localparam int unsigned SLOT_W = gridrt_pkg::SLOT_W,
    localparam int unsigned END_W = gridrt_pkg::SLOT_EVENT_W
) (
    input logic                       clk_i,
    input logic [TUS-1:0]             inc_valid_i,
    input logic [TUS-1:0][SLOT_W-1:0] inc_slot_i,
    input logic [TUS-1:0][3:0]        inc_count_i,
    input logic [ENDS-1:0][END_W-1:0] end_i
);
  logic rst_n = 1'b0;
  always_ff @(posedge clk_i) rst_n <= 1'b1;
  (* anyconst *) logic [SLOT_W-1:0] slot;

  logic [SLOTS-1:0] few, none, many;
  gridrt_pending #(
      .SLOTS(SLOTS),
      .TUS(TUS),
      .ENDS(ENDS),
      .AHEAD(AHEAD)
  ) dut (
      .clk_i,
      .rst_ni(rst_n),
      .inc_valid_i,
      .inc_slot_i,
      .inc_count_i,
      .end_i,
      .few_o (few),
      .none_o(none),
      .many_o(many)
  );

  // left: tasks that have not ended, by slot; counted: with those that have ended so lately that the
  // block does not know of it; count: what it must think of the watched slot.
  logic [SLOTS-1:0][5:0] left, counted, made, ended, ended_q, ended_qq;
  logic [5:0] count, left_here;
  always_comb begin
    {count, left_here} = '0;
    for (int unsigned s = 0; s < SLOTS; s++) begin
      made[s] = '0;
      for (int unsigned t = 0; t < TUS; t++) begin
        if (inc_valid_i[t] && inc_slot_i[t] == SLOT_W'(s)) made[s] = made[s] + 6'(inc_count_i[t]);
      end
      ended[s] = '0;
      for (int unsigned e = 0; e < ENDS; e++) begin
        if (end_i[e] == {1'b1, SLOT_W'(s)}) ended[s] = ended[s] + 6'd1;
      end
      if (slot == SLOT_W'(s)) {count, left_here} = {counted[s], left[s]};
    end
  end

  always_ff @(posedge clk_i) begin
    assume (32'(slot) < SLOTS);
    for (int unsigned t = 0; t < TUS; t++) begin
      assume (32'(inc_slot_i[t]) % TUS == t);  // a slot belongs to one unit
      assume (inc_count_i[t] <= 4'd8);  // voxels of a block
    end
    if (!rst_n) begin
      left <= '0;
      counted <= '0;
      ended_q <= '0;
      ended_qq <= '0;
    end else begin
      for (int unsigned s = 0; s < SLOTS; s++) begin
        assume (ended[s] <= left[s]);  // a task ends once, after it was made
        assume (counted[s] + made[s] <= 6'(2 * AHEAD - 1 + 8));  // what the units keep to
        left[s] <= left[s] + made[s] - ended[s];
        counted[s] <= counted[s] + made[s] - ended_qq[s];
      end
      ended_q <= ended;
      ended_qq <= ended_q;

      assert (few[slot] == (count < 6'(AHEAD)));
      assert (none[slot] == (count == '0));
      assert (many[slot] == (count > 6'd1));
      assert (!none[slot] || left_here == '0);
      cover (count == 6'(2 * AHEAD - 1 + 8));
    end
  end
endmodule
