// The task that a PE does next; others wait in gridrt_dispatch. One whose ray has been hit before the
// task's slab is cancelled: it leaves by the drop port while the PE is busy with another.
module gridrt_queue #(
    parameter int unsigned SLOTS = 64,
    parameter bit CANCEL = 1'b1
) (
    input  logic                     clk_i,
    input  logic                     rst_ni,
    input  gridrt_pkg::slot_event_t  alloc_i,
    input  gridrt_pkg::interrupt_t   interrupt_i,
    input  logic                     task_valid_i,
    output logic                     task_ready_o,
    input  gridrt_pkg::task_t        task_i,
    output logic                     head_valid_o,  // the head is to be tested
    input  logic                     head_ready_i,
    output gridrt_pkg::task_t        head_o,
    output logic                     drop_valid_o,  // the head is cancelled
    input  logic                     drop_ready_i,
    output logic                     waiting_o      // a task is here
);
  logic held, cancelled, moves;
  gridrt_pkg::task_t next, head;
  logic [gridrt_pkg::DIST_W-1:0] limit;

  assign next = task_i;
  assign task_ready_o = moves;

  gridrt_limits #(
      .SLOTS(SLOTS)
  ) u_limits (
      .clk_i,
      .rst_ni,
      .alloc_i,
      .interrupt_i,
      .slot_i (next.slot),
      .limit_o(limit)
  );

  // The head is in a register, and so is what is known of it: all interrupts up to the clock before.
  logic next_late, head_late;
  assign next_late = interrupt_i.valid && interrupt_i.slot == next.slot && next.enter > interrupt_i.limit;
  assign head_late = interrupt_i.valid && interrupt_i.slot == head.slot && head.enter > interrupt_i.limit;
  assign moves = !held || (cancelled ? drop_ready_i : head_ready_i);
  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      held <= 1'b0;
      cancelled <= 1'b0;
    end else if (moves) begin
      held <= task_valid_i;
      cancelled <= CANCEL && (next.enter > limit || next_late);
    end else begin
      cancelled <= CANCEL && (cancelled || head_late);
    end
  end
  always_ff @(posedge clk_i) begin
    if (moves) head <= next;
  end
  assign head_valid_o = held && !cancelled;
  assign head_o = head;
  assign drop_valid_o = held && cancelled;
  assign waiting_o = held;

`ifdef GRIDRT_ASSERT
  // A ray has got its slot, and its limit, before its first task comes.
  always_ff @(posedge clk_i) begin
    if (rst_ni) assert (!(alloc_i.valid && task_valid_i && alloc_i.slot == next.slot));
  end
`endif
endmodule
