// Carries tasks from the expanders to the PEs that own their voxels. Between each expander and each
// PE lies a short queue, so that one PE's full queue does not hold back tasks for the others at
// once; a PE takes from the expanders in turn.
module gridrt_dispatch #(
    parameter int unsigned EXPS  = 2,
    parameter int unsigned PES   = 4,  // 1, 2 or 4
    parameter int unsigned DEPTH = 16,  // tasks between an expander and a PE, at least 1
    localparam int unsigned PE_W = gridrt_pkg::PE_W,
    localparam int unsigned TASK_W = gridrt_pkg::TASK_W
) (
    input  logic                                clk_i,
    input  logic                                rst_ni,
    input  logic              [EXPS-1:0]        in_valid_i,
    output logic              [EXPS-1:0]        in_ready_o,
    input  logic              [EXPS-1:0][TASK_W-1:0] in_task_i,
    input  logic              [EXPS-1:0][PE_W-1:0] in_pe_i,  // modulo PES, whatever the image says
    output logic              [PES-1:0]         out_valid_o,
    input  logic              [PES-1:0]         out_ready_i,
    output logic              [PES-1:0][TASK_W-1:0] out_task_o
);
  localparam int unsigned COUNT_W = $clog2(DEPTH + 1);

  if (PES != 1 && PES != 2 && PES != 4) begin : gen_illegal
    $error("gridrt_dispatch: PES must be 1, 2 or 4");
  end
  if (DEPTH < 1) begin : gen_illegal_depth
    $error("gridrt_dispatch: DEPTH, the engine's QUEUE, must be positive");
  end

  logic [PES-1:0][EXPS-1:0] push, room, head_valid, head_ready;
  logic [PES-1:0][EXPS-1:0][TASK_W-1:0] head;
  logic [PES-1:0][EXPS-1:0][COUNT_W-1:0] count;

  always_comb begin
    for (int unsigned e = 0; e < EXPS; e++) begin
      in_ready_o[e] = 1'b0;
      for (int unsigned p = 0; p < PES; p++) begin
        push[p][e] = in_valid_i[e] && (in_pe_i[e] & PE_W'(PES - 1)) == PE_W'(p);
        if ((in_pe_i[e] & PE_W'(PES - 1)) == PE_W'(p)) in_ready_o[e] = room[p][e];
      end
    end
  end

  for (genvar p = 0; p < PES; p++) begin : gen_pe
    for (genvar e = 0; e < EXPS; e++) begin : gen_expander
      gridrt_fifo #(
          .WIDTH(TASK_W),
          .DEPTH(DEPTH)
      ) u_queue (
          .clk_i,
          .rst_ni,
          .in_valid_i(push[p][e]),
          .in_ready_o(room[p][e]),
          .in_data_i(in_task_i[e]),
          .out_valid_o(head_valid[p][e]),
          .out_ready_i(head_ready[p][e]),
          .out_data_o(head[p][e]),
          .count_o(count[p][e])
      );
    end

    gridrt_merge #(
        .N(EXPS),
        .WIDTH(TASK_W)
    ) u_merge (
        .clk_i,
        .rst_ni,
        .in_valid_i(head_valid[p]),
        .in_ready_o(head_ready[p]),
        .in_data_i(head[p]),
        .out_valid_o(out_valid_o[p]),
        .out_ready_i(out_ready_i[p]),
        .out_data_o(out_task_o[p])
    );
  end

  logic unused;
  assign unused = &{1'b0, count};

`ifdef GRIDRT_ASSERT
  // A task that waits stays as it is.
  logic [PES-1:0] waits;
  logic [PES-1:0][TASK_W-1:0] waiting;
  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) waits <= '0;
    else waits <= out_valid_o & ~out_ready_i;
  end
  always_ff @(posedge clk_i) begin
    waiting <= out_task_o;
    if (rst_ni) begin
      for (int unsigned p = 0; p < PES; p++) begin
        if (waits[p]) assert (out_valid_o[p] && out_task_o[p] == waiting[p]);
      end
    end
  end
`endif
endmodule
