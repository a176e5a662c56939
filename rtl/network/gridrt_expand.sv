// Turns the voxels of a block into tasks, one a clock: finds the voxel's cell record, drops voxels
// behind the ray's limit, and sends the others to the PE that owns them. Voxels of the near slab
// come first.
module gridrt_expand #(
    parameter int unsigned SLOTS = 64,
    parameter int unsigned DEPTH = 8,  // tasks on their way or waiting to leave
    localparam int unsigned SLOT_W = gridrt_pkg::SLOT_W,
    localparam int unsigned CELL_W = gridrt_pkg::CELL_W,
    localparam int unsigned DIST_W = gridrt_pkg::DIST_W,
    localparam int unsigned REF_W = gridrt_pkg::REF_W,
    localparam int unsigned LIST_W = gridrt_pkg::LIST_W,
    localparam int unsigned PE_W = gridrt_pkg::PE_W
) (
    input  logic                                      clk_i,
    input  logic                                      rst_ni,
    input  gridrt_pkg::slot_event_t                   alloc_i,
    input  gridrt_pkg::interrupt_t                    interrupt_i,
    input  logic                                      bundle_valid_i,
    output logic                                      bundle_ready_o,
    input  gridrt_pkg::bundle_t                       bundle_i,
    // Cell memory: {pe, count, first} comes two clocks after the address.
    output logic                                      cell_enable_o,
    output logic                    [CELL_W-1:0]      cell_address_o,
    input  logic                    [PE_W+LIST_W+REF_W-1:0] cell_i,
    output logic                                      task_valid_o,
    input  logic                                      task_ready_i,
    output gridrt_pkg::task_t                         task_o,
    output logic                    [PE_W-1:0]        task_pe_o,
    output gridrt_pkg::slot_event_t                   drop_o  // a voxel that an earlier hit has cancelled
);
  localparam int unsigned TASK_W = gridrt_pkg::TASK_W;
  localparam int unsigned CELLS_W = gridrt_pkg::CELLS_W;
  localparam int unsigned USED_W = $clog2(DEPTH + 1);

  if (DEPTH < 5) begin : gen_illegal
    $error("gridrt_expand: DEPTH below 5 cannot hold a task for each clock of the way");
  end

  // Choosing: the next voxel of the present bundle.
  gridrt_pkg::bundle_t now;
  logic now_valid, go, final_voxel;
  logic [7:0] left, near, from, voxel, below;
  logic [2:0] rank;
  logic [USED_W-1:0] used;  // voxels chosen and neither dropped nor gone

  always_comb begin
    near = left & now.front;
    from = (near != '0) ? near : left;
    voxel = from & (~from + 8'd1);
    below = now.occ & (voxel - 8'd1);
    rank = '0;
    for (int unsigned v = 0; v < 8; v++) begin
      if (below[v]) rank = rank + 3'd1;
    end
  end
  assign go = now_valid && used != USED_W'(DEPTH);
  assign final_voxel = (left & (left - 8'd1)) == '0;
  assign bundle_ready_o = !now_valid || (go && final_voxel);

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      now_valid <= 1'b0;
      now <= '0;
      left <= '0;
    end else if (bundle_ready_o) begin
      now_valid <= bundle_valid_i;
      if (bundle_valid_i) begin
        now  <= bundle_i;
        left <= bundle_i.cand;
      end
    end else if (go) begin
      left <= left & ~voxel;
    end
  end

  // Asking: the cell is read; the limit decides a clock later whether for nothing; where the ray is
  // within the voxel.
  logic ask_valid, drop;
  logic [SLOT_W-1:0] ask_slot;
  logic [CELL_W-1:0] ask_base;
  logic [2:0] ask_rank;
  logic [2:0] ask_voxel;  // x, y, z
  gridrt_pkg::way_t ask_way;
  logic [CELLS_W-1:0] ask_cells;
  logic [DIST_W-1:0] ask_enter, limit;

  gridrt_limits #(
      .SLOTS(SLOTS)
  ) u_limits (
      .clk_i,
      .rst_ni,
      .alloc_i,
      .interrupt_i,
      .slot_i (ask_slot),
      .limit_o(limit)
  );

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) ask_valid <= 1'b0;
    else ask_valid <= go;
  end
  always_ff @(posedge clk_i) begin
    if (go) begin
      ask_slot   <= now.slot;
      ask_base   <= now.base;
      ask_rank   <= rank;
      ask_voxel  <= {(voxel & 8'hF0) != '0, (voxel & 8'hCC) != '0, (voxel & 8'hAA) != '0};
      ask_way    <= now.way;
      ask_enter  <= ((voxel & now.front) != '0) ? now.near_enter : now.far_enter;
    end
  end
  gridrt_ray_cells u_ray_cells (
      .way_i(ask_way),
      .voxel_i(ask_voxel),
      .cells_o(ask_cells)
  );
  assign drop = ask_valid && ask_enter > limit;
  assign cell_enable_o = ask_valid;
  assign cell_address_o = ask_base + CELL_W'(ask_rank);

  // Waiting for the record.
  logic read1_valid, read1_drop, read2_valid;
  logic [SLOT_W+CELLS_W+DIST_W-1:0] read1, read2;
  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      read1_valid <= 1'b0;
      read1_drop  <= 1'b0;
      read2_valid <= 1'b0;
    end else begin
      read1_valid <= ask_valid;
      read1_drop  <= drop;
      read2_valid <= read1_valid && !read1_drop;
    end
  end
  always_ff @(posedge clk_i) begin
    if (ask_valid) read1 <= {ask_slot, ask_cells, ask_enter};
    if (read1_valid) read2 <= read1;
  end
  assign drop_o = {read1_drop, read1[CELLS_W+DIST_W+:SLOT_W]};

  gridrt_pkg::task_t made;
  logic [PE_W-1:0] made_pe;
  logic made_ready;
  logic [USED_W-1:0] made_count;
  always_comb begin
    {made.slot, made.cells, made.enter} = read2;
    {made_pe, made.count, made.first} = cell_i;
    // A list is never empty; a wrong image must not make a task that ends without an answer.
    if (made.count == '0) made.count = LIST_W'(1);
  end

  gridrt_fifo #(
      .WIDTH(TASK_W + PE_W),
      .DEPTH(DEPTH)
  ) u_tasks (
      .clk_i,
      .rst_ni,
      .in_valid_i(read2_valid),
      .in_ready_o(made_ready),
      .in_data_i({made_pe, made}),
      .out_valid_o(task_valid_o),
      .out_ready_i(task_ready_i),
      .out_data_o({task_pe_o, task_o}),
      .count_o(made_count)
  );

  logic leaves;
  logic [USED_W-1:0] used_next;
  assign leaves = task_valid_o && task_ready_i;
  assign used_next = used + USED_W'(go) - USED_W'(read1_drop) - USED_W'(leaves);
  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) used <= '0;
    else if (go || read1_drop || leaves) used <= used_next;
  end

  logic unused;
  assign unused = &{1'b0, made_ready, made_count, now.cand};  // `left` holds what is left of cand

`ifdef GRIDRT_ASSERT
  always_ff @(posedge clk_i) begin
    if (rst_ni) begin
      assert (!(read2_valid && !made_ready));
      assert (used <= USED_W'(DEPTH));
      if (bundle_valid_i) begin
        assert (bundle_i.cand != '0);
        assert ((bundle_i.cand & ~bundle_i.occ) == '0);
        assert (bundle_i.near_enter <= bundle_i.far_enter);
      end
    end
  end
`endif
endmodule
