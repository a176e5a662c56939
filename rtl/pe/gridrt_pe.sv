// A processing element: the triangles of its voxels in memories of its own, and one exact test a
// clock.
//
//   tasks -> queue -> fetch (references, masks) -> indices -> vertices -> triangle -> resolve ->
//   events
//
// From indices to the end of the test nothing can wait: a test starts only if there is room for
// its event. Tasks that need no test leave by the drop port.
module gridrt_pe #(
    parameter int unsigned B = 17,
    parameter int unsigned SLOTS = 64,
    parameter int unsigned REFS = 8192,
    parameter int unsigned TRIS = 4096,
    parameter int unsigned VERTS = 2560,
    parameter bit MASK = 1'b1,
    parameter bit CANCEL = 1'b1,
    parameter int unsigned DIVIDERS = 2,
    parameter int unsigned NUMBER = 0
) (
    input  logic                          clk_i,
    input  logic                          rst_ni,
    input  gridrt_pkg::load_t             load_i,
    // A ray enters a slot.
    input  gridrt_pkg::slot_event_t       alloc_i,
    input  logic [2:0][B-1:0]             ray_p0_i,
    input  logic [2:0][B:0]               ray_d_i,       // signed
    input  logic [B-1:0]                  ray_length_i,  // |d| along the dominant axis
    input  logic [gridrt_pkg::ID_W-1:0]   ray_ignore_i,
    input  logic                          ray_any_i,
    input  logic                          task_valid_i,
    output logic                          task_ready_o,
    input  gridrt_pkg::task_t             task_i,
    input  gridrt_pkg::interrupt_t        interrupt_i,
    output logic                          event_valid_o,
    input  logic                          event_ready_i,
    output gridrt_pkg::event_t            event_o,
    output gridrt_pkg::slot_event_t       drop_o,             // a task has ended without an event
    output logic                          drop_cancelled_o,   // because of an earlier hit
    output logic                          test_o,             // counters: a test starts
    output logic [3:0]                    masked_o,           // references left out
    output logic                          busy_o,             // there is work
    output logic                          divider_wait_o,     // a hit waits for a divider
    output logic                          tap_test_valid_o,   // a test ends
    output logic [gridrt_pkg::TRI_W-1:0]  tap_test_triangle_o,
    output logic                          tap_test_hit_o
);
  localparam int unsigned TRI_W = gridrt_pkg::TRI_W;
  localparam int unsigned VERT_W = gridrt_pkg::VERT_W;
  localparam int unsigned SLOT_W = gridrt_pkg::SLOT_W;
  localparam int unsigned MAG_W = 3 * B + 2;
  localparam int unsigned META = SLOT_W + TRI_W + 1;
  localparam int unsigned RAY_W = 3 * B + 3 * (B + 1);
  localparam int unsigned SLOT_INDEX_W = (SLOTS > 1) ? $clog2(SLOTS) : 1;
  localparam int unsigned TRI_INDEX_W = $clog2(TRIS);
  localparam int unsigned VERT_INDEX_W = $clog2(VERTS);
  // Tests on their way and events that wait: the way takes 16 clocks.
  localparam int unsigned ROOM = 24;
  localparam int unsigned ROOM_W = $clog2(ROOM + 1);
  // Section kinds of the protocol.
  localparam logic [7:0] REFERENCES = 8'd3;
  localparam logic [7:0] TRIANGLES = 8'd4;
  localparam logic [7:0] VERTICES = 8'd5;

  if (B < 4 || B > gridrt_pkg::MAX_B) begin : gen_illegal_bits
    $error("gridrt_pe: B must be 4 to 17");
  end
  if (REFS > (1 << gridrt_pkg::REF_W) || TRIS > (1 << TRI_W) || VERTS > (1 << VERT_W)) begin : gen_illegal_memory
    $error("gridrt_pe: a memory is larger than its index");
  end
  if (SLOTS < 1 || SLOTS > (1 << SLOT_W)) begin : gen_illegal_slots
    $error("gridrt_pe: SLOTS must be 1 to 64");
  end

  logic mine, write_reference, write_triangle, write_vertex;
  assign mine = load_i.valid && load_i.pe == 2'(NUMBER);
  assign write_reference = mine && load_i.kind == REFERENCES && 32'(load_i.index) < REFS;
  assign write_triangle = mine && load_i.kind == TRIANGLES && 32'(load_i.index) < TRIS;
  assign write_vertex = mine && load_i.kind == VERTICES && 32'(load_i.index) < VERTS;

  // Tasks and references.
  logic head_valid, head_ready, fetch_valid, fetch_ready;
  logic queue_drop_valid, queue_drop_ready, waiting, working;
  gridrt_pkg::task_t head;
  logic found_valid, found_ready, reference_valid, reference_ready, last, aborted;
  gridrt_pkg::slot_event_t none;
  logic [SLOT_W-1:0] reference_slot;
  logic [TRI_W-1:0] reference_triangle;

  gridrt_queue #(
      .SLOTS (SLOTS),
      .CANCEL(CANCEL)
  ) u_queue (
      .clk_i,
      .rst_ni,
      .alloc_i,
      .interrupt_i,
      .task_valid_i,
      .task_ready_o,
      .task_i,
      .head_valid_o(head_valid),
      .head_ready_i(head_ready),
      .head_o(head),
      .drop_valid_o(queue_drop_valid),
      .drop_ready_i(queue_drop_ready),
      .waiting_o(waiting)
  );
  gridrt_stall #(
      .SEED(4 * NUMBER + 1),
      .CHECK(1'b0)
  ) u_stall_task (
      .clk_i,
      .rst_ni,
      .in_valid_i (head_valid),
      .in_ready_o (head_ready),
      .out_valid_o(fetch_valid),
      .out_ready_i(fetch_ready),
      .data_i(1'b0)
  );

  gridrt_fetch #(
      .REFS  (REFS),
      .MASK  (MASK),
      .CANCEL(CANCEL)
  ) u_fetch (
      .clk_i,
      .rst_ni,
      .interrupt_i,
      .write_i(write_reference),
      .write_index_i(load_i.index),
      .write_data_i(load_i.data[TRI_W+9:0]),
      .task_valid_i(fetch_valid),
      .task_ready_o(fetch_ready),
      .task_i(head),
      .valid_o(found_valid),
      .ready_i(found_ready),
      .none_o(none),
      .last_o(last),
      .slot_o(reference_slot),
      .triangle_o(reference_triangle),
      .masked_o,
      .aborted_o(aborted),
      .working_o(working)
  );
  gridrt_stall #(
      .SEED(4 * NUMBER + 2),
      .CHECK(1'b0)
  ) u_stall_reference (
      .clk_i,
      .rst_ni,
      .in_valid_i (found_valid),
      .in_ready_o (found_ready),
      .out_valid_o(reference_valid),
      .out_ready_i(reference_ready),
      .data_i(1'b0)
  );

  // A task without a test goes first, since the one that is cancelled can wait.
  logic test, room, taken, result_valid;
  assign queue_drop_ready = !none.valid;
  assign reference_ready = room;
  assign test = reference_valid && room;
  // Registers, since the way from the queue's head through its limit is long.
  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      drop_o <= '0;
      drop_cancelled_o <= 1'b0;
    end else begin
      drop_o <= {none.valid || queue_drop_valid, none.valid ? none.slot : head.slot};
      drop_cancelled_o <= (queue_drop_valid && queue_drop_ready) || aborted;
    end
  end
  assign test_o = test;
  assign busy_o = waiting || working || found_valid;

  // Room for events: taken by tests, given back by results that make none and by events that leave.
  logic [ROOM_W-1:0] used;
  logic result_hit, result_last, makes_event;
  assign makes_event = result_hit || result_last;
  assign room = used != ROOM_W'(ROOM);
  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      used <= '0;
    end else begin
      used <= used + ROOM_W'(test) - ROOM_W'(result_valid && !makes_event) - ROOM_W'(taken);
    end
  end

  // Indices: one clock. Vertices: two.
  logic [3*VERT_W-1:0] corners, corners_other;
  gridrt_ram_tdp #(
      .WIDTH(3 * VERT_W),
      .DEPTH(TRIS),
      .BANK ((TRIS > 2048) ? 2048 : TRIS)
  ) u_indices (
      .clk_i,
      .a_write_i(write_triangle),
      .a_enable_i(write_triangle || test),
      .a_address_i(TRI_INDEX_W'(write_triangle ? load_i.index : 14'(reference_triangle))),
      .a_data_i(load_i.data[3*VERT_W-1:0]),
      .a_data_o(corners),
      .b_enable_i(1'b0),
      .b_address_i('0),
      .b_data_o(corners_other)
  );

  logic [2:0][3*gridrt_pkg::MAX_B+2:0] vertex;  // 18 bits a coordinate, as in the records
  logic [3*gridrt_pkg::MAX_B+2:0] vertex_other;
  logic valid_1, valid_2, valid_3;
  logic [META-1:0] meta_1, meta_2, meta_3;
  logic [VERT_INDEX_W-1:0] address_0, address_1, address_2;
  assign address_0 = VERT_INDEX_W'(write_vertex ? load_i.index : 14'(corners[0+:VERT_W]));
  assign address_1 = VERT_INDEX_W'(corners[VERT_W+:VERT_W]);
  assign address_2 = VERT_INDEX_W'(write_vertex ? load_i.index : 14'(corners[2*VERT_W+:VERT_W]));
  gridrt_ram_tdp #(
      .WIDTH(54),
      .DEPTH(VERTS),
      .BANK((VERTS > 2048) ? 2048 : VERTS),
      .OUTPUT_REGISTER(1'b1)
  ) u_vertices_01 (
      .clk_i,
      .a_write_i(write_vertex),
      .a_enable_i(write_vertex || valid_1),
      .a_address_i(address_0),
      .a_data_i(load_i.data[53:0]),
      .a_data_o(vertex[0]),
      .b_enable_i(valid_1),
      .b_address_i(address_1),
      .b_data_o(vertex[1])
  );
  gridrt_ram_tdp #(
      .WIDTH(54),
      .DEPTH(VERTS),
      .BANK((VERTS > 2048) ? 2048 : VERTS),
      .OUTPUT_REGISTER(1'b1)
  ) u_vertices_2 (
      .clk_i,
      .a_write_i(write_vertex),
      .a_enable_i(write_vertex || valid_1),
      .a_address_i(address_2),
      .a_data_i(load_i.data[53:0]),
      .a_data_o(vertex[2]),
      .b_enable_i(1'b0),
      .b_address_i('0),
      .b_data_o(vertex_other)
  );

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      valid_1 <= 1'b0;
      valid_2 <= 1'b0;
      valid_3 <= 1'b0;
    end else begin
      valid_1 <= test;
      valid_2 <= valid_1;
      valid_3 <= valid_2;
    end
  end
  always_ff @(posedge clk_i) begin
    if (gridrt_pkg::FREE_RUNNING || test) meta_1 <= {last, reference_slot, reference_triangle};
    if (gridrt_pkg::FREE_RUNNING || valid_1) meta_2 <= meta_1;
    if (gridrt_pkg::FREE_RUNNING || valid_2) meta_3 <= meta_2;
  end

  // The ray, beside the vertices.
  logic [RAY_W-1:0] ray_data, ray_read, ray_3;
  assign ray_data = {ray_d_i, ray_p0_i};
  gridrt_lutram #(
      .WIDTH(RAY_W),
      .DEPTH(SLOTS)
  ) u_rays (
      .clk_i,
      .write_i(alloc_i.valid),
      .write_address_i(SLOT_INDEX_W'(alloc_i.slot)),
      .write_data_i(ray_data),
      .read_address_i(SLOT_INDEX_W'(meta_2[TRI_W+:SLOT_W])),
      .read_data_o(ray_read)
  );
  always_ff @(posedge clk_i) begin
    if (gridrt_pkg::FREE_RUNNING || valid_2) ray_3 <= ray_read;
  end

  logic [2:0][2:0][B-1:0] corner;
  logic unused;
  for (genvar c = 0; c < 3; c++) begin : gen_corner
    for (genvar a = 0; a < 3; a++) begin : gen_axis
      assign corner[c][a] = vertex[c][18*a+:B];
    end
  end
  assign unused = (^vertex) ^ (^vertex_other) ^ (^corners_other) ^ (^load_i.data);

  // The test.
  logic [MAG_W-1:0] tn, det;
  logic [META-1:0] result;
  gridrt_triangle #(
      .B(B),
      .META(META)
  ) u_triangle (
      .clk_i,
      .rst_ni,
      .valid_i(valid_3),
      .p0_i(ray_3[3*B-1:0]),
      .d_i(ray_3[RAY_W-1:3*B]),
      .v_i(corner),
      .meta_i(meta_3),
      .valid_o(result_valid),
      .hit_o(result_hit),
      .tn_o(tn),
      .det_o(det),
      .meta_o(result)
  );
  assign result_last = result[META-1];

  logic resolved_valid, resolved_ready;
  gridrt_resolve #(
      .B(B),
      .TRIS(TRIS),
      .SLOTS(SLOTS),
      .DIVIDERS(DIVIDERS),
      .DEPTH(ROOM)
  ) u_resolve (
      .clk_i,
      .rst_ni,
      .write_i(write_triangle),
      .write_index_i(load_i.index[TRI_W-1:0]),
      .write_id_i(load_i.data[3*VERT_W+:gridrt_pkg::ID_W]),
      .alloc_i,
      .ray_length_i,
      .ray_ignore_i,
      .ray_any_i,
      .valid_i(result_valid && makes_event),
      .hit_i(result_hit),
      .last_i(result_last),
      .slot_i(result[TRI_W+:SLOT_W]),
      .triangle_i(result[TRI_W-1:0]),
      .tn_i(tn),
      .det_i(det),
      .taken_o(taken),
      .event_valid_o(resolved_valid),
      .event_ready_i(resolved_ready),
      .event_o,
      .wait_o(divider_wait_o)
  );
  gridrt_stall #(
      .SEED(4 * NUMBER + 3),
      .WIDTH(gridrt_pkg::EVENT_W)
  ) u_stall_event (
      .clk_i,
      .rst_ni,
      .in_valid_i (resolved_valid),
      .in_ready_o (resolved_ready),
      .out_valid_o(event_valid_o),
      .out_ready_i(event_ready_i),
      .data_i(event_o)
  );

  assign tap_test_valid_o = result_valid;
  assign tap_test_triangle_o = result[TRI_W-1:0];
  assign tap_test_hit_o = result_hit;

`ifdef GRIDRT_ASSERT
  always_ff @(posedge clk_i) begin
    if (rst_ni) assert (used <= ROOM_W'(ROOM));
  end
`endif
endmodule
