// From tests to events: a hit gets its id, is ignored if the ray asks for that, and its quotient;
// ends of tasks pass through. Everything leaves in the order in which it came.
//
// Events wait in a queue that keeps their order; those with a hit take a divider, in turn, until
// they leave it. A miss behind a hit so costs nothing until that queue is full.
module gridrt_resolve #(
    parameter int unsigned B = 17,
    parameter int unsigned TRIS = 4096,
    parameter int unsigned SLOTS = 64,
    parameter int unsigned DIVIDERS = 2,
    parameter int unsigned DEPTH = 16,  // tests that may wait here
    parameter int unsigned ORDER = 16,  // events behind the one that leaves next: a division's time
    localparam int unsigned MAG_W = 3 * B + 2,
    localparam int unsigned COUNT_W = $clog2(DEPTH + 1)
) (
    input  logic                          clk_i,
    input  logic                          rst_ni,
    // Loading: ids by triangle.
    input  logic                          write_i,
    input  logic [gridrt_pkg::TRI_W-1:0]  write_index_i,
    input  logic [gridrt_pkg::ID_W-1:0]   write_id_i,
    // Rays.
    input  gridrt_pkg::slot_event_t       alloc_i,
    input  logic [B-1:0]                  ray_length_i,
    input  logic [gridrt_pkg::ID_W-1:0]   ray_ignore_i,
    input  logic                          ray_any_i,
    // Results of tests: hits and last ones of tasks. The sender keeps track of the room.
    input  logic                          valid_i,
    input  logic                          hit_i,
    input  logic                          last_i,
    input  logic [gridrt_pkg::SLOT_W-1:0] slot_i,
    input  logic [gridrt_pkg::TRI_W-1:0]  triangle_i,
    input  logic [MAG_W-1:0]              tn_i,
    input  logic [MAG_W-1:0]              det_i,
    output logic                          taken_o,  // an entry has left: there is room for one more
    output logic                          event_valid_o,
    input  logic                          event_ready_i,
    output gridrt_pkg::event_t            event_o,
    output logic                          wait_o    // a hit waits for a divider
);
  localparam int unsigned SLOT_W = gridrt_pkg::SLOT_W;
  localparam int unsigned TRI_W = gridrt_pkg::TRI_W;
  localparam int unsigned ID_W = gridrt_pkg::ID_W;
  localparam int unsigned RAY_W = B + ID_W + 1;
  localparam int unsigned ENTRY_W = 2 * MAG_W + TRI_W + SLOT_W + 2;
  localparam int unsigned INDEX_W = (SLOTS > 1) ? $clog2(SLOTS) : 1;
  localparam int unsigned LANE_W = (DIVIDERS > 1) ? $clog2(DIVIDERS) : 1;
  localparam int unsigned ADDRESS_W = $clog2(TRIS);
  localparam logic [LANE_W-1:0] LAST_LANE = LANE_W'(DIVIDERS - 1);

  if (DIVIDERS < 1 || DIVIDERS > 8) begin : gen_illegal
    $error("gridrt_resolve: DIVIDERS must be 1 to 8");
  end

  // What waits.
  logic entry_valid, entry_ready, entry_room;
  logic [ENTRY_W-1:0] entry;
  logic [COUNT_W-1:0] count;
  gridrt_fifo #(
      .WIDTH(ENTRY_W),
      .DEPTH(DEPTH)
  ) u_entries (
      .clk_i,
      .rst_ni,
      .in_valid_i (valid_i),
      .in_ready_o (entry_room),
      .in_data_i  ({hit_i, last_i, slot_i, triangle_i, det_i, tn_i}),
      .out_valid_o(entry_valid),
      .out_ready_i(entry_ready),
      .out_data_o (entry),
      .count_o    (count)
  );
  assign taken_o = entry_valid && entry_ready;

  logic entry_hit, entry_last;
  logic [SLOT_W-1:0] entry_slot;
  logic [TRI_W-1:0] entry_triangle;
  logic [MAG_W-1:0] entry_det, entry_tn;
  assign {entry_hit, entry_last, entry_slot, entry_triangle, entry_det, entry_tn} = entry;

  // The id comes one clock later, beside the rest.
  logic id_write_a;
  logic [ID_W-1:0] id, id_other;
  assign id_write_a = write_i;
  gridrt_ram_tdp #(
      .WIDTH(ID_W),
      .DEPTH(TRIS)
  ) u_ids (
      .clk_i,
      .a_write_i(id_write_a),
      .a_enable_i(write_i || taken_o),
      .a_address_i(ADDRESS_W'(write_i ? write_index_i : entry_triangle)),
      .a_data_i(write_id_i),
      .a_data_o(id),
      .b_enable_i(1'b0),
      .b_address_i('0),
      .b_data_o(id_other)
  );

  logic [RAY_W-1:0] ray, ray_data;
  assign ray_data = {ray_any_i, ray_ignore_i, ray_length_i};
  gridrt_lutram #(
      .WIDTH(RAY_W),
      .DEPTH(SLOTS)
  ) u_rays (
      .clk_i,
      .write_i(alloc_i.valid),
      .write_address_i(INDEX_W'(alloc_i.slot)),
      .write_data_i(ray_data),
      .read_address_i(INDEX_W'(entry_slot)),
      .read_data_o(ray)
  );

  // The stage beside the id.
  logic stage_valid, stage_ready, stage_hit, stage_last, stage_any;
  logic [SLOT_W-1:0] stage_slot;
  logic [MAG_W-1:0] stage_det, stage_tn;
  logic [ID_W-1:0] stage_ignore;
  logic [B-1:0] stage_length;
  assign entry_ready = !stage_valid || stage_ready;

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) stage_valid <= 1'b0;
    else if (entry_ready) stage_valid <= entry_valid;
  end
  always_ff @(posedge clk_i) begin
    if (taken_o) begin
      stage_hit <= entry_hit;
      stage_last <= entry_last;
      stage_slot <= entry_slot;
      stage_det <= entry_det;
      stage_tn <= entry_tn;
      {stage_any, stage_ignore, stage_length} <= ray;
    end
  end

  // The stage behind it, so that the id's way through the comparison ends at a register. An ignored
  // triangle that ends nothing goes no further.
  logic known_valid, known_ready, known_hit, known_last, divides, real_hit;
  logic [SLOT_W-1:0] known_slot;
  logic [MAG_W-1:0] known_det, known_tn;
  logic [ID_W-1:0] known_id;
  logic [B-1:0] known_length;
  assign real_hit = stage_hit && id != stage_ignore;
  assign stage_ready = !known_valid || known_ready;

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) known_valid <= 1'b0;
    else if (stage_ready) known_valid <= stage_valid && (real_hit || stage_last);
  end
  always_ff @(posedge clk_i) begin
    if (stage_ready) begin
      known_hit <= real_hit;
      divides <= real_hit && !stage_any;
      known_last <= stage_last;
      known_slot <= stage_slot;
      known_det <= stage_det;
      known_tn <= stage_tn;
      known_id <= stage_any ? {ID_W{1'b0}} : id;
      known_length <= stage_length;
    end
  end

  // Into the order of events and, for a hit, into the divider whose turn it is.
  logic order_room, free;
  logic [DIVIDERS-1:0] start, used, dividing;
  logic [LANE_W-1:0] in_lane, out_lane;
  assign free = !used[in_lane];
  assign known_ready = order_room && (free || !divides);
  assign wait_o = known_valid && divides && !free;

  logic enters, leaves;
  assign enters = known_valid && known_ready;

  logic out_valid, out_divides, out_last, out_hit;
  logic [SLOT_W-1:0] out_slot;
  logic [ID_W-1:0] out_id;
  logic [$clog2(ORDER+1)-1:0] order_count;
  gridrt_fifo #(
      .WIDTH(SLOT_W + ID_W + 3),
      .DEPTH(ORDER)
  ) u_order (
      .clk_i,
      .rst_ni,
      .in_valid_i (enters),
      .in_ready_o (order_room),
      .in_data_i  ({divides, known_slot, known_last, known_hit, known_id}),
      .out_valid_o(out_valid),
      .out_ready_i(leaves),
      .out_data_o ({out_divides, out_slot, out_last, out_hit, out_id}),
      .count_o    (order_count)
  );

  logic [DIVIDERS-1:0][gridrt_pkg::Q_W-1:0] quotient;
  logic [DIVIDERS-1:0][gridrt_pkg::DIST_W-1:0] limit;

  for (genvar i = 0; i < DIVIDERS; i++) begin : gen_divider
    assign start[i] = enters && divides && in_lane == LANE_W'(i);
    gridrt_quotient #(
        .B(B)
    ) u_quotient (
        .clk_i,
        .rst_ni,
        .start_i(start[i]),
        .tn_i(known_tn),
        .det_i(known_det),
        .length_i(known_length),
        .busy_o(dividing[i]),
        .quotient_o(quotient[i]),
        .limit_o(limit[i])
    );
    always_ff @(posedge clk_i or negedge rst_ni) begin
      if (!rst_ni) used[i] <= 1'b0;
      else if (start[i]) used[i] <= 1'b1;
      else if (leaves && out_divides && out_lane == LANE_W'(i)) used[i] <= 1'b0;
    end
  end

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      in_lane  <= '0;
      out_lane <= '0;
    end else begin
      if (enters && divides) in_lane <= (in_lane == LAST_LANE) ? '0 : in_lane + 1'b1;
      if (leaves && out_divides) out_lane <= (out_lane == LAST_LANE) ? '0 : out_lane + 1'b1;
    end
  end

  // The event that leaves next waits in registers, for the choice among PEs takes long.
  logic finished, out_ready;
  logic [gridrt_pkg::EVENT_W-1:0] event_now;
  assign finished = out_valid && !(out_divides && dividing[out_lane]);
  assign leaves = finished && out_ready;
  assign event_now = {
    out_slot,
    out_last,
    out_hit,
    out_divides ? quotient[out_lane] : {gridrt_pkg::Q_W{1'b0}},
    out_id,
    out_divides ? limit[out_lane] : {gridrt_pkg::DIST_W{1'b0}}
  };
  gridrt_skid #(
      .WIDTH(gridrt_pkg::EVENT_W)
  ) u_leaving (
      .clk_i,
      .rst_ni,
      .in_valid_i(finished),
      .in_ready_o(out_ready),
      .in_data_i(event_now),
      .out_valid_o(event_valid_o),
      .out_ready_i(event_ready_i),
      .out_data_o(event_o)
  );

  logic unused;
  assign unused = (^count) ^ (^id_other) ^ entry_room ^ (^order_count);

`ifdef GRIDRT_ASSERT
  always_ff @(posedge clk_i) begin
    if (rst_ni) begin
      assert (!valid_i || entry_room);
      if (valid_i) assert (hit_i || last_i);
    end
  end
`endif
endmodule
