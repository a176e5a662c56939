// Best hits, interrupts and limits of one slot, whichever it is, against a plain comparison of all
// its hits: the least key of the present ray and nothing of an earlier one.
module formal_best #(
    parameter int unsigned SLOTS = 2,
    parameter int unsigned PES   = 2,
    localparam int unsigned SLOT_W = gridrt_pkg::SLOT_W,
    localparam int unsigned DIST_W = gridrt_pkg::DIST_W,
    localparam int unsigned ID_W = gridrt_pkg::ID_W,
    localparam int unsigned KEY_W = gridrt_pkg::Q_W + gridrt_pkg::ID_W,
    localparam int unsigned EVENT_W = gridrt_pkg::EVENT_W,
    localparam int unsigned END_W = gridrt_pkg::SLOT_EVENT_W
) (
    input logic                        clk_i,
    input logic [SLOT_W-1:0]           watch_i,
    input gridrt_pkg::slot_event_t     alloc_i,
    input logic [PES-1:0]              event_valid_i,
    input logic [PES-1:0]              dropped_i,
    input logic [PES-1:0][EVENT_W-1:0] event_i
);
  logic rst_n = 1'b0;
  always_ff @(posedge clk_i) rst_n <= 1'b1;
  logic [SLOT_W-1:0] slot;  // the watched one

  logic [PES-1:0] ready;
  logic [PES-1:0][END_W-1:0] ends;
  gridrt_pkg::interrupt_t interrupt;
  gridrt_pkg::event_t hit;
  logic hit_valid;
  logic [SLOTS-1:0] has_hit;
  logic [ID_W-1:0] id;
  logic [DIST_W-1:0] limit;
  gridrt_best #(
      .SLOTS(SLOTS),
      .PES  (PES)
  ) dut (
      .clk_i,
      .rst_ni(rst_n),
      .alloc_i,
      .event_valid_i,
      .event_ready_o(ready),
      .event_i,
      .dropped_i,
      .end_o(ends),
      .interrupt_o(interrupt),
      .hit_o(hit),
      .hit_valid_o(hit_valid),
      .has_hit_o(has_hit),
      .read_slot_i(slot),
      .read_id_o(id)
  );
  gridrt_limits #(
      .SLOTS(SLOTS)
  ) limits (
      .clk_i,
      .rst_ni(rst_n),
      .alloc_i,
      .interrupt_i(interrupt),
      .slot_i(slot),
      .limit_o(limit)
  );

  // What is right: the least key of all hits taken, and the limit that came with it. The block shows
  // it a clock later, the limits two.
  logic alive, has, has_q, has_qq;  // alive: the slot has had a ray
  logic [KEY_W-1:0] key, key_q;
  logic [DIST_W-1:0] bound, bound_q, bound_qq;
  logic [SLOTS-1:0][2:0] quiet;  // clocks since the slot's last event
  logic [PES-1:0] held;
  logic [PES-1:0][EVENT_W-1:0] was;
  logic [PES-1:0][3:0] clocks;
  gridrt_pkg::event_t one;

  always_ff @(posedge clk_i) begin
    assume (32'(watch_i) < SLOTS);
    if (!rst_n) begin
      slot <= watch_i;
      alive <= 1'b0;
      has <= 1'b0;
      has_q <= 1'b0;
      has_qq <= 1'b0;
      quiet <= '1;
      held <= '0;
      clocks <= '0;
    end else begin
      // A slot is given to the next ray only after the last task of the ray before has ended and
      // has been counted.
      assume (!alloc_i.valid || 32'(alloc_i.slot) < SLOTS);
      assume (!alloc_i.valid || !interrupt.valid);  // as gridrt_feedback has it
      for (int unsigned s = 0; s < SLOTS; s++) begin
        if (quiet[s] != '1) quiet[s] <= quiet[s] + 3'd1;
        if (alloc_i.valid && alloc_i.slot == SLOT_W'(s)) assume (quiet[s] >= 3'd2);
      end
      for (int unsigned p = 0; p < PES; p++) begin
        one = event_i[p];
        if (held[p]) assume (event_valid_i[p] && event_i[p] == was[p]);
        was[p] <= event_i[p];
        if (event_valid_i[p]) begin
          assume (32'(one.slot) < SLOTS);
          assume (one.hit || one.last);
          assume (alive || one.slot != slot);
          assume (!(alloc_i.valid && alloc_i.slot == one.slot));
          // A smaller quotient has no larger limit; equal quotients have the same.
          if (has && one.hit && one.slot == slot) begin
            assume (one.quotient >= key[KEY_W-1:ID_W] || one.limit <= bound);
            assume (one.quotient != key[KEY_W-1:ID_W] || one.limit == bound);
          end
          for (int unsigned s = 0; s < SLOTS; s++) begin
            if (one.slot == SLOT_W'(s)) quiet[s] <= '0;
          end
        end
        // Once its PE drops no other task, an event waits for one of each other PE at most.
        clocks[p] <= (event_valid_i[p] && !ready[p] && !dropped_i[p]) ? clocks[p] + 4'd1 : '0;
        assert (clocks[p] < 4'(PES));
        assert (!(dropped_i[p] && ends[p][END_W-1]));  // a PE ends one task a clock
        assert (ends[p] == {event_valid_i[p] && ready[p] && one.last, one.slot});
        if (event_valid_i[p] && ready[p] && one.hit && one.slot == slot) begin
          has <= 1'b1;
          if (!has || {one.quotient, one.id} < key) begin
            key   <= {one.quotient, one.id};
            bound <= one.limit;
          end
          // One hit a clock is compared.
          for (int unsigned q = 0; q < p; q++) begin
            assert (!(event_valid_i[q] && ready[q] && event_i[q][EVENT_W-SLOT_W-2]));
          end
        end
      end
      held <= event_valid_i & ~ready;

      has_q <= has;
      key_q <= key;
      bound_q <= bound;
      has_qq <= has_q;
      bound_qq <= bound_q;
      if (alloc_i.valid && alloc_i.slot == slot) begin
        has <= 1'b0;
        has_q <= 1'b0;
        has_qq <= 1'b0;
        alive <= 1'b1;
      end
      for (int unsigned s = 0; s < SLOTS; s++) begin
        if (slot == SLOT_W'(s)) assert (has_hit[s] == has_q);
      end
      assert (!has_q || id == key_q[ID_W-1:0]);
      assert (!alive || limit == (has_qq ? bound_qq : '1));
      cover (has_qq && limit == 2'd1 && key_q == 4'b0001 && bound_qq == 2'd1);
    end
  end
endmodule
