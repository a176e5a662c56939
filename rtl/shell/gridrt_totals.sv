// Sums of what the engine counts, 48 bits each: 0 to 6 in the order of the Counters report, 7 to 13
// in that of the Stalls report. The sums lie in small memories; each takes in its turn, every 16
// clocks, what has come since. What is read counts that, too.
module gridrt_totals (
    input  logic                              clk_i,
    input  logic                              rst_ni,
    input  logic                              clear_i,
    input  gridrt_pkg::counts_t               counts_i,
    input  logic                       [ 3:0] select_i,
    output logic                       [47:0] total_o
);
  localparam int unsigned TOTALS = 14;
  localparam logic [TOTALS-1:0] UP_TO_SEVEN = 14'b01_1110_0001_0110;  // others: one, and MASKED
  localparam int unsigned MASKED = 3;
  localparam int unsigned RECENT_W = 6 + 4;  // of 16 clocks

  logic [TOTALS-1:0][5:0] now;
  logic flying;
  assign flying = counts_i.in_flight;
  assign now = {
    6'(counts_i.hit_wait && flying),
    flying ? 6'(counts_i.divider_busy) : 6'd0,
    flying ? 6'(counts_i.pe_idle) : 6'd0,
    flying ? 6'(counts_i.queue_full) : 6'd0,
    flying ? 6'(counts_i.traversal_idle) : 6'd0,
    6'(counts_i.no_slot && flying),
    6'(counts_i.no_ray && flying),
    6'(counts_i.in_flight),
    6'(counts_i.feedback_wait),
    6'(counts_i.interrupts),
    counts_i.masked,
    6'(counts_i.tests),
    6'(counts_i.steps),
    6'(counts_i.ray)
  };

  logic [TOTALS-1:0][RECENT_W-1:0] recent;
  logic [15:0][RECENT_W-1:0] recents;
  assign recents = {20'd0, recent};
  logic [15:0] kept;  // whose memory holds a sum
  logic [3:0] turn;
  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      kept <= '0;
      turn <= '0;
    end else begin
      turn <= turn + 1'b1;
      if (clear_i) kept <= '0;
      else kept[turn] <= 1'b1;
    end
  end
  for (genvar i = 0; i < TOTALS; i++) begin : gen_recent
    localparam int unsigned ADDED_W = (i == MASKED) ? 6 : UP_TO_SEVEN[i] ? 3 : 1;
    localparam int unsigned W = ADDED_W + 4;
    logic [W-1:0] next;
    gridrt_add_gated #(
        .WIDTH(W)
    ) u_next (
        .a_valid_i(!clear_i && turn != 4'(i)),
        .a_i(recent[i][W-1:0]),
        .b_valid_i(!clear_i),
        .b_i({4'd0, now[i][ADDED_W-1:0]}),
        .sum_o(next)
    );
    always_ff @(posedge clk_i or negedge rst_ni) begin
      if (!rst_ni) recent[i] <= '0;
      else recent[i] <= RECENT_W'(next);
    end
  end

  logic [47:0] turns_sum, turns_next, read_sum;
  gridrt_lutram #(
      .WIDTH(48)
  ) u_sums (
      .clk_i,
      .write_i(1'b1),
      .write_address_i(turn),
      .write_data_i(turns_next),
      .read_address_i(turn),
      .read_data_o(turns_sum)
  );
  gridrt_lutram #(
      .WIDTH(48)
  ) u_read_sums (
      .clk_i,
      .write_i(1'b1),
      .write_address_i(turn),
      .write_data_i(turns_next),
      .read_address_i(select_i),
      .read_data_o(read_sum)
  );
  gridrt_add_gated #(
      .WIDTH(48)
  ) u_turn (
      .a_valid_i(kept[turn]),
      .a_i(turns_sum),
      .b_valid_i(1'b1),
      .b_i({38'd0, recents[turn]}),
      .sum_o(turns_next)
  );
  gridrt_add_gated #(
      .WIDTH(48)
  ) u_read (
      .a_valid_i(kept[select_i]),
      .a_i(read_sum),
      .b_valid_i(1'b1),
      .b_i({38'd0, recents[select_i]}),
      .sum_o(total_o)
  );
endmodule
