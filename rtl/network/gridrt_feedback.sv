// Settles the answer of each ray: gives slots to rays, counts their pending tasks, keeps their best
// hits, and commits a ray once its traversal is over and every task has answered.
module gridrt_feedback #(
    parameter int unsigned SLOTS = 64,
    parameter int unsigned TUS = 4,
    parameter int unsigned EXPS = 2,
    parameter int unsigned PES = 4,
    parameter int unsigned AHEAD = 2,
    parameter int unsigned ROB = 256,
    parameter bit FEEDBACK = 1'b1,  // 0: a ray commits with its first hit (wrong, for a test)
    localparam int unsigned ENTRY_W = $clog2(ROB),
    localparam int unsigned SLOT_W = gridrt_pkg::SLOT_W
) (
    input  logic                                  clk_i,
    input  logic                                  rst_ni,
    // A ray from the setup; alloc_o (with the handshake) tells its slot to all blocks.
    input  logic                                  ray_valid_i,
    output logic                                  ray_ready_o,
    input  logic                                  ray_miss_i,  // P0 = P1: nothing to traverse
    output gridrt_pkg::slot_event_t               alloc_o,
    output logic                    [TUS-1:0]     start_o,  // the unit that traverses it
    input  logic                    [TUS-1:0]     start_ready_i,
    input  logic                                  room_i,  // of the reorder buffer
    input  logic                    [ENTRY_W-1:0] entry_i,
    // Traversal units: tasks made by a step; the traversal of a slot is over.
    input  logic                    [TUS-1:0]     inc_valid_i,
    input  logic                    [TUS-1:0][SLOT_W-1:0] inc_slot_i,
    input  logic                    [TUS-1:0][3:0] inc_count_i,
    input  logic                    [TUS-1:0]     done_valid_i,
    input  logic                    [TUS-1:0][SLOT_W-1:0] done_slot_i,
    output logic                    [SLOTS-1:0]   few_o,  // fewer than AHEAD tasks pending
    output logic                    [SLOTS-1:0]   none_o,  // no task pending
    output logic                    [SLOTS-1:0]   walking_o,  // has a ray that is being traversed
    // Tasks that end without an event, and events.
    input  logic                    [EXPS+PES-1:0][gridrt_pkg::SLOT_EVENT_W-1:0] drop_i,  // slot_event_t
    input  logic                    [PES-1:0]     event_valid_i,
    output logic                    [PES-1:0]     event_ready_o,
    input  logic                    [PES-1:0][gridrt_pkg::EVENT_W-1:0] event_i,  // event_t
    output gridrt_pkg::interrupt_t                interrupt_o,
    // The answer, into the reorder buffer.
    output logic                                  commit_o,
    output logic                    [ENTRY_W-1:0] commit_entry_o,
    output logic                                  commit_hit_o,
    output logic                    [gridrt_pkg::ID_W-1:0] commit_id_o,
    output logic                                  wait_o,  // it had a hit while tasks were pending
    output gridrt_pkg::event_t                    hit_o,  // the hit that is compared now
    output logic                                  hit_valid_o
);
  localparam int unsigned INDEX_W = (SLOTS > 1) ? $clog2(SLOTS) : 1;

  logic list_valid, list_take, free_valid, take, free;
  logic [SLOT_W-1:0] list_slot, free_slot, pick_slot;
  logic [TUS-1:0] list_unit, unit;
  logic [SLOTS-1:0] none, many, has_hit;
  logic [PES-1:0][gridrt_pkg::SLOT_EVENT_W-1:0] event_end;
  logic [gridrt_pkg::ID_W-1:0] best_id;

  // Blocks write a slot's limit both when it gets a ray and when a hit lowers it.
  assign ray_ready_o = free_valid && room_i && (start_ready_i & unit) != '0 && !interrupt_o.valid;
  assign take = ray_valid_i && ray_ready_o;
  assign alloc_o.valid = take;
  assign alloc_o.slot = free_slot;
  assign start_o = (take && !ray_miss_i) ? unit : '0;
  assign none_o = none;

  gridrt_slots #(
      .SLOTS(SLOTS),
      .TUS  (TUS)
  ) u_slots (
      .clk_i,
      .rst_ni,
      .valid_o(list_valid),
      .slot_o(list_slot),
      .unit_o(list_unit),
      .take_i(list_take),
      .free_i(free),
      .free_slot_i(pick_slot)
  );

  // The slot of the next ray waits in a register: a start reaches all blocks in the same clock.
  assign list_take = list_valid && (!free_valid || take);
  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      free_valid <= 1'b0;
      free_slot <= '0;
      unit <= '0;
    end else begin
      if (take) free_valid <= 1'b0;
      if (list_take) begin
        free_valid <= 1'b1;
        free_slot <= list_slot;
        unit <= list_unit;
      end
    end
  end

  // A PE ends one task a clock: a drop goes before an event that ends one.
  logic [PES-1:0] pe_dropped;
  logic [EXPS+PES-1:0][gridrt_pkg::SLOT_EVENT_W-1:0] ends;
  assign ends[EXPS-1:0] = drop_i[EXPS-1:0];
  for (genvar p = 0; p < PES; p++) begin : gen_end
    assign pe_dropped[p] = drop_i[EXPS+p][SLOT_W];
    assign ends[EXPS+p] = drop_i[EXPS+p][SLOT_W] ? drop_i[EXPS+p] : event_end[p];
  end

  gridrt_best #(
      .SLOTS(SLOTS),
      .PES(PES),
      .FEEDBACK(FEEDBACK)
  ) u_best (
      .clk_i,
      .rst_ni,
      .alloc_i(alloc_o),
      .event_valid_i,
      .event_ready_o,
      .event_i,
      .dropped_i(pe_dropped),
      .end_o(event_end),
      .interrupt_o,
      .hit_o,
      .hit_valid_o,
      .has_hit_o(has_hit),
      .read_slot_i(pick_slot),
      .read_id_o(best_id)
  );

  gridrt_pending #(
      .SLOTS(SLOTS),
      .TUS(TUS),
      .ENDS(EXPS + PES),
      .AHEAD(AHEAD)
  ) u_pending (
      .clk_i,
      .rst_ni,
      .inc_valid_i,
      .inc_slot_i,
      .inc_count_i,
      .end_i(ends),
      .few_o,
      .none_o(none),
      .many_o(many)
  );

  // By slot: a ray enters, a hit is compared, a traversal ends.
  logic [SLOTS-1:0] enters, compared, ends_here;
  logic [TUS-1:0][SLOTS-1:0] traversed;
  gridrt_onehot #(
      .LINES(SLOTS)
  ) u_enters (
      .valid_i(take),
      .index_i(INDEX_W'(free_slot)),
      .line_o (enters)
  );
  gridrt_onehot #(
      .LINES(SLOTS)
  ) u_compared (
      .valid_i(hit_valid_o),
      .index_i(INDEX_W'(hit_o.slot)),
      .line_o (compared)
  );
  for (genvar t = 0; t < TUS; t++) begin : gen_traversed
    gridrt_onehot #(
        .LINES(SLOTS)
    ) u_slot (
        .valid_i(done_valid_i[t]),
        .index_i(INDEX_W'(done_slot_i[t])),
        .line_o (traversed[t])
    );
  end
  // Slot s belongs to unit s modulo TUS.
  always_comb begin
    for (int unsigned s = 0; s < SLOTS; s++) ends_here[s] = traversed[s%TUS][s];
  end

  // Slots by state: busy from allocation to commit, over once nothing more is traversed.
  logic [SLOTS-1:0] busy, over, told, waited;
  logic [SLOTS-1:0] settled, ready, after, upper, pick, pick_q;
  logic free_q, commit_q, hit_q;
  logic [ENTRY_W-1:0] entry_q;

  assign settled = busy & over & none;
  assign walking_o = busy & ~over;
  assign ready = FEEDBACK ? settled : settled | (busy & has_hit & ~told);
  // One a clock, in turn: the next one behind those chosen last. `after` follows a clock later.
  assign upper = ready & after;
  assign pick = (upper != '0) ? upper & (~upper + SLOTS'(1)) : ready & (~ready + SLOTS'(1));

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      busy <= '0;
      over <= '0;
      told <= '0;
      waited <= '0;
      after <= '0;
      pick_q <= '0;
      free_q <= 1'b0;
      commit_q <= 1'b0;
      commit_o <= 1'b0;
    end else begin
      commit_o <= commit_q;
      pick_q   <= pick;
      // With feedback whatever is ready is settled and has not been told.
      free_q   <= FEEDBACK ? ready != '0 : (pick & settled) != '0;
      commit_q <= FEEDBACK ? ready != '0 : (pick & ~told) != '0;
      if (pick_q != '0) after <= ~(pick_q | (pick_q - SLOTS'(1)));
      busy <= (busy & ~(pick & settled)) | enters;
      over <= ((over | ends_here) & ~enters) | (enters & {SLOTS{ray_miss_i}});
      told <= (told | pick) & ~enters;
      waited <= (waited | (compared & many)) & ~enters;
    end
  end

  // The clock after the choice: number of the slot, its entry, its answer, which leaves a clock later.
  always_comb begin
    pick_slot = '0;
    for (int unsigned s = 0; s < SLOTS; s++) begin
      if (pick_q[s]) pick_slot = pick_slot | SLOT_W'(s);
    end
  end
  assign free = free_q;

  gridrt_lutram #(
      .WIDTH(ENTRY_W),
      .DEPTH(SLOTS)
  ) u_entries (
      .clk_i,
      .write_i(take),
      .write_address_i(INDEX_W'(free_slot)),
      .write_data_i(entry_i),
      .read_address_i(INDEX_W'(pick_slot)),
      .read_data_o(entry_q)
  );

  assign hit_q = (pick_q & has_hit) != '0;
  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) wait_o <= 1'b0;
    else wait_o <= commit_q && hit_q && (pick_q & waited) != '0;
  end
  always_ff @(posedge clk_i) begin
    commit_entry_o <= entry_q;
    commit_hit_o <= hit_q;
    commit_id_o <= hit_q ? best_id : gridrt_pkg::NO_ID;
  end

`ifdef GRIDRT_ASSERT
  always_ff @(posedge clk_i) begin
    if (rst_ni) begin
      assert (!(take && busy[INDEX_W'(free_slot)]));
      assert (free_q == ((pick_q & ~busy) != '0));
      assert (!FEEDBACK || commit_q == free_q);
      // Nobody speaks of a slot without a ray.
      assert (!(hit_valid_o && !busy[INDEX_W'(hit_o.slot)]));
      assert (!(interrupt_o.valid && !busy[INDEX_W'(interrupt_o.slot)]));
      for (int unsigned t = 0; t < TUS; t++) begin
        assert (!(inc_valid_i[t] && !busy[INDEX_W'(inc_slot_i[t])]));
        assert (!(inc_valid_i[t] && over[INDEX_W'(inc_slot_i[t])]));
        assert (!(done_valid_i[t] && !busy[INDEX_W'(done_slot_i[t])]));
        assert (!(done_valid_i[t] && over[INDEX_W'(done_slot_i[t])]));
      end
      for (int unsigned e = 0; e < EXPS + PES; e++) begin
        assert (!(drop_i[e][SLOT_W] && !busy[INDEX_W'(drop_i[e])]));
      end
    end
  end
`endif
endmodule
