// Sums of what the engine counts, 48 bits each: 0 to 6 in the order of the Counters report, 7 to 13
// in that of the Stalls report.
module gridrt_totals (
    input  logic                              clk_i,
    input  logic                              rst_ni,
    input  logic                              clear_i,
    input  gridrt_pkg::counts_t               counts_i,
    input  logic                       [ 3:0] select_i,
    output logic                       [47:0] total_o
);
  localparam int unsigned TOTALS = 14;

  logic [TOTALS-1:0][47:0] total;
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

  for (genvar i = 0; i < TOTALS; i++) begin : gen_total
    always_ff @(posedge clk_i or negedge rst_ni) begin
      if (!rst_ni) total[i] <= '0;
      else if (clear_i) total[i] <= '0;
      else total[i] <= total[i] + {42'd0, now[i]};
    end
  end
  always_comb begin
    total_o = '0;
    for (int unsigned i = 0; i < TOTALS; i++) begin
      if (select_i == 4'(i)) total_o = total[i];
    end
  end
endmodule
