// Which ray slot steps next: round robin among the slots that are ready and may step, those with
// nothing pending first. A slot granted is not ready again until its step has ended. What is pending
// decides a clock later: of a ready slot it only grows less.
module gridrt_schedule #(
    parameter int unsigned COUNT = 16,
    localparam int unsigned INDEX_W = (COUNT > 1) ? $clog2(COUNT) : 1
) (
    input  logic               clk_i,
    input  logic               rst_ni,
    input  logic               issue_i,    // a step may begin
    input  logic [  COUNT-1:0] few_i,      // not too much is pending
    input  logic [  COUNT-1:0] idle_i,     // nothing is pending
    input  logic               again_i,    // this slot has stepped and wants to step again
    input  logic [INDEX_W-1:0] again_slot_i,
    output logic               grant_o,
    output logic [INDEX_W-1:0] slot_o
);
  logic [COUNT-1:0] ready, after;  // after: slots behind the last one granted
  logic [COUNT-1:0] able, first, able_next;  // first: those of able with nothing pending
  logic [COUNT-1:0] chosen, later, pick;

  always_comb begin
    chosen = (first != '0) ? first : able;
    later = chosen & after;
    pick = (later != '0) ? later : chosen;
    pick = pick & (~pick + 1'b1);  // the lowest one
    slot_o = '0;
    for (int unsigned i = 0; i < COUNT; i++) begin
      if (pick[i]) slot_o = slot_o | INDEX_W'(i);
    end
  end
  assign grant_o = issue_i && able != '0;
  assign able_next = ready & few_i & (grant_o ? ~pick : '1);

  logic [COUNT-1:0] again;
  gridrt_onehot #(
      .LINES(COUNT)
  ) i_again (
      .valid_i(again_i),
      .index_i(again_slot_i),
      .line_o (again)
  );
  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      ready <= '0;
      able  <= '0;
      first <= '0;
      after <= '0;
    end else begin
      able  <= able_next;
      first <= able_next & idle_i;
      ready <= (grant_o ? ready & ~pick : ready) | again;
      if (grant_o) after <= ~(pick | (pick - 1'b1));
    end
  end

`ifdef GRIDRT_ASSERT
  always_ff @(posedge clk_i) begin
    if (rst_ni) assert ((able & ~ready) == '0 && (first & ~able) == '0);
    if (rst_ni && again_i) begin
      assert (!ready[again_slot_i]);
      assert (32'(again_slot_i) < COUNT);
    end
  end
`endif
endmodule
