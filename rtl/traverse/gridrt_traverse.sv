// Traversal unit: marches its rays through the blocks of the grid, one block of one ray a clock, and
// sends the voxels that they meet to an expander. Slot s belongs to the unit with INDEX = s % TUS.
//
// A step takes 10 clocks, so the slots take turns:
//   0 a slot is chosen, or a ray starts        7 neighbours met; position; entries
//   1 state and block memory are read          8 voxels met; position; the limit is asked
//   2 multiples of the increments              9 voxels leave; the slot may be chosen again
//   3 block record; first two samples; jump    10 address of the next block; state is written
//   4-6 two samples each; position ahead
// A step that begins has room for its voxels in the queue to the expander, so nothing stalls.
module gridrt_traverse #(
    parameter int unsigned B = 17,
    parameter int unsigned SLOTS = 64,
    parameter int unsigned TUS = 4,
    parameter int unsigned INDEX = 0,
    parameter bit CANCEL = 1'b1,  // 0: limits are ignored
    parameter int unsigned QUEUE = 16,  // bundles to the expander
    localparam int unsigned COUNT = SLOTS / TUS
) (
    input  logic                                              clk_i,
    input  logic                                              rst_ni,
    /* verilator lint_off UNUSEDSIGNAL */  // not all of a grid's constants are needed here
    input  gridrt_state_pkg::grid_t                           grid_i,
    /* verilator lint_on UNUSEDSIGNAL */
    input  logic                                              start_valid_i,
    output logic                                              start_ready_o,
    input  logic                    [gridrt_pkg::SLOT_W-1:0]  start_slot_i,
    input  gridrt_state_pkg::start_t                          start_i,
    input  logic                    [COUNT-1:0]               few_i,   // by slot / TUS
    input  logic                    [COUNT-1:0]               idle_i,
    input  gridrt_pkg::interrupt_t                            interrupt_i,
    input  gridrt_pkg::slot_event_t                           alloc_i,
    output logic                                              block_enable_o,
    output logic                    [gridrt_pkg::BLOCK_W-1:0] block_address_o,
    input  logic                    [21:0]                    block_data_i,  // two clocks later
    output logic                                              bundle_valid_o,
    input  logic                                              bundle_ready_i,
    output gridrt_pkg::bundle_t                               bundle_o,
    output logic                                              inc_valid_o,
    output logic                    [gridrt_pkg::SLOT_W-1:0]  inc_slot_o,
    output logic                    [3:0]                     inc_count_o,
    output logic                                              done_valid_o,
    output logic                    [gridrt_pkg::SLOT_W-1:0]  done_slot_o,
    output logic                                              step_o,
    output logic                                              tap_valid_o,
    output logic                    [gridrt_pkg::SLOT_W-1:0]  tap_slot_o,
    output logic                    [gridrt_pkg::BLOCK_W-1:0] tap_block_o,
    output logic                    [7:0]                     tap_cand_o,
    output logic                    [2:0]                     tap_jump_o
);
  localparam int unsigned SLOT_W = gridrt_pkg::SLOT_W;
  localparam int unsigned BLOCK_W = gridrt_pkg::BLOCK_W;
  localparam int unsigned DIST_W = gridrt_pkg::DIST_W;
  localparam int unsigned CELL_W = gridrt_pkg::CELL_W;
  localparam int unsigned EDGE_W = gridrt_state_pkg::EDGE_W;
  localparam int unsigned REST_W = gridrt_state_pkg::REST_W;
  localparam int unsigned INDEX_W = (COUNT > 1) ? $clog2(COUNT) : 1;

  if (TUS < 1 || TUS > 4 || INDEX >= TUS || SLOTS % TUS != 0 || SLOTS < TUS ||
      SLOTS > (1 << SLOT_W)) begin : gen_illegal
    $error("gridrt_traverse: SLOTS must be a multiple of TUS (1 to 4), at most 64; INDEX below TUS");
  end
  if (QUEUE < 1 || QUEUE > 64 || B > gridrt_pkg::MAX_B) begin : gen_illegal_queue
    $error("gridrt_traverse: QUEUE must be 1 to 64, B at most 17");
  end

  // Whether the slots of others are this unit's, and their places here.
  logic [2:0][SLOT_W-1:0] named;
  logic [2:0][TUS-1:0] units;
  logic [2:0][INDEX_W-1:0] places;
  assign named = {start_slot_i, alloc_i.slot, interrupt_i.slot};
  for (genvar i = 0; i < 3; i++) begin : gen_named
    gridrt_slot_unit #(.TUS(TUS), .SLOTS(SLOTS)) i_unit (
        .slot_i (named[i]),
        .unit_o (units[i]),
        .place_o(places[i])
    );
  end
  function automatic logic [SLOT_W-1:0] slot_of(logic [INDEX_W-1:0] index);
    slot_of = SLOT_W'(INDEX);
    for (int unsigned i = 0; i < TUS; i++) slot_of = slot_of + SLOT_W'(index);
  endfunction

  // 0: a ray that starts goes first; else the scheduler's choice.
  logic [10:1] valid, moves;
  assign moves = gridrt_pkg::FREE_RUNNING ? '1 : valid;
  logic may_issue, start, grant, again;
  logic [INDEX_W-1:0] grant_slot, waiting_slot;
  logic [10:1][INDEX_W-1:0] slot;
  // It waits in the register that it begins from.
  gridrt_state_pkg::start_t s1_start;
  logic s1_starts, waits;
  assign start_ready_o = !waits;
  assign start = waits && may_issue;
  gridrt_schedule #(
      .COUNT(COUNT)
  ) i_schedule (
      .clk_i,
      .rst_ni,
      .issue_i(may_issue && !waits),
      .few_i,
      .idle_i,
      .again_i(again),
      .again_slot_i(slot[9]),
      .grant_o(grant),
      .slot_o(grant_slot)
  );
  logic s10_writes;
  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      waits <= 1'b0;
      valid <= '0;
    end else begin
      waits <= waits ? !may_issue : start_valid_i;
      valid <= {valid[9:1], start || grant};
    end
  end
  always_ff @(posedge clk_i) begin
    s1_starts <= start;
    if (start_valid_i && !waits) begin
      s1_start <= start_i;
      waiting_slot <= places[2];
    end
    if (gridrt_pkg::FREE_RUNNING || start || grant) slot[1] <= waits ? waiting_slot : grant_slot;
    for (int unsigned i = 2; i <= 10; i++) begin
      if (moves[i-1]) slot[i] <= slot[i-1];
    end
  end

  // 1: state; the block looked at is the ray's block or a neighbour of it.
  gridrt_state_pkg::start_t s1_state, s2_state, s3_state, s4_state, s5_state, s6_state, s7_state, s8_state, s9_state, s10_state, s10_next;
  logic [1:0] s1_sub, s2_sub, s3_sub, s4_sub, s5_sub, s6_sub, s7_sub, s8_sub, s8_next_sub, s9_next_sub, s10_sub;
  logic [BLOCK_W-1:0] s1_look, s10_look;
  gridrt_march_states #(
      .COUNT(COUNT)
  ) i_states (
      .clk_i,
      .s1_slot_i(slot[1]),
      .s1_starts_i(s1_starts),
      .s1_start_i(s1_start),
      .s1_state_o(s1_state),
      .s1_sub_o(s1_sub),
      .s1_look_o(s1_look),
      .s10_writes_i(s10_writes),
      .s10_slot_i(slot[10]),
      .s10_state_i(s10_next),
      .s10_sub_i(s10_sub),
      .s10_look_i(s10_look)
  );
  assign block_enable_o = valid[1];
  assign block_address_o = s1_look;
  always_ff @(posedge clk_i) begin
    if (moves[1]) {s2_state, s2_sub} <= {s1_state, s1_sub};
    if (moves[2]) {s3_state, s3_sub} <= {s2_state, s2_sub};
    if (moves[3]) {s4_state, s4_sub} <= {s3_state, s3_sub};
    if (moves[4]) {s5_state, s5_sub} <= {s4_state, s4_sub};
    if (moves[5]) {s6_state, s6_sub} <= {s5_state, s5_sub};
    if (moves[6]) {s7_state, s7_sub} <= {s6_state, s6_sub};
    if (moves[7]) {s8_state, s8_sub} <= {s7_state, s7_sub};
    if (moves[8]) s9_state <= s8_state;
    if (moves[9]) s10_state <= s9_state;
  end

  // 2: constants in the order dominant axis, b, c.
  logic [2:0][EDGE_W-1:0] s2_edge;
  always_comb begin
    s2_edge = '0;
    for (int unsigned a = 0; a < 3; a++) begin
      if (s2_state.axis == 2'(a)) begin
        for (int unsigned k = 0; k < 3; k++) s2_edge[k] = grid_i.edges[(a+k)%3];
      end
    end
  end

  // 3: the block's record, and how many block-slabs are left behind if its slab is done with.
  logic s9_occupied;
  logic [20:0] s9_record;
  logic [2:0] s3_ahead, s8_jump, s9_jump;
  gridrt_march_record i_record (
      .clk_i,
      .valid_i(moves[8:3]),
      .s3_data_i(block_data_i),
      .s3_axis_i(s3_state.axis),
      .s3_neg_i(s3_state.neg),
      .s3_aside_i(s3_sub != 2'd0),
      .s3_ahead_o(s3_ahead),
      .s8_jump_o(s8_jump),
      .s9_jump_o(s9_jump),
      .s9_occupied_o(s9_occupied),
      .s9_record_o(s9_record)
  );

  logic [1:0][8:0][3:0] s7_sample;
  logic [1:0][REST_W-1:0] s9_rest;
  logic [1:0][5:0] s9_quarters_on;
  for (genvar n = 0; n < 2; n++) begin : gen_lateral
    gridrt_march_lateral i_lateral (
        .clk_i,
        .valid_i(moves[8:2]),
        .s2_quarter_i(s2_state.quarter[n]),
        .s2_low_i(s2_state.low[n]),
        .s2_limit_i(s2_state.limit[n]),
        .s2_rest_i(s2_state.rest[n]),
        .s2_slope_i(s2_state.slope[n]),
        .s2_edge_i(s2_edge[n+1]),
        .s3_ahead_i(s3_ahead),
        .s7_sample_o(s7_sample[n]),
        .s9_rest_o(s9_rest[n]),
        .s9_quarters_o(s9_quarters_on[n])
    );
  end

  // 5-8: distances, and whether there are as many block-slabs.
  logic [EDGE_W-1:0] s3_edge, s4_edge;  // of the dominant axis
  logic [2:0] s4_ahead, s5_ahead;
  always_ff @(posedge clk_i) begin
    if (moves[2]) s3_edge <= s2_edge[0];
    if (moves[3]) begin
      s4_edge <= s3_edge;
      s4_ahead <= s3_ahead;
    end
    if (moves[4]) s5_ahead <= s4_ahead;
  end
  logic [2:0] s7_ahead;
  logic [DIST_W:0] s8_enter;
  logic [DIST_W-1:0] s8_near_enter, s9_near_enter, s9_far_enter;
  logic s9_over;
  gridrt_march_way i_way (
      .clk_i,
      .valid_i(moves[8:4]),
      .s4_edge_i(s4_edge),
      .s5_ahead_i(s5_ahead),
      .s7_enter_i(s7_state.enter),
      .s7_slabs_i(s7_state.slabs),
      .s7_ahead_o(s7_ahead),
      .s8_enter_o(s8_enter),
      .s8_near_enter_o(s8_near_enter),
      .s9_near_enter_o(s9_near_enter),
      .s9_far_enter_o(s9_far_enter),
      .s9_over_o(s9_over)
  );

  // 7-8: voxels met, and the next neighbour to be looked at.
  logic [3:1] s8_touched;
  logic [7:0] s9_met;
  gridrt_pkg::way_t s9_way;
  logic s8_on, s9_on;  // on: to another block-slab
  gridrt_block_voxels i_voxels (
      .clk_i,
      .valid_i(moves[8:7]),
      .s7_axis_i(s7_state.axis),
      .s7_neg_i(s7_state.neg),
      .s7_first_i(s7_state.first),
      .s7_last_i((s7_state.slabs == '0) ? s7_state.last : 3'd7),
      .s7_sub_i(s7_sub),
      .s7_sample_i(s7_sample),
      .s8_touched_o(s8_touched),
      .s9_met_o(s9_met),
      .s9_way_o(s9_way)
  );
  always_comb begin
    s8_next_sub = 2'd0;
    if (s8_touched[3] && s8_sub < 2'd3) s8_next_sub = 2'd3;
    if (s8_touched[2] && s8_sub < 2'd2) s8_next_sub = 2'd2;
    if (s8_touched[1] && s8_sub < 2'd1) s8_next_sub = 2'd1;
    if (s8_jump != 3'd0) s8_next_sub = 2'd0;
    s8_on = s8_next_sub == 2'd0;
  end

  // 8: is all that follows beyond the best hit?
  logic [COUNT-1:0] limited;
  logic [DIST_W-1:0] s8_limit;
  logic s9_killed, s9_ends, mine;
  logic [DIST_W:0] s9_enter;
  assign mine = interrupt_i.valid && CANCEL && units[0][INDEX];
  gridrt_lutram #(
      .WIDTH(DIST_W),
      .DEPTH(COUNT)
  ) i_limits (
      .clk_i,
      .write_i(mine),
      .write_address_i(places[0]),
      .write_data_i(interrupt_i.limit),
      .read_address_i(slot[8]),
      .read_data_o(s8_limit)
  );
  logic [COUNT-1:0] limits, starts;
  gridrt_onehot #(.LINES(COUNT)) i_limits_it (
      .valid_i(mine),
      .index_i(places[0]),
      .line_o (limits)
  );
  gridrt_onehot #(.LINES(COUNT)) i_starts_it (
      .valid_i(alloc_i.valid && units[1][INDEX]),
      .index_i(places[1]),
      .line_o (starts)
  );
  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) limited <= '0;
    else limited <= (limited | limits) & ~starts;
  end
  always_ff @(posedge clk_i) begin
    if (moves[8]) begin
      s9_on <= s8_on;
      s9_next_sub <= s8_next_sub;
      s9_killed <= limited[slot[8]] && s8_near_enter > s8_limit;
      s9_ends <= limited[slot[8]] && (s8_enter[DIST_W] ? 1'b0 : s8_enter[DIST_W-1:0] > s8_limit);
      s9_enter <= s8_enter;
    end
  end

  // 9: out with the voxels.
  logic [7:0] cand;
  logic push, done;
  assign done = s9_killed || (s9_on && (s9_over || s9_ends));
  gridrt_march_out #(
      .QUEUE(QUEUE)
  ) i_out (
      .clk_i,
      .rst_ni,
      .issue_i(start || grant),
      .may_issue_o(may_issue),
      .s9_valid_i(valid[9]),
      .s9_open_i(s9_occupied && !s9_killed),
      .s9_slot_i(slot_of(slot[9])),
      .s9_axis_i(s9_state.axis),
      .s9_neg_i(s9_state.neg),
      .s9_base_i(s9_record[8+:CELL_W]),
      .s9_occ_i(s9_record[7:0]),
      .s9_met_i(s9_met),
      .s9_way_i(s9_way),
      .s9_near_enter_i(s9_near_enter),
      .s9_far_enter_i(s9_far_enter),
      .s9_cand_o(cand),
      .s9_push_o(push),
      .s9_count_o(inc_count_o),
      .bundle_valid_o,
      .bundle_ready_i,
      .bundle_o
  );
  assign again = valid[9] && !done;
  assign inc_valid_o = push;
  assign inc_slot_o = slot_of(slot[9]);
  assign done_valid_o = valid[9] && done;
  assign done_slot_o = slot_of(slot[9]);
  assign step_o = valid[9];

  // 6-10: the next block.
  logic s10_going;
  gridrt_march_next i_next (
      .clk_i,
      .valid_i(moves[9:5]),
      .stride_i(grid_i.stride[2:1]),
      .s5_axis_i(s5_state.axis),
      .s5_neg_i(s5_state.neg),
      .s7_ahead_i(s7_ahead),
      .s7_slabs_i(s7_state.slabs),
      .s9_on_i(s9_on),
      .s9_sub_i(s9_next_sub),
      .s9_quarter_i(s9_state.quarter),
      .s9_quarters_i(s9_quarters_on),
      .s9_rest_i(s9_rest),
      .s9_enter_i(s9_enter),
      .s10_state_i(s10_state),
      .s10_next_o(s10_next),
      .s10_sub_o(s10_sub),
      .s10_look_o(s10_look)
  );
  always_ff @(posedge clk_i) begin
    if (moves[9]) s10_going <= !done;
  end
  assign s10_writes = valid[10] && s10_going;

  // For --explain.
  logic [7:0][BLOCK_W-1:0] look;  // in clocks 2 to 9
  always_ff @(posedge clk_i) begin
    if (moves[1]) look[0] <= s1_look;
    for (int unsigned i = 1; i < 8; i++) begin
      if (moves[i+1]) look[i] <= look[i-1];
    end
  end
  assign tap_valid_o = valid[9];
  assign tap_slot_o = slot_of(slot[9]);
  assign tap_block_o = look[7];
  assign tap_cand_o = cand;
  assign tap_jump_o = s9_jump;

  logic unused;
  assign unused = &{1'b0, s9_state, units};

`ifdef GRIDRT_ASSERT
  always_ff @(posedge clk_i) begin
    if (rst_ni) begin
      assert (!done_valid_o || !again);
      if (start_valid_i) assert (units[2][INDEX] && slot_of(places[2]) == start_slot_i);
      if (start_valid_i) assert (32'(start_slot_i) < SLOTS);
    end
  end
`endif
endmodule
