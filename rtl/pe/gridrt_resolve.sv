// From tests to events: a hit gets its id, is ignored if the ray asks for that, and its quotient;
// ends of tasks pass through. Everything leaves in the order in which it came.
//
// Lanes are filled in turn and emptied in turn. Each holds one event, divides if it must, and is
// done at once otherwise.
module gridrt_resolve #(
    parameter int unsigned B = 17,
    parameter int unsigned TRIS = 4096,
    parameter int unsigned SLOTS = 48,
    parameter int unsigned DIVIDERS = 3,
    parameter int unsigned DEPTH = 32,  // tests that may wait here
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

  // Into the lanes.
  logic real_hit, divides, useless;
  logic [DIVIDERS-1:0] start, lane_used, lane_divides, lane_busy;
  logic [LANE_W-1:0] in_lane, out_lane;
  assign real_hit = stage_hit && id != stage_ignore;
  assign divides = real_hit && !stage_any;
  assign useless = !real_hit && !stage_last;  // an ignored triangle that ends nothing
  assign stage_ready = useless || !lane_used[in_lane];
  assign wait_o = stage_valid && divides && !stage_ready;

  logic enters, leaves;
  assign enters = stage_valid && stage_ready && !useless;

  logic [DIVIDERS-1:0][SLOT_W+ID_W+2-1:0] kept;
  logic [DIVIDERS-1:0][gridrt_pkg::Q_W-1:0] quotient;
  logic [DIVIDERS-1:0][gridrt_pkg::DIST_W-1:0] limit;

  for (genvar i = 0; i < DIVIDERS; i++) begin : gen_lane
    assign start[i] = enters && in_lane == LANE_W'(i);
    gridrt_quotient #(
        .B(B)
    ) u_quotient (
        .clk_i,
        .rst_ni,
        .start_i(start[i] && divides),
        .tn_i(stage_tn),
        .det_i(stage_det),
        .length_i(stage_length),
        .busy_o(lane_busy[i]),
        .quotient_o(quotient[i]),
        .limit_o(limit[i])
    );
    always_ff @(posedge clk_i or negedge rst_ni) begin
      if (!rst_ni) lane_used[i] <= 1'b0;
      else if (start[i]) lane_used[i] <= 1'b1;
      else if (leaves && out_lane == LANE_W'(i)) lane_used[i] <= 1'b0;
    end
    always_ff @(posedge clk_i) begin
      if (start[i]) begin
        kept[i] <= {stage_slot, stage_last, real_hit, stage_any ? {ID_W{1'b0}} : id};
        lane_divides[i] <= divides;
      end
    end
  end

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      in_lane  <= '0;
      out_lane <= '0;
    end else begin
      if (enters) in_lane <= (in_lane == LAST_LANE) ? '0 : in_lane + 1'b1;
      if (leaves) out_lane <= (out_lane == LAST_LANE) ? '0 : out_lane + 1'b1;
    end
  end

  // Out of the lanes.
  logic out_last, out_hit;
  logic [SLOT_W-1:0] out_slot;
  logic [ID_W-1:0] out_id;
  assign {out_slot, out_last, out_hit, out_id} = kept[out_lane];
  assign event_valid_o = lane_used[out_lane] && !lane_busy[out_lane];
  assign leaves = event_valid_o && event_ready_i;

  logic divided;
  assign divided = lane_divides[out_lane];
  assign event_o = {
    out_slot,
    out_last,
    out_hit,
    divided ? quotient[out_lane] : {gridrt_pkg::Q_W{1'b0}},
    out_id,
    divided ? limit[out_lane] : {gridrt_pkg::DIST_W{1'b0}}
  };

  logic unused;
  assign unused = (^count) ^ (^id_other) ^ entry_room;

`ifdef GRIDRT_ASSERT
  always_ff @(posedge clk_i) begin
    if (rst_ni) begin
      assert (!valid_i || entry_room);
      if (valid_i) assert (hit_i || last_i);
    end
  end
`endif
endmodule
