// From rays that start to tasks that leave for the PEs: traversal units with the memory of blocks,
// expanders with the memory of cells. Unit t feeds expander t modulo EXPS.
module gridrt_walk #(
    parameter int unsigned B = 17,
    parameter int unsigned SLOTS = 64,
    parameter int unsigned TUS = 4,  // 1 to 4
    parameter int unsigned EXPS = 2,  // 1 or 2, at most TUS
    parameter int unsigned BLOCKS = 4096,
    parameter int unsigned CELLS = 6144,
    parameter bit CANCEL = 1'b1,
    localparam int unsigned SLOT_W = gridrt_pkg::SLOT_W,
    localparam int unsigned BLOCK_W = gridrt_pkg::BLOCK_W,
    localparam int unsigned TASK_W = gridrt_pkg::TASK_W,
    localparam int unsigned PE_W = gridrt_pkg::PE_W
) (
    input  logic                                                 clk_i,
    input  logic                                                 rst_ni,
    input  gridrt_pkg::load_t                                    load_i,
    input  gridrt_state_pkg::grid_t                              grid_i,
    input  gridrt_pkg::slot_event_t                              alloc_i,
    input  gridrt_pkg::interrupt_t                               interrupt_i,
    // A ray starts in the unit of its slot; the slot and what it starts from come a clock later.
    input  logic                    [  TUS-1:0]                  start_valid_i,
    output logic                    [  TUS-1:0]                  start_ready_o,
    input  gridrt_state_pkg::start_t                             start_i,
    // By slot: fewer than the tasks wanted ahead are pending; none is.
    input  logic                    [SLOTS-1:0]                  few_i,
    input  logic                    [SLOTS-1:0]                  none_i,
    // Steps: tasks to come, and the end of a traversal.
    output logic                    [  TUS-1:0]                  inc_valid_o,
    output logic                    [  TUS-1:0][     SLOT_W-1:0] inc_slot_o,
    output logic                    [  TUS-1:0][            3:0] inc_count_o,
    output logic                    [  TUS-1:0]                  done_valid_o,
    output logic                    [  TUS-1:0][     SLOT_W-1:0] done_slot_o,
    output logic                    [  TUS-1:0]                  step_o,
    // Tasks with the PEs that own their voxels; voxels that an earlier hit cancels.
    output logic                    [ EXPS-1:0]                  task_valid_o,
    input  logic                    [ EXPS-1:0]                  task_ready_i,
    output logic                    [ EXPS-1:0][     TASK_W-1:0] task_o,
    output logic                    [ EXPS-1:0][       PE_W-1:0] task_pe_o,
    output logic                    [ EXPS-1:0][       SLOT_W:0] drop_o,  // slot_event_t
    output logic                                                 tap_valid_o,
    output logic                    [BLOCK_W-1:0]                tap_block_o,
    output logic                    [        7:0]                tap_cand_o,
    output logic                    [        2:0]                tap_jump_o
);
  localparam int unsigned BUNDLE_W = gridrt_pkg::BUNDLE_W;
  localparam int unsigned CELL_W = gridrt_pkg::CELL_W;
  localparam int unsigned CELL_RECORD_W = PE_W + gridrt_pkg::LIST_W + gridrt_pkg::REF_W;
  localparam int unsigned COUNT = SLOTS / TUS;

  if (TUS < 1 || TUS > 4) begin : gen_illegal_units
    $error("gridrt_walk: TUS must be 1 to 4");
  end
  if (EXPS < 1 || EXPS > 2 || EXPS > TUS) begin : gen_illegal_expanders
    $error("gridrt_walk: EXPS must be 1 or 2 and at most TUS");
  end

  logic [TUS-1:0] block_enable, bundle_valid, bundle_ready, tap_valid;
  logic [TUS-1:0][BLOCK_W-1:0] block_address, tap_block;
  logic [TUS-1:0][21:0] block_data;
  logic [TUS-1:0][BUNDLE_W-1:0] bundle;
  logic [TUS-1:0][SLOT_W-1:0] tap_slot;
  logic [TUS-1:0][7:0] tap_cand;
  logic [TUS-1:0][2:0] tap_jump;

  gridrt_blocks #(
      .BLOCKS(BLOCKS),
      .TUS(TUS)
  ) u_blocks (
      .clk_i,
      .load_i,
      .enable_i(block_enable),
      .address_i(block_address),
      .data_o(block_data)
  );

  // Units begin a clock after the slot is taken: who gets a ray depends on much, far away.
  logic [TUS-1:0] starts, unit_ready;
  assign start_ready_o = unit_ready & ~starts;
  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) starts <= '0;
    else starts <= start_valid_i;
  end

  for (genvar t = 0; t < TUS; t++) begin : gen_unit
    logic [COUNT-1:0] few, none;
    for (genvar s = 0; s < COUNT; s++) begin : gen_slot
      assign few[s] = few_i[s*TUS+t];
      assign none[s] = none_i[s*TUS+t];
    end

    gridrt_traverse #(
        .B(B),
        .SLOTS(SLOTS),
        .TUS(TUS),
        .INDEX(t),
        .CANCEL(CANCEL)
    ) u_traverse (
        .clk_i,
        .rst_ni,
        .grid_i,
        .start_valid_i(starts[t]),
        .start_ready_o(unit_ready[t]),
        .start_slot_i(alloc_i.slot),
        .start_i,
        .few_i(few),
        .idle_i(none),
        .interrupt_i,
        .alloc_i,
        .block_enable_o(block_enable[t]),
        .block_address_o(block_address[t]),
        .block_data_i(block_data[t]),
        .bundle_valid_o(bundle_valid[t]),
        .bundle_ready_i(bundle_ready[t]),
        .bundle_o(bundle[t]),
        .inc_valid_o(inc_valid_o[t]),
        .inc_slot_o(inc_slot_o[t]),
        .inc_count_o(inc_count_o[t]),
        .done_valid_o(done_valid_o[t]),
        .done_slot_o(done_slot_o[t]),
        .step_o(step_o[t]),
        .tap_valid_o(tap_valid[t]),
        .tap_slot_o(tap_slot[t]),
        .tap_block_o(tap_block[t]),
        .tap_cand_o(tap_cand[t]),
        .tap_jump_o(tap_jump[t])
    );
  end

  gridrt_pkg::interrupt_t cancel;
  always_comb begin
    cancel = interrupt_i;
    cancel.valid = interrupt_i.valid && CANCEL;
  end

  logic [EXPS-1:0] cell_enable;
  logic [EXPS-1:0][CELL_W-1:0] cell_address;
  logic [EXPS-1:0][CELL_RECORD_W-1:0] cell_data;
  gridrt_cells #(
      .CELLS(CELLS),
      .EXPS (EXPS)
  ) u_cells (
      .clk_i,
      .load_i,
      .enable_i(cell_enable),
      .address_i(cell_address),
      .data_o(cell_data)
  );

  for (genvar e = 0; e < EXPS; e++) begin : gen_expander
    localparam int unsigned UNITS = (TUS - e + EXPS - 1) / EXPS;
    logic [UNITS-1:0] in_valid, in_ready;
    logic [UNITS*BUNDLE_W-1:0] in_bundle;  // flat: yosys loses the width of an array here
    for (genvar u = 0; u < UNITS; u++) begin : gen_source
      assign in_valid[u] = bundle_valid[u*EXPS+e];
      assign in_bundle[u*BUNDLE_W+:BUNDLE_W] = bundle[u*EXPS+e];
      assign bundle_ready[u*EXPS+e] = in_ready[u];
    end

    logic merged_valid, merged_ready, one_valid, one_ready;
    logic [BUNDLE_W-1:0] one;
    gridrt_merge #(
        .N(UNITS),
        .WIDTH(BUNDLE_W)
    ) u_merge (
        .clk_i,
        .rst_ni,
        .in_valid_i(in_valid),
        .in_ready_o(in_ready),
        .in_data_i(in_bundle),
        .out_valid_o(merged_valid),
        .out_ready_i(merged_ready),
        .out_data_o(one)
    );
    gridrt_stall #(
        .SEED(11 + e),
        .WIDTH(BUNDLE_W)
    ) u_stall (
        .clk_i,
        .rst_ni,
        .in_valid_i(merged_valid),
        .in_ready_o(merged_ready),
        .out_valid_o(one_valid),
        .out_ready_i(one_ready),
        .data_i(one)
    );

    gridrt_expand #(
        .SLOTS(SLOTS)
    ) u_expand (
        .clk_i,
        .rst_ni,
        .alloc_i,
        .interrupt_i(cancel),
        .bundle_valid_i(one_valid),
        .bundle_ready_o(one_ready),
        .bundle_i(one),
        .cell_enable_o(cell_enable[e]),
        .cell_address_o(cell_address[e]),
        .cell_i(cell_data[e]),
        .task_valid_o(task_valid_o[e]),
        .task_ready_i(task_ready_i[e]),
        .task_o(task_o[e]),
        .task_pe_o(task_pe_o[e]),
        .drop_o(drop_o[e])
    );
    gridrt_stream_check #(
        .WIDTH(TASK_W + PE_W)
    ) u_task_check (
        .clk_i,
        .rst_ni,
        .valid_i(task_valid_o[e]),
        .ready_i(task_ready_i[e]),
        .data_i ({task_o[e], task_pe_o[e]})
    );
  end

  // The tap is meant for one ray in flight, thus for one unit at a time.
  always_comb begin
    tap_valid_o = tap_valid != '0;
    tap_block_o = '0;
    tap_cand_o  = '0;
    tap_jump_o  = '0;
    for (int unsigned t = 0; t < TUS; t++) begin
      if (tap_valid[t]) begin
        tap_block_o = tap_block_o | tap_block[t];
        tap_cand_o  = tap_cand_o | tap_cand[t];
        tap_jump_o  = tap_jump_o | tap_jump[t];
      end
    end
  end

  logic unused;
  assign unused = &{1'b0, tap_slot};
endmodule
