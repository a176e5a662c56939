// Traversal unit: marches its rays through the blocks of the grid, one block of one ray a clock, and
// sends the voxels that they meet to an expander. Slot s belongs to the unit with INDEX = s % TUS.
//
// A step takes 8 clocks, so the slots take turns:
//   0 a slot is chosen, or a ray starts        4 last two samples; position ahead, half-voxels off
//   1 state and block memory are read          5 blocks and halves met; position; entries
//   2 multiples of the increments              6 voxels met; position; the limit is asked
//   3 block record; first two samples; jump    7 voxels leave; the slot may be chosen again
//                                              8 address of the next block; state is written
// A step that begins has room for its voxels in the queue to the expander, so nothing stalls.
module gridrt_traverse #(
    parameter int unsigned B = 17,
    parameter int unsigned SLOTS = 48,
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
  localparam int unsigned STATE_W = 192;  // of start_t
  localparam int unsigned INDEX_W = (COUNT > 1) ? $clog2(COUNT) : 1;

  if (TUS < 1 || TUS > 4 || INDEX >= TUS || SLOTS % TUS != 0 || SLOTS < TUS ||
      SLOTS > (1 << SLOT_W)) begin : gen_illegal
    $error("gridrt_traverse: SLOTS must be a multiple of TUS (1 to 4), at most 64; INDEX below TUS");
  end
  if (QUEUE < 1 || QUEUE > 64 || B > gridrt_pkg::MAX_B) begin : gen_illegal_queue
    $error("gridrt_traverse: QUEUE must be 1 to 64, B at most 17");
  end

  // A slot's place in this unit: slot / TUS (a third: times 43 / 128, right up to 127).
  function automatic logic [INDEX_W-1:0] place(logic [SLOT_W-1:0] slot);
    logic [SLOT_W+6:0] wide;
    wide = {7'b0, slot};
    place = INDEX_W'(32'(slot) / TUS);
    if (TUS == 3) place = INDEX_W'((wide + (wide << 1) + (wide << 3) + (wide << 5)) >> 7);
  endfunction
  function automatic logic [SLOT_W-1:0] slot_of(logic [INDEX_W-1:0] index);
    slot_of = SLOT_W'(INDEX);
    for (int unsigned i = 0; i < TUS; i++) slot_of = slot_of + SLOT_W'(index);
  endfunction

  // 0: a ray that starts goes first; else the scheduler's choice.
  logic [8:1] valid;
  logic may_issue, start, grant, again;
  logic [INDEX_W-1:0] grant_slot, s1_slot, s2_slot, s3_slot, s4_slot, s5_slot, s6_slot, s7_slot, s8_slot;
  gridrt_state_pkg::start_t s1_start;
  logic s1_starts;
  assign start_ready_o = may_issue;
  assign start = start_valid_i && start_ready_o;
  gridrt_schedule #(
      .COUNT(COUNT)
  ) i_schedule (
      .clk_i,
      .rst_ni,
      .issue_i(may_issue && !start_valid_i),
      .few_i,
      .idle_i,
      .again_i(again),
      .again_slot_i(s7_slot),
      .grant_o(grant),
      .slot_o(grant_slot)
  );
  logic s8_writes;
  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) valid <= '0;
    else valid <= {valid[7:1], start || grant};
  end
  always_ff @(posedge clk_i) begin
    s1_starts <= start;
    if (start) s1_start <= start_i;
    if (start || grant) s1_slot <= start ? place(start_slot_i) : grant_slot;
    if (valid[1]) s2_slot <= s1_slot;
    if (valid[2]) s3_slot <= s2_slot;
    if (valid[3]) s4_slot <= s3_slot;
    if (valid[4]) s5_slot <= s4_slot;
    if (valid[5]) s6_slot <= s5_slot;
    if (valid[6]) s7_slot <= s6_slot;
    if (valid[7]) s8_slot <= s7_slot;
  end

  // 1: state; the block looked at is the ray's block or a neighbour of it.
  gridrt_state_pkg::start_t s1_stored, s1_state, s2_state, s3_state, s4_state, s5_state, s6_state, s7_state, s8_state, s8_next;
  logic [1:0] s1_stored_sub, s1_sub, s2_sub, s3_sub, s4_sub, s5_sub, s6_sub, s6_next_sub, s7_next_sub, s8_sub;
  logic [BLOCK_W-1:0] s1_stored_look, s1_look, s8_look;
  gridrt_lutram #(
      .WIDTH(STATE_W + 2 + BLOCK_W),
      .DEPTH(COUNT)
  ) i_states (
      .clk_i,
      .write_i(s8_writes),
      .write_address_i(s8_slot),
      .write_data_i({s8_next, s8_sub, s8_look}),
      .read_address_i(s1_slot),
      .read_data_o({s1_stored, s1_stored_sub, s1_stored_look})
  );
  assign s1_state = s1_starts ? s1_start : s1_stored;
  assign s1_sub = s1_starts ? 2'd0 : s1_stored_sub;
  assign s1_look = s1_starts ? s1_start.block : s1_stored_look;
  assign block_enable_o = valid[1];
  assign block_address_o = s1_look;
  always_ff @(posedge clk_i) begin
    if (valid[1]) begin
      s2_state <= s1_state;
      s2_sub   <= s1_sub;
    end
    if (valid[2]) begin
      s3_state <= s2_state;
      s3_sub   <= s2_sub;
    end
    if (valid[3]) begin
      s4_state <= s3_state;
      s4_sub   <= s3_sub;
    end
    if (valid[4]) begin
      s5_state <= s4_state;
      s5_sub   <= s4_sub;
    end
    if (valid[5]) begin
      s6_state <= s5_state;
      s6_sub   <= s5_sub;
    end
    if (valid[6]) s7_state <= s6_state;
    if (valid[7]) s8_state <= s7_state;
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
  logic s7_occupied;
  logic [20:0] s7_record;
  logic [2:0] s3_ahead, s6_jump, s7_jump;
  gridrt_march_record i_record (
      .clk_i,
      .valid_i(valid[6:3]),
      .s3_data_i(block_data_i),
      .s3_axis_i(s3_state.axis),
      .s3_neg_i(s3_state.neg),
      .s3_aside_i(s3_sub != 2'd0),
      .s3_ahead_o(s3_ahead),
      .s6_jump_o(s6_jump),
      .s7_jump_o(s7_jump),
      .s7_occupied_o(s7_occupied),
      .s7_record_o(s7_record)
  );

  logic [1:0][4:0][2:0] s5_sample;
  logic [1:0][REST_W-1:0] s7_rest;
  logic [1:0][4:0] s7_halves_on;
  for (genvar n = 0; n < 2; n++) begin : gen_lateral
    gridrt_march_lateral i_lateral (
        .clk_i,
        .valid_i(valid[6:2]),
        .s2_half_i(s2_state.half[n]),
        .s2_low_i(s2_state.low[n]),
        .s2_limit_i(s2_state.limit[n]),
        .s2_rest_i(s2_state.rest[n]),
        .s2_slope_i(s2_state.slope[n]),
        .s2_edge_i(s2_edge[n+1]),
        .s3_ahead_i(s3_ahead),
        .s5_sample_o(s5_sample[n]),
        .s7_rest_o(s7_rest[n]),
        .s7_halves_o(s7_halves_on[n])
    );
  end

  // 3-6: distances, and whether there are as many block-slabs.
  logic [2:0] s5_ahead;
  logic [DIST_W:0] s6_enter;
  logic [DIST_W-1:0] s6_near_enter, s7_near_enter, s7_far_enter;
  logic s7_over;
  gridrt_march_way i_way (
      .clk_i,
      .valid_i(valid[6:2]),
      .s2_edge_i(s2_edge[0]),
      .s3_ahead_i(s3_ahead),
      .s5_enter_i(s5_state.enter),
      .s5_slabs_i(s5_state.slabs),
      .s5_ahead_o(s5_ahead),
      .s6_enter_o(s6_enter),
      .s6_near_enter_o(s6_near_enter),
      .s7_near_enter_o(s7_near_enter),
      .s7_far_enter_o(s7_far_enter),
      .s7_over_o(s7_over)
  );

  // 5-6: voxels met, and the next neighbour to be looked at.
  logic [3:1] s6_touched;
  logic [7:0] s7_met;
  gridrt_pkg::way_t s7_way;
  logic s6_on, s7_on;  // on: to another block-slab
  gridrt_block_voxels i_voxels (
      .clk_i,
      .valid_i(valid[6:5]),
      .s5_axis_i(s5_state.axis),
      .s5_neg_i(s5_state.neg),
      .s5_first_i(s5_state.first),
      .s5_last_i((s5_state.slabs == '0) ? s5_state.last : 2'd3),
      .s5_sub_i(s5_sub),
      .s5_sample_i(s5_sample),
      .s6_touched_o(s6_touched),
      .s7_met_o(s7_met),
      .s7_way_o(s7_way)
  );
  always_comb begin
    s6_next_sub = 2'd0;
    if (s6_touched[3] && s6_sub < 2'd3) s6_next_sub = 2'd3;
    if (s6_touched[2] && s6_sub < 2'd2) s6_next_sub = 2'd2;
    if (s6_touched[1] && s6_sub < 2'd1) s6_next_sub = 2'd1;
    if (s6_jump != 3'd0) s6_next_sub = 2'd0;
    s6_on = s6_next_sub == 2'd0;
  end

  // 6: is all that follows beyond the best hit?
  logic [COUNT-1:0] limited;
  logic [DIST_W-1:0] s6_limit;
  logic s7_killed, s7_ends, mine;
  logic [DIST_W:0] s7_enter;
  assign mine = interrupt_i.valid && CANCEL && slot_of(place(interrupt_i.slot)) == interrupt_i.slot;
  gridrt_lutram #(
      .WIDTH(DIST_W),
      .DEPTH(COUNT)
  ) i_limits (
      .clk_i,
      .write_i(mine),
      .write_address_i(place(interrupt_i.slot)),
      .write_data_i(interrupt_i.limit),
      .read_address_i(s6_slot),
      .read_data_o(s6_limit)
  );
  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      limited <= '0;
    end else begin
      if (mine) limited[place(interrupt_i.slot)] <= 1'b1;
      if (alloc_i.valid && slot_of(place(alloc_i.slot)) == alloc_i.slot) begin
        limited[place(alloc_i.slot)] <= 1'b0;
      end
    end
  end
  always_ff @(posedge clk_i) begin
    if (valid[6]) begin
      s7_on <= s6_on;
      s7_next_sub <= s6_next_sub;
      s7_killed <= limited[s6_slot] && s6_near_enter > s6_limit;
      s7_ends <= limited[s6_slot] && (s6_enter[DIST_W] ? 1'b0 : s6_enter[DIST_W-1:0] > s6_limit);
      s7_enter <= s6_enter;
    end
  end

  // 7: out with the voxels.
  logic [7:0] cand;
  logic push, done;
  assign done = s7_killed || (s7_on && (s7_over || s7_ends));
  gridrt_march_out #(
      .QUEUE(QUEUE)
  ) i_out (
      .clk_i,
      .rst_ni,
      .issue_i(start || grant),
      .may_issue_o(may_issue),
      .s7_valid_i(valid[7]),
      .s7_open_i(s7_occupied && !s7_killed),
      .s7_slot_i(slot_of(s7_slot)),
      .s7_axis_i(s7_state.axis),
      .s7_neg_i(s7_state.neg),
      .s7_base_i(s7_record[8+:CELL_W]),
      .s7_occ_i(s7_record[7:0]),
      .s7_met_i(s7_met),
      .s7_way_i(s7_way),
      .s7_near_enter_i(s7_near_enter),
      .s7_far_enter_i(s7_far_enter),
      .s7_cand_o(cand),
      .s7_push_o(push),
      .s7_count_o(inc_count_o),
      .bundle_valid_o,
      .bundle_ready_i,
      .bundle_o
  );
  assign again = valid[7] && !done;
  assign inc_valid_o = push;
  assign inc_slot_o = slot_of(s7_slot);
  assign done_valid_o = valid[7] && done;
  assign done_slot_o = slot_of(s7_slot);
  assign step_o = valid[7];

  // 4-8: the next block.
  logic s8_going;
  gridrt_march_next i_next (
      .clk_i,
      .valid_i(valid[7:3]),
      .stride_i(grid_i.stride[2:1]),
      .s3_axis_i(s3_state.axis),
      .s3_neg_i(s3_state.neg),
      .s5_ahead_i(s5_ahead),
      .s5_slabs_i(s5_state.slabs),
      .s7_on_i(s7_on),
      .s7_sub_i(s7_next_sub),
      .s7_half_i(s7_state.half),
      .s7_halves_i(s7_halves_on),
      .s7_rest_i(s7_rest),
      .s7_enter_i(s7_enter),
      .s8_state_i(s8_state),
      .s8_next_o(s8_next),
      .s8_sub_o(s8_sub),
      .s8_look_o(s8_look)
  );
  always_ff @(posedge clk_i) begin
    if (valid[7]) s8_going <= !done;
  end
  assign s8_writes = valid[8] && s8_going;

  // For --explain.
  logic [BLOCK_W-1:0] s2_look, s3_look, s4_look, s5_look, s6_look, s7_look;
  always_ff @(posedge clk_i) begin
    if (valid[1]) s2_look <= s1_look;
    if (valid[2]) s3_look <= s2_look;
    if (valid[3]) s4_look <= s3_look;
    if (valid[4]) s5_look <= s4_look;
    if (valid[5]) s6_look <= s5_look;
    if (valid[6]) s7_look <= s6_look;
  end
  assign tap_valid_o = valid[7];
  assign tap_slot_o = slot_of(s7_slot);
  assign tap_block_o = s7_look;
  assign tap_cand_o = cand;
  assign tap_jump_o = s7_jump;

  logic unused;
  assign unused = &{1'b0, s7_state};

`ifdef GRIDRT_ASSERT
  always_ff @(posedge clk_i) begin
    if (rst_ni) begin
      assert (!done_valid_o || !again);
      if (start) assert (slot_of(place(start_slot_i)) == start_slot_i);
      if (start) assert (32'(start_slot_i) < SLOTS);
    end
  end
`endif
endmodule
