// Dispatch (with its queues and merges): one task, whichever it is, leaves once, unchanged, at the
// PE that it is for, whatever the others do; and soon, if PEs take a task every other clock.
module formal_dispatch #(
    parameter int unsigned EXPS  = 2,
    parameter int unsigned PES   = 2,
    parameter int unsigned DEPTH = 2,
    parameter bit SOON = 1'b1,  // PEs take a task every other clock, and the task leaves soon
    localparam int unsigned PE_W = gridrt_pkg::PE_W,
    localparam int unsigned TASK_W = gridrt_pkg::TASK_W
) (
    input logic                        clk_i,
    input logic [EXPS-1:0]             in_valid_i,
    input logic [EXPS-1:0][TASK_W-1:0] in_task_i,  // the top bit marks the watched task
    input logic [EXPS-1:0][PE_W-1:0]   in_pe_i,
    input logic [PES-1:0]              out_ready_i
);
  // Every task leaves within so many clocks: EXPS turns of two clocks for each place in its queue.
  localparam int unsigned WITHIN = 2 * EXPS * DEPTH;

  logic rst_n = 1'b0;
  always_ff @(posedge clk_i) rst_n <= 1'b1;
  (* anyconst *) logic [TASK_W-2:0] data;  // of the watched task
  (* anyconst *) logic [PE_W-1:0] pe;

  logic [EXPS-1:0] in_ready;
  logic [PES-1:0] out_valid;
  logic [PES-1:0][TASK_W-1:0] out_task;
  gridrt_dispatch #(
      .EXPS (EXPS),
      .PES  (PES),
      .DEPTH(DEPTH)
  ) dut (
      .clk_i,
      .rst_ni(rst_n),
      .in_valid_i,
      .in_ready_o(in_ready),
      .in_task_i,
      .in_pe_i,
      .out_valid_o(out_valid),
      .out_ready_i,
      .out_task_o(out_task)
  );

  logic sent, got, enters, leaves, offered;
  logic [4:0] clocks;
  logic [EXPS-1:0] in_held;
  logic [EXPS-1:0][TASK_W+PE_W-1:0] in_was;
  logic [PES-1:0] out_held;
  logic [PES-1:0][TASK_W-1:0] out_was;
  always_comb begin
    enters  = 1'b0;
    offered = 1'b0;
    for (int unsigned e = 0; e < EXPS; e++) begin
      if (in_valid_i[e] && in_task_i[e][TASK_W-1]) begin
        offered = 1'b1;
        enters  = in_ready[e];
      end
    end
    leaves = 1'b0;
    for (int unsigned p = 0; p < PES; p++) begin
      if (out_valid[p] && out_ready_i[p] && out_task[p][TASK_W-1]) leaves = 1'b1;
    end
  end

  always_ff @(posedge clk_i) begin
    if (!rst_n) begin
      sent <= 1'b0;
      got <= 1'b0;
      clocks <= '0;
      in_held <= '0;
      out_held <= '0;
    end else begin
      for (int unsigned e = 0; e < EXPS; e++) begin
        if (in_held[e]) assume (in_valid_i[e] && {in_pe_i[e], in_task_i[e]} == in_was[e]);
        in_was[e] <= {in_pe_i[e], in_task_i[e]};
        if (in_valid_i[e] && in_task_i[e][TASK_W-1]) begin  // the one task that is watched
          assume (!sent && in_task_i[e][TASK_W-2:0] == data && in_pe_i[e] == pe);
          for (int unsigned f = 0; f < e; f++) assume (!in_valid_i[f] || !in_task_i[f][TASK_W-1]);
        end
      end
      in_held <= in_valid_i & ~in_ready;
      for (int unsigned p = 0; p < PES; p++) begin
        if (SOON && out_held[p]) assume (out_ready_i[p]);
        out_was[p] <= out_task[p];
        // An offer stays as it is until it is taken.
        assert (!out_held[p] || (out_valid[p] && out_task[p] == out_was[p]));
        if (out_valid[p] && out_task[p][TASK_W-1]) begin
          assert (sent && !got);
          assert (p == 32'(pe) % PES);
          assert (out_task[p][TASK_W-2:0] == data);
        end
      end
      out_held <= out_valid & ~out_ready_i;

      if (enters) sent <= 1'b1;
      if (leaves) got <= 1'b1;
      clocks <= ((offered && !enters) || (sent && !got)) ? clocks + 5'd1 : '0;
      if (enters) clocks <= '0;
      assert (!SOON || clocks <= 5'(WITHIN));
      cover (got);
      cover (clocks == 5'(WITHIN - 1));
    end
  end
endmodule
