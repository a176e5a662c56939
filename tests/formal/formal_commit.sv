// Feedback and reorder buffer between any traversal units and any PEs: one ray, whichever it is, is
// answered once, at its place in the order, after all its tasks, with the best hit of its own.
module formal_commit #(
    parameter int unsigned SLOTS = 2,
    parameter int unsigned TUS   = 1,
    parameter int unsigned PES   = 2,
    parameter int unsigned ROB   = 4,
    parameter int unsigned TASKS = 3,  // of a ray at a time
    parameter int unsigned SOON  = 0,  // clocks to an answer once the environment is fair; 0: any
    localparam int unsigned EXPS = TUS,
    localparam int unsigned ENTRY_W = $clog2(ROB),
    localparam int unsigned SLOT_W = gridrt_pkg::SLOT_W,
    localparam int unsigned ID_W = gridrt_pkg::ID_W,
    localparam int unsigned KEY_W = gridrt_pkg::Q_W + gridrt_pkg::ID_W,
    localparam int unsigned EVENT_W = gridrt_pkg::EVENT_W,
    localparam int unsigned END_W = gridrt_pkg::SLOT_EVENT_W
) (
    input logic                            clk_i,
    input logic                            ray_valid_i,
    input logic                            ray_miss_i,
    input logic                            mark_i,  // the ray that takes a slot now is watched
    input logic [TUS-1:0]                  start_ready_i,
    input logic [TUS-1:0]                  inc_valid_i,
    input logic [TUS-1:0][SLOT_W-1:0]      inc_slot_i,
    input logic [TUS-1:0][3:0]             inc_count_i,
    input logic [TUS-1:0]                  done_valid_i,
    input logic [TUS-1:0][SLOT_W-1:0]      done_slot_i,
    input logic [EXPS+PES-1:0][END_W-1:0]  drop_i,
    input logic [PES-1:0]                  event_valid_i,
    input logic [PES-1:0][EVENT_W-1:0]     event_i,
    input logic                            hit_ready_i,
    input logic                            fair_i  // from now on nobody stalls or makes tasks
);
  logic rst_n = 1'b0;
  always_ff @(posedge clk_i) rst_n <= 1'b1;

  logic ray_ready, room, commit, commit_hit, waited, compared, hit_valid, hit;
  gridrt_pkg::slot_event_t alloc;
  logic [TUS-1:0] start;
  logic [ENTRY_W-1:0] entry, commit_entry;
  logic [SLOTS-1:0] few, none, walks;
  logic [PES-1:0] event_ready;
  gridrt_pkg::interrupt_t interrupt;
  logic [ID_W-1:0] commit_id, id;
  gridrt_pkg::event_t now_compared;
  gridrt_feedback #(
      .SLOTS(SLOTS),
      .TUS(TUS),
      .EXPS(EXPS),
      .PES(PES),
      .AHEAD(2),
      .ROB(ROB)
  ) feedback (
      .clk_i,
      .rst_ni(rst_n),
      .ray_valid_i,
      .ray_ready_o(ray_ready),
      .ray_miss_i,
      .alloc_o(alloc),
      .start_o(start),
      .start_ready_i,
      .room_i(room),
      .entry_i(entry),
      .inc_valid_i,
      .inc_slot_i,
      .inc_count_i,
      .done_valid_i,
      .done_slot_i,
      .few_o(few),
      .none_o(none),
      .walking_o(walks),
      .drop_i,
      .event_valid_i,
      .event_ready_o(event_ready),
      .event_i,
      .interrupt_o(interrupt),
      .commit_o(commit),
      .commit_entry_o(commit_entry),
      .commit_hit_o(commit_hit),
      .commit_id_o(commit_id),
      .wait_o(waited),
      .hit_o(now_compared),
      .hit_valid_o(compared)
  );
  gridrt_rob #(
      .ROB(ROB)
  ) rob (
      .clk_i,
      .rst_ni(rst_n),
      .room_o(room),
      .entry_o(entry),
      .reserve_i(alloc.valid),
      .write_i(commit),
      .write_entry_i(commit_entry),
      .write_hit_i(commit_hit),
      .write_id_i(commit_id),
      .hit_valid_o(hit_valid),
      .hit_ready_i,
      .hit_o(hit),
      .id_o(id)
  );

  // What the environment owes, by slot: a traversal that is not over, tasks that have not ended.
  logic [SLOTS-1:0] walking, done;
  logic [SLOTS-1:0][3:0] left, made, offers, ended;
  gridrt_pkg::event_t one;
  gridrt_pkg::slot_event_t dropped;
  always_comb begin
    one = '0;
    dropped = '0;
    for (int unsigned s = 0; s < SLOTS; s++) begin
      {made[s], offers[s], ended[s], done[s]} = '0;
      for (int unsigned t = 0; t < TUS; t++) begin
        if (inc_valid_i[t] && inc_slot_i[t] == SLOT_W'(s)) made[s] = inc_count_i[t];
        if (done_valid_i[t] && done_slot_i[t] == SLOT_W'(s)) done[s] = 1'b1;
      end
      for (int unsigned d = 0; d < EXPS + PES; d++) begin
        dropped = drop_i[d];
        if (dropped.valid && dropped.slot == SLOT_W'(s)) begin
          offers[s] = offers[s] + 4'd1;
          ended[s]  = ended[s] + 4'd1;
        end
      end
      for (int unsigned p = 0; p < PES; p++) begin
        one = event_i[p];
        if (event_valid_i[p] && one.slot == SLOT_W'(s)) begin
          offers[s] = offers[s] + 4'd1;
          if (one.last && event_ready[p]) ended[s] = ended[s] + 4'd1;
        end
      end
    end
  end

  gridrt_pkg::event_t offer;
  gridrt_pkg::slot_event_t gone;
  logic ray_held, ray_miss, was_fair;
  logic [PES-1:0] event_held;
  logic [PES-1:0][EVENT_W-1:0] event_was;
  always_ff @(posedge clk_i) begin
    if (!rst_n) begin
      walking <= '0;
      left <= '0;
      ray_held <= 1'b0;
      event_held <= '0;
      was_fair <= 1'b0;
    end else begin
      if (ray_held) assume (ray_valid_i && ray_miss_i == ray_miss);
      ray_held <= ray_valid_i && !ray_ready;
      ray_miss <= ray_miss_i;
      for (int unsigned t = 0; t < TUS; t++) begin
        // A slot belongs to one unit; a step makes tasks before or when it says that it is done.
        assume (!inc_valid_i[t] || (32'(inc_slot_i[t]) % TUS == t && 32'(inc_slot_i[t]) < SLOTS));
        assume (!done_valid_i[t] || 32'(done_slot_i[t]) % TUS == t);
        assume (!done_valid_i[t] || 32'(done_slot_i[t]) < SLOTS);
        assume (!inc_valid_i[t] || inc_count_i[t] != '0);
      end
      for (int unsigned d = 0; d < EXPS + PES; d++) begin
        gone = drop_i[d];
        assume (!gone.valid || 32'(gone.slot) < SLOTS);
      end
      for (int unsigned p = 0; p < PES; p++) begin
        offer = event_i[p];
        assume (!event_valid_i[p] || (32'(offer.slot) < SLOTS && (offer.hit || offer.last)));
        if (event_held[p]) assume (event_valid_i[p] && event_i[p] == event_was[p]);
        else if (was_fair) assume (!event_valid_i[p] || offer.last);
        event_was[p] <= event_i[p];
      end
      event_held <= event_valid_i & ~event_ready;
      for (int unsigned s = 0; s < SLOTS; s++) begin
        assume (made[s] <= 4'd8 && left[s] + made[s] <= 4'(TASKS));
        assume (walking[s] || (made[s] == '0 && !done[s]));
        // Each event and each drop is of a task of its own, which was made in an earlier clock.
        assume (offers[s] <= left[s]);
        left[s] <= left[s] + made[s] - ended[s];
        if (done[s]) walking[s] <= 1'b0;
        if (alloc.valid && alloc.slot == SLOT_W'(s)) begin
          walking[s] <= !ray_miss_i;
          // A slot is given again only when its ray is over.
          assert (!walking[s] && left[s] == '0);
        end
        assert (walks[s] == walking[s]);
        if (SOON != 0 && was_fair) begin
          assume (made[s] == '0);
          assume (left[s] == '0 || offers[s] != '0);
        end
      end
      if (SOON != 0 && was_fair) begin
        assume (fair_i && hit_ready_i && start_ready_i == '1);
        for (int unsigned t = 0; t < TUS; t++) begin
          for (int unsigned s = t; s < SLOTS; s += TUS) assume (!walking[s] || done_valid_i[t]);
        end
      end
      was_fair <= fair_i;
    end
  end

  // The watched ray.
  gridrt_pkg::event_t found;
  logic marked, live, in_flight, has, leaves, again;
  logic [SLOT_W-1:0] own;
  logic [KEY_W-1:0] key;
  logic [ENTRY_W+1:0] inside, ahead;
  logic [5:0] clocks, waits;
  logic own_over;
  assign leaves = hit_valid && hit_ready_i;
  always_comb begin
    own_over = 1'b1;
    for (int unsigned s = 0; s < SLOTS; s++) begin
      if (own == SLOT_W'(s)) own_over = !walking[s] && left[s] == '0;
    end
  end
  always_ff @(posedge clk_i) begin
    if (!rst_n) begin
      marked <= 1'b0;
      live <= 1'b0;
      in_flight <= 1'b0;
      has <= 1'b0;
      again <= 1'b0;
      inside <= '0;
      clocks <= '0;
      waits <= '0;
    end else begin
      assume (!mark_i || (alloc.valid && !marked));
      inside <= inside + (ENTRY_W + 2)'(alloc.valid) - (ENTRY_W + 2)'(leaves);
      if (live && alloc.valid && alloc.slot == own) begin  // for the next ray
        live  <= 1'b0;
        again <= 1'b1;
      end
      for (int unsigned p = 0; p < PES; p++) begin
        found = event_i[p];
        if (event_valid_i[p] && event_ready[p] && live && found.slot == own && found.hit) begin
          has <= 1'b1;
          if (!has || {found.quotient, found.id} < key) key <= {found.quotient, found.id};
        end
      end
      if (in_flight && leaves) begin
        ahead <= ahead - 1'b1;
        if (ahead == '0) in_flight <= 1'b0;
      end
      if (mark_i) begin
        marked <= 1'b1;
        live <= 1'b1;
        in_flight <= 1'b1;
        own <= alloc.slot;
        ahead <= inside - (ENTRY_W + 2)'(leaves);
      end
      clocks <= (was_fair && in_flight) ? clocks + 6'd1 : '0;
      waits  <= (was_fair && ray_valid_i && !ray_ready) ? waits + 6'd1 : '0;

      assert (!hit_valid || inside != '0);
      assert (!alloc.valid || !interrupt.valid);  // blocks write one limit a clock
      if (in_flight && hit_valid && ahead == '0) begin
        assert (!live || own_over);
        assert (hit == has);
        assert (id == (has ? key[ID_W-1:0] : gridrt_pkg::NO_ID));
      end
      if (SOON != 0) begin
        assert (32'(clocks) < SOON);
        assert (32'(waits) < SOON);
      end
      cover (in_flight && hit_valid && ahead == '0 && has && key == KEY_W'(1) && again);
      cover (inside == (ENTRY_W + 2)'(ROB + 1));
    end
  end
endmodule
