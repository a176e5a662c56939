// The way of the voxels from a step to the expander: in clock 9 those that the ray meets and that
// hold something go into a queue. A step may begin only if there is room left for its voxels, counted
// in credits; a step that sends nothing gives its credit back.
module gridrt_march_out #(
    parameter int unsigned QUEUE = 16  // bundles
) (
    input  logic                          clk_i,
    input  logic                          rst_ni,
    input  logic                          issue_i,          // a step begins
    output logic                          may_issue_o,
    input  logic                          s9_valid_i,
    input  logic                          s9_open_i,        // voxels may leave
    input  logic [gridrt_pkg::SLOT_W-1:0] s9_slot_i,
    input  logic [1:0]                    s9_axis_i,
    input  logic [2:0]                    s9_neg_i,
    input  logic [gridrt_pkg::CELL_W-1:0] s9_base_i,        // of the block's cells
    input  logic [7:0]                    s9_occ_i,         // voxels that hold something
    input  logic [7:0]                    s9_met_i,         // voxels that the ray meets
    input  gridrt_pkg::way_t              s9_way_i,
    input  logic [gridrt_pkg::DIST_W-1:0] s9_near_enter_i,
    input  logic [gridrt_pkg::DIST_W-1:0] s9_far_enter_i,
    output logic [7:0]                    s9_cand_o,
    output logic                          s9_push_o,
    output logic [3:0]                    s9_count_o,       // of cand
    output logic                          bundle_valid_o,
    input  logic                          bundle_ready_i,
    output gridrt_pkg::bundle_t           bundle_o
);
  localparam int unsigned BUNDLE_W = gridrt_pkg::BUNDLE_W;
  localparam int unsigned CREDIT_W = $clog2(QUEUE + 1);

  if (QUEUE < 1 || QUEUE > 64) begin : gen_illegal
    $error("gridrt_march_out: QUEUE must be 1 to 64");
  end

  logic [7:0] front;
  gridrt_pkg::bundle_t bundle;
  always_comb begin
    s9_cand_o = s9_open_i ? s9_met_i & s9_occ_i : '0;
    case (s9_axis_i)
      2'd0: front = 8'h55;
      2'd1: front = 8'h33;
      default: front = 8'h0F;
    endcase
    for (int unsigned a = 0; a < 3; a++) begin
      if (s9_axis_i == 2'(a) && s9_neg_i[a]) front = ~front;
    end
    s9_count_o = '0;
    for (int unsigned v = 0; v < 8; v++) s9_count_o = s9_count_o + 4'(s9_cand_o[v]);
    bundle.slot = s9_slot_i;
    bundle.base = s9_base_i;
    bundle.occ = s9_occ_i;
    bundle.cand = s9_cand_o;
    bundle.front = front;
    bundle.way = s9_way_i;
    bundle.near_enter = s9_near_enter_i;
    bundle.far_enter = s9_far_enter_i;
  end
  assign s9_push_o = s9_valid_i && s9_cand_o != '0;

  logic [CREDIT_W-1:0] credits, queue_count;
  logic pop, queue_ready;
  assign may_issue_o = credits != '0;
  assign pop = bundle_valid_o && bundle_ready_i;
  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      credits <= CREDIT_W'(QUEUE);
    end else begin
      credits <= credits - CREDIT_W'(issue_i) + CREDIT_W'(s9_valid_i && !s9_push_o) + CREDIT_W'(pop);
    end
  end
  gridrt_fifo #(
      .WIDTH(BUNDLE_W),
      .DEPTH(QUEUE)
  ) i_queue (
      .clk_i,
      .rst_ni,
      .in_valid_i(s9_push_o),
      .in_ready_o(queue_ready),
      .in_data_i(bundle),
      .out_valid_o(bundle_valid_o),
      .out_ready_i(bundle_ready_i),
      .out_data_o(bundle_o),
      .count_o(queue_count)
  );

  logic unused;
  assign unused = &{1'b0, queue_ready, queue_count};

`ifdef GRIDRT_ASSERT
  always_ff @(posedge clk_i) begin
    if (rst_ni) begin
      assert (!s9_push_o || queue_ready);
      assert (!issue_i || may_issue_o);
      assert (32'(credits) + 32'(queue_count) <= QUEUE);
    end
  end
`endif
endmodule
