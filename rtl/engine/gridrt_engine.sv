// The ray tracing engine: rays in, answers out in the same order, an image in its memories.
//
//   rays -> setup -> slots -> traversal units -> expanders -> dispatch -> PEs -> feedback -> reorder
//                                 ^                 ^                      ^         |       buffer
//                                 +-----------------+------ interrupts ----+---------+
//
// Images are loaded and grids configured only while no ray is in flight.
module gridrt_engine #(
    parameter int unsigned B = 17,  // lattice bits, 4 to 17
    parameter int unsigned PES = 4,  // 1, 2 or 4
    parameter int unsigned TUS = 3,  // traversal units, 1 to 4
    parameter int unsigned SLOTS = 63,  // rays in traversal, a multiple of TUS, at most 64
    parameter int unsigned ROB = 256,  // answers that wait for their turn, a power of two
    parameter int unsigned QUEUE = 16,  // tasks that wait between an expander and a PE
    parameter int unsigned AHEAD = 2,  // tasks of a ray in advance: no step with so many pending
    parameter int unsigned BLOCKS = 4096,  // memory sizes, records; the last three for each PE
    parameter int unsigned CELLS = 6144,
    parameter int unsigned REFS = 8192,
    parameter int unsigned TRIS = 4096,
    parameter int unsigned VERTS = 2560,
    parameter int unsigned DIVIDERS = 2,  // of a PE
    parameter bit MASK = 1'b1,  // 0: quarters are ignored
    parameter bit CANCEL = 1'b1,  // 0: hits cancel nothing
    parameter bit FEEDBACK = 1'b1  // 0: the first hit is the answer (a wrong machine, for a test)
) (
    input  logic                                                  clk_i,
    input  logic                                                  rst_ni,
    input  gridrt_pkg::load_t                                     load_i,
    // A pulse of config_i takes the grid's constants, which are held until config_done_o.
    input  logic                                                  config_i,
    input  logic                 [2:0][gridrt_pkg::AXIS_W-1:0]    grid_count_i,
    input  logic                 [2:0][gridrt_state_pkg::EDGE_W-1:0] grid_edge_i,
    output logic                                                  config_done_o,
    input  logic                                                  ray_valid_i,
    output logic                                                  ray_ready_o,
    input  logic                 [2:0][B-1:0]                     ray_p0_i,
    input  logic                 [2:0][B-1:0]                     ray_p1_i,
    input  logic                 [gridrt_pkg::ID_W-1:0]           ray_ignore_i,
    input  logic                                                  ray_any_i,
    output logic                                                  hit_valid_o,
    input  logic                                                  hit_ready_i,
    output logic                                                  hit_o,
    output logic                 [gridrt_pkg::ID_W-1:0]           hit_id_o,  // all ones: no hit
    output gridrt_pkg::counts_t                                   counts_o,
    output gridrt_pkg::tap_t                                      tap_o
);
  localparam int unsigned EXPS = (TUS < 2) ? 1 : 2;
  localparam int unsigned SLOT_W = gridrt_pkg::SLOT_W;
  localparam int unsigned ID_W = gridrt_pkg::ID_W;
  localparam int unsigned PE_W = gridrt_pkg::PE_W;
  localparam int unsigned TRI_W = gridrt_pkg::TRI_W;
  localparam int unsigned TASK_W = gridrt_pkg::TASK_W;
  localparam int unsigned EVENT_W = gridrt_pkg::EVENT_W;
  localparam int unsigned ENTRY_W = $clog2(ROB);
  localparam int unsigned START_W = gridrt_state_pkg::START_W;

  // Setup.
  gridrt_pkg::load_t load;
  gridrt_pkg::slot_event_t alloc, alloc_q;
  gridrt_pkg::interrupt_t interrupt, interrupt_q;
  gridrt_state_pkg::grid_t grid;
  gridrt_state_pkg::start_t set_start, start;
  logic ray_valid, ray_ready, set_valid, set_ready, set_miss, set_any;
  logic one_valid, one_ready, taken_valid, taken_ready, start_miss, start_any;
  logic [2:0][B-1:0] set_p0, start_p0;
  logic [2:0][B:0] set_d, start_d;
  logic [B-1:0] set_length, start_length;
  logic [ID_W-1:0] set_ignore, start_ignore;

  gridrt_grid_config u_config (
      .clk_i,
      .rst_ni,
      .start_i(config_i),
      .count_i(grid_count_i),
      .edge_i (grid_edge_i),
      .done_o (config_done_o),
      .grid_o (grid)
  );
  gridrt_stall #(
      .SEED(1),
      .WIDTH(6 * B + ID_W + 1)
  ) u_ray_stall (
      .clk_i,
      .rst_ni,
      .in_valid_i (ray_valid_i),
      .in_ready_o (ray_ready_o),
      .out_valid_o(ray_valid),
      .out_ready_i(ray_ready),
      .data_i({ray_p0_i, ray_p1_i, ray_ignore_i, ray_any_i})
  );
  gridrt_setup #(
      .B(B)
  ) u_setup (
      .clk_i,
      .rst_ni,
      .grid_i(grid),
      .ray_valid_i(ray_valid),
      .ray_ready_o(ray_ready),
      .p0_i(ray_p0_i),
      .p1_i(ray_p1_i),
      .ignore_i(ray_ignore_i),
      .any_hit_i(ray_any_i),
      .out_valid_o(set_valid),
      .out_ready_i(set_ready),
      .start_o(set_start),
      .p0_o(set_p0),
      .d_o(set_d),
      .length_o(set_length),
      .ignore_o(set_ignore),
      .any_hit_o(set_any),
      .miss_o(set_miss)
  );
  gridrt_stall #(
      .SEED(2),
      .WIDTH(6 * B + ID_W + 5)
  ) u_start_stall (
      .clk_i,
      .rst_ni,
      .in_valid_i (set_valid),
      .in_ready_o (set_ready),
      .out_valid_o(one_valid),
      .out_ready_i(one_ready),
      .data_i({set_p0, set_d, set_ignore, set_any, set_miss})
  );

  // The ray that gets a slot next, held a clock longer: PEs and units learn late of slots and limits.
  gridrt_hold #(
      .WIDTH(START_W + 7 * B + ID_W + 5)
  ) u_start (
      .clk_i,
      .rst_ni,
      .in_valid_i (one_valid),
      .in_ready_o (one_ready),
      .in_data_i  ({set_start, set_p0, set_d, set_length, set_ignore, set_any, set_miss}),
      .out_valid_o(taken_valid),
      .out_ready_i(taken_ready),
      .out_data_o ({start, start_p0, start_d, start_length, start_ignore, start_any, start_miss})
  );
  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      load <= '0;
      alloc_q <= '0;
      interrupt_q <= '0;
    end else begin
      load <= load_i;
      alloc_q <= alloc;
      interrupt_q <= interrupt;
    end
  end

  // Answers.
  gridrt_pkg::event_t best;
  logic [TUS-1:0] start_valid, start_ready, inc_valid, done_valid, step;
  logic [TUS-1:0][SLOT_W-1:0] inc_slot, done_slot;
  logic [TUS-1:0][3:0] inc_count;
  logic [SLOTS-1:0] few, none, walking;
  logic [EXPS-1:0][SLOT_W:0] expand_drop;
  logic [PES-1:0][SLOT_W:0] pe_drop;
  logic [PES-1:0] event_valid, event_ready;
  logic [PES-1:0][EVENT_W-1:0] found;
  logic rob_room, commit, commit_hit, waits, best_valid, answer_valid, answer_ready;
  logic [ENTRY_W-1:0] rob_entry, commit_entry;
  logic [ID_W-1:0] commit_id;

  gridrt_feedback #(
      .SLOTS(SLOTS),
      .TUS(TUS),
      .EXPS(EXPS),
      .PES(PES),
      .AHEAD(AHEAD),
      .ROB(ROB),
      .FEEDBACK(FEEDBACK)
  ) u_feedback (
      .clk_i,
      .rst_ni,
      .ray_valid_i(taken_valid),
      .ray_ready_o(taken_ready),
      .ray_miss_i(start_miss),
      .alloc_o(alloc),
      .start_o(start_valid),
      .start_ready_i(start_ready),
      .room_i(rob_room),
      .entry_i(rob_entry),
      .inc_valid_i(inc_valid),
      .inc_slot_i(inc_slot),
      .inc_count_i(inc_count),
      .done_valid_i(done_valid),
      .done_slot_i(done_slot),
      .few_o(few),
      .none_o(none),
      .walking_o(walking),
      .drop_i({pe_drop, expand_drop}),
      .event_valid_i(event_valid),
      .event_ready_o(event_ready),
      .event_i(found),
      .interrupt_o(interrupt),
      .commit_o(commit),
      .commit_entry_o(commit_entry),
      .commit_hit_o(commit_hit),
      .commit_id_o(commit_id),
      .wait_o(waits),
      .hit_o(best),
      .hit_valid_o(best_valid)
  );
  gridrt_rob #(
      .ROB(ROB)
  ) u_rob (
      .clk_i,
      .rst_ni,
      .room_o(rob_room),
      .entry_o(rob_entry),
      .reserve_i(alloc.valid),
      .write_i(commit),
      .write_entry_i(commit_entry),
      .write_hit_i(commit_hit),
      .write_id_i(commit_id),
      .hit_valid_o(answer_valid),
      .hit_ready_i(answer_ready),
      .hit_o,
      .id_o(hit_id_o)
  );
  gridrt_stall #(
      .SEED(3),
      .WIDTH(ID_W + 1)
  ) u_hit_stall (
      .clk_i,
      .rst_ni,
      .in_valid_i (answer_valid),
      .in_ready_o (answer_ready),
      .out_valid_o(hit_valid_o),
      .out_ready_i(hit_ready_i),
      .data_i({hit_o, hit_id_o})
  );

  // Tasks.
  logic tap_step;
  logic [gridrt_pkg::BLOCK_W-1:0] tap_block;
  logic [7:0] tap_cand;
  logic [2:0] tap_jump;
  logic [EXPS-1:0] made_valid, made_ready;
  logic [EXPS-1:0][TASK_W-1:0] made;
  logic [EXPS-1:0][PE_W-1:0] made_pe;
  logic [PES-1:0] task_valid, task_ready;
  logic [PES-1:0][TASK_W-1:0] tasks;

  gridrt_walk #(
      .B(B),
      .SLOTS(SLOTS),
      .TUS(TUS),
      .EXPS(EXPS),
      .BLOCKS(BLOCKS),
      .CELLS(CELLS),
      .CANCEL(CANCEL)
  ) u_walk (
      .clk_i,
      .rst_ni,
      .load_i(load),
      .grid_i(grid),
      .alloc_i(alloc_q),
      .interrupt_i(interrupt_q),
      .start_valid_i(start_valid),
      .start_ready_o(start_ready),
      .start_i(start),
      .few_i(few),
      .none_i(none),
      .inc_valid_o(inc_valid),
      .inc_slot_o(inc_slot),
      .inc_count_o(inc_count),
      .done_valid_o(done_valid),
      .done_slot_o(done_slot),
      .step_o(step),
      .task_valid_o(made_valid),
      .task_ready_i(made_ready),
      .task_o(made),
      .task_pe_o(made_pe),
      .drop_o(expand_drop),
      .tap_valid_o(tap_step),
      .tap_block_o(tap_block),
      .tap_cand_o(tap_cand),
      .tap_jump_o(tap_jump)
  );
  gridrt_dispatch #(
      .EXPS(EXPS),
      .PES(PES),
      .DEPTH(QUEUE)
  ) u_dispatch (
      .clk_i,
      .rst_ni,
      .in_valid_i(made_valid),
      .in_ready_o(made_ready),
      .in_task_i(made),
      .in_pe_i(made_pe),
      .out_valid_o(task_valid),
      .out_ready_i(task_ready),
      .out_task_o(tasks)
  );

  // PEs.
  logic [PES-1:0] drop_cancelled, test, busy, divider_wait, tested, test_hit;
  logic [PES-1:0][3:0] masked;
  logic [PES-1:0][TRI_W-1:0] tested_triangle;
  gridrt_pes #(
      .B(B),
      .PES(PES),
      .SLOTS(SLOTS),
      .REFS(REFS),
      .TRIS(TRIS),
      .VERTS(VERTS),
      .MASK(MASK),
      .CANCEL(CANCEL),
      .DIVIDERS(DIVIDERS)
  ) u_pes (
      .clk_i,
      .rst_ni,
      .load_i(load),
      .alloc_i(alloc_q),
      .ray_p0_i(start_p0),
      .ray_d_i(start_d),
      .ray_length_i(start_length),
      .ray_ignore_i(start_ignore),
      .ray_any_i(start_any),
      .interrupt_i(interrupt_q),
      .task_valid_i(task_valid),
      .task_ready_o(task_ready),
      .task_i(tasks),
      .event_valid_o(event_valid),
      .event_ready_i(event_ready),
      .event_o(found),
      .drop_o(pe_drop),
      .drop_cancelled_o(drop_cancelled),
      .test_o(test),
      .masked_o(masked),
      .busy_o(busy),
      .divider_wait_o(divider_wait),
      .tap_test_valid_o(tested),
      .tap_test_triangle_o(tested_triangle),
      .tap_test_hit_o(test_hit)
  );

  // What is counted, and told.
  logic [EXPS-1:0] dropped;
  for (genvar e = 0; e < EXPS; e++) begin : gen_dropped
    assign dropped[e] = expand_drop[e][SLOT_W];
  end
  gridrt_counts #(
      .SLOTS(SLOTS),
      .TUS(TUS),
      .EXPS(EXPS),
      .PES(PES)
  ) u_counts (
      .clk_i,
      .rst_ni,
      .ray_valid_i,
      .ray_ready_i(ray_ready_o),
      .start_valid_i(taken_valid),
      .start_ready_i(taken_ready),
      .hit_valid_i(hit_valid_o),
      .hit_ready_i,
      .commit_i(commit),
      .wait_i(waits),
      .step_i(step),
      .walking_i(walking),
      .few_i(few),
      .expand_drop_i(dropped),
      .test_i(test),
      .masked_i(masked),
      .cancelled_i(drop_cancelled),
      .queue_full_i(task_valid & ~task_ready),
      .pe_busy_i(busy),
      .divider_wait_i(divider_wait),
      .counts_o
  );
  gridrt_tap #(
      .EXPS(EXPS),
      .PES (PES)
  ) u_tap (
      .step_valid_i(tap_step),
      .step_block_i(tap_block),
      .step_cand_i(tap_cand),
      .step_jump_i(tap_jump),
      .task_valid_i(made_valid & made_ready),
      .task_i(made),
      .task_pe_i(made_pe),
      .expand_drop_i(dropped),
      .test_valid_i(tested),
      .test_triangle_i(tested_triangle),
      .test_hit_i(test_hit),
      .drop_i(pe_drop),
      .drop_cancelled_i(drop_cancelled),
      .hit_valid_i(best_valid),
      .hit_i(best),
      .interrupt_i(interrupt),
      .commit_i(commit),
      .commit_hit_i(commit_hit),
      .commit_id_i(commit_id),
      .tap_o
  );
endmodule
