// The reorder buffer: one ray, whichever it is, gets its own answer, once, at its place in the
// order.
module formal_rob #(
    parameter int unsigned ROB = 4,
    localparam int unsigned ENTRY_W = $clog2(ROB),
    localparam int unsigned ID_W = gridrt_pkg::ID_W
) (
    input logic               clk_i,
    input logic               reserve_i,
    input logic               mark_i,  // the ray to be watched is this one
    input logic               write_i,
    input logic [ENTRY_W-1:0] write_entry_i,
    input logic               write_hit_i,
    input logic [ID_W-1:0]    write_id_i,
    input logic               hit_ready_i,
    input logic               fair_i  // from now on the environment does all that it can
);
  logic rst_n = 1'b0;
  always_ff @(posedge clk_i) rst_n <= 1'b1;

  logic room, hit_valid, hit;
  logic [ENTRY_W-1:0] entry;
  logic [ID_W-1:0] id;
  gridrt_rob #(
      .ROB(ROB)
  ) dut (
      .clk_i,
      .rst_ni(rst_n),
      .room_o(room),
      .entry_o(entry),
      .reserve_i,
      .write_i,
      .write_entry_i,
      .write_hit_i,
      .write_id_i,
      .hit_valid_o(hit_valid),
      .hit_ready_i,
      .hit_o(hit),
      .id_o(id)
  );

  logic [ROB-1:0] open;  // reserved, not yet written
  logic [ENTRY_W+1:0] inside, ahead;  // rays that have not left; those before the watched one
  logic [ENTRY_W-1:0] own;
  logic marked, inside_marked, answered, held, was_fair;
  logic [ID_W:0] answer, held_answer;
  logic [4:0] clocks;
  logic [ENTRY_W:0] age;  // clocks since reset, up to ROB: the memory is being filled
  logic leaves;
  assign leaves = hit_valid && hit_ready_i;

  always_ff @(posedge clk_i) begin
    if (!rst_n) begin
      open <= '0;
      inside <= '0;
      marked <= 1'b0;
      inside_marked <= 1'b0;
      answered <= 1'b0;
      held <= 1'b0;
      was_fair <= 1'b0;
      clocks <= '0;
      age <= '0;
    end else begin
      // Reserved while there is room; each entry is answered once, in any order.
      assume (!reserve_i || room);
      assume (!write_i || open[write_entry_i]);
      assume (!(mark_i && marked) && (!mark_i || reserve_i));
      if (was_fair) assume (fair_i && hit_ready_i && (write_i || open == '0));
      was_fair <= fair_i;

      if (write_i) open[write_entry_i] <= 1'b0;
      if (reserve_i) open[entry] <= 1'b1;
      inside <= inside + (ENTRY_W + 2)'(reserve_i) - (ENTRY_W + 2)'(leaves);
      if (mark_i) begin
        marked <= 1'b1;
        inside_marked <= 1'b1;
        own <= entry;
        ahead <= inside - (ENTRY_W + 2)'(leaves);
      end
      if (write_i && inside_marked && !answered && write_entry_i == own) begin
        answered <= 1'b1;
        answer   <= {write_hit_i, write_id_i};
      end
      if (inside_marked && leaves) begin
        if (ahead == '0) inside_marked <= 1'b0;
        ahead <= ahead - 1'b1;
      end
      held <= hit_valid && !hit_ready_i;
      held_answer <= {hit, id};
      clocks <= (was_fair && inside_marked) ? clocks + 5'd1 : '0;

      assert (!reserve_i || !open[entry]);
      assert (!hit_valid || inside != '0);
      assert (!held || (hit_valid && {hit, id} == held_answer));
      if (inside_marked && hit_valid && ahead == '0) begin
        assert (answered);
        assert ({hit, id} == answer);
      end
      assert (clocks < 5'(2 * ROB + 4));
      if (!age[ENTRY_W]) age <= age + 1'b1;
      assert (room || !age[ENTRY_W] || inside >= (ENTRY_W + 2)'(ROB));
      cover (inside == (ENTRY_W + 2)'(ROB + 1));
      cover (marked && !inside_marked && answer == '1);
    end
  end
endmodule
