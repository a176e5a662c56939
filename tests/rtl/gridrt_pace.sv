// Watches a PE from inside and counts the clocks in which it has work: a reference that is to be
// tested is later than the fixed way from the port to its test takes. A PE's pace is its tests by
// these clocks. Those in which it only reads references that the mask leaves out are not among
// them, unless a reference to be tested is behind them.
//
// A task comes in the clock in which it is first at the port, so the time in which the PE refuses
// it counts. With a test at clock t, references have been waiting from the clock in which the task
// came plus LATENCY, or from the test before, to t.
module gridrt_pace #(
    parameter int unsigned LATENCY = 7  // the fewest clocks from the port to a test
) (
    input logic clk_i,
    input logic rst_ni,
    input logic task_valid_i,
    input logic task_ready_i,
    input logic dropped_i,  // the task in the queue is cancelled
    input logic read_i,     // the task in the queue goes to be read
    input logic kept_i,     // of the task that has been read the longest, the first references pass
    input logic ends_i,     // of that task, there are no more references
    input logic test_i,
    input logic last_i      // the last test of its task
);
  typedef longint unsigned count_t;
  count_t tests /*verilator public_flat_rd*/;
  count_t work /*verilator public_flat_rd*/;

  // When tasks came that are in the queue, being read, and have references to be tested: in order.
  count_t [63:0] queued, reading, tested;
  logic [5:0] queued_in, queued_out, reading_in, reading_out, tested_in, tested_out;
  count_t at_port, first, done;  // done: the latest test
  count_t now, from;
  logic waited;

  assign first = waited ? at_port : now;
  always_comb begin
    from = tested[tested_out] + count_t'(LATENCY);
    if (from <= done) from = done + 1;
  end

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      now <= 1;
      {tests, work} <= '0;
      {done, at_port, waited} <= '0;
      {queued_in, queued_out, reading_in, reading_out, tested_in, tested_out} <= '0;
    end else begin
      now <= now + 1;
      waited <= task_valid_i && !task_ready_i;
      at_port <= first;
      if (task_valid_i && task_ready_i) queued_in <= queued_in + 1'b1;
      if (dropped_i || read_i) queued_out <= queued_out + 1'b1;
      if (read_i) reading_in <= reading_in + 1'b1;
      if (ends_i) reading_out <= reading_out + 1'b1;
      if (kept_i) tested_in <= tested_in + 1'b1;
      if (test_i) begin
        tests <= tests + 1;
        work <= work + now + 1 - from;
        done <= now;
        if (last_i) tested_out <= tested_out + 1'b1;
      end
    end
  end
  always_ff @(posedge clk_i) begin
    queued[queued_in] <= first;
    reading[reading_in] <= queued[queued_out];
    if (kept_i) tested[tested_in] <= reading[reading_out];
  end

`ifdef GRIDRT_ASSERT
  always_ff @(posedge clk_i) begin
    if (rst_ni) begin
      if (test_i) assert (tested_in != tested_out && from <= now);
      if (ends_i || kept_i) assert (reading_in != reading_out);
      if (dropped_i || read_i) assert (queued_in != queued_out);
      assert (queued_in + 1'b1 != queued_out && reading_in + 1'b1 != reading_out &&
              tested_in + 1'b1 != tested_out);
    end
  end
`endif
endmodule

bind gridrt_pe gridrt_pace u_pace (
    .clk_i,
    .rst_ni,
    .task_valid_i,
    .task_ready_i(task_ready_o),
    .dropped_i(queue_drop_valid && queue_drop_ready),
    .read_i(fetch_valid && fetch_ready),
    .kept_i(u_fetch.valid_3 && u_fetch.pass != '0 && !u_fetch.begun),
    .ends_i(u_fetch.valid_3 && u_fetch.end_3),
    .test_i(test),
    .last_i(last)
);
