// What the engine counts, a clock late: sums over units, and where clocks went while rays were in
// flight.
module gridrt_counts #(
    parameter int unsigned SLOTS = 64,
    parameter int unsigned TUS   = 4,
    parameter int unsigned EXPS  = 2,
    parameter int unsigned PES   = 4
) (
    input  logic                                  clk_i,
    input  logic                                  rst_ni,
    // Streams at the engine's ports and at the slots.
    input  logic                                  ray_valid_i,
    input  logic                                  ray_ready_i,
    input  logic                                  start_valid_i,
    input  logic                                  start_ready_i,
    input  logic                                  hit_valid_i,
    input  logic                                  hit_ready_i,
    input  logic                                  commit_i,
    input  logic                                  wait_i,
    input  logic                 [TUS-1:0]        step_i,
    input  logic                 [SLOTS-1:0]      walking_i,
    input  logic                 [SLOTS-1:0]      few_i,
    input  logic                 [EXPS-1:0]       expand_drop_i,
    input  logic                 [PES-1:0]        test_i,
    input  logic                 [PES-1:0][3:0]   masked_i,
    input  logic                 [PES-1:0]        cancelled_i,
    input  logic                 [PES-1:0]        queue_full_i,
    input  logic                 [PES-1:0]        pe_busy_i,
    input  logic                 [PES-1:0]        divider_wait_i,
    output gridrt_pkg::counts_t                   counts_o
);
  localparam int unsigned FLIGHT_W = 12;

  gridrt_pkg::counts_t now;
  logic [FLIGHT_W-1:0] flying;  // rays taken and not yet answered
  logic in_flight, arrives, leaves;
  logic [TUS-1:0] walks, may_step;

  assign arrives = ray_valid_i && ray_ready_i;
  assign leaves = hit_valid_i && hit_ready_i;
  assign in_flight = flying != '0;

  // A unit rests if it has rays and all of them have enough tasks ahead.
  for (genvar t = 0; t < TUS; t++) begin : gen_unit
    logic [SLOTS/TUS-1:0] walking, few;
    for (genvar s = 0; s < SLOTS / TUS; s++) begin : gen_slot
      assign walking[s] = walking_i[s*TUS+t];
      assign few[s] = few_i[s*TUS+t];
    end
    assign walks[t] = walking != '0;
    assign may_step[t] = (walking & few) != '0;
  end

  always_comb begin
    now = '0;
    now.ray = commit_i;
    now.feedback_wait = wait_i;
    now.in_flight = in_flight;
    now.no_ray = in_flight && ray_ready_i && !ray_valid_i;
    now.no_slot = start_valid_i && !start_ready_i;
    now.hit_wait = hit_valid_i && !hit_ready_i;
    for (int unsigned t = 0; t < TUS; t++) begin
      now.steps = now.steps + 3'(step_i[t]);
      now.traversal_idle = now.traversal_idle + 3'(walks[t] && !may_step[t]);
    end
    for (int unsigned e = 0; e < EXPS; e++) begin
      now.interrupts = now.interrupts + 3'(expand_drop_i[e]);
    end
    for (int unsigned p = 0; p < PES; p++) begin
      now.tests = now.tests + 3'(test_i[p]);
      now.masked = now.masked + 6'(masked_i[p]);
      now.interrupts = now.interrupts + 3'(cancelled_i[p]);
      now.queue_full = now.queue_full + 3'(queue_full_i[p]);
      now.pe_idle = now.pe_idle + 3'(in_flight && !pe_busy_i[p]);
      now.divider_busy = now.divider_busy + 3'(divider_wait_i[p]);
    end
  end

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      flying   <= '0;
      counts_o <= '0;
    end else begin
      counts_o <= now;
      if (arrives && !leaves) flying <= flying + 1'b1;
      if (leaves && !arrives) flying <= flying - 1'b1;
    end
  end

`ifdef GRIDRT_ASSERT
  always_ff @(posedge clk_i) begin
    if (rst_ni) begin
      assert (!(leaves && !in_flight));
      assert (flying != '1);
    end
  end
`endif
endmodule
