// Gathers what the event log is told. It is meant for one single ray in flight, which one traversal
// unit and one expander handle, so the others are silent.
module gridrt_tap #(
    parameter int unsigned EXPS = 2,
    parameter int unsigned PES = 4,
    localparam int unsigned PE_W = gridrt_pkg::PE_W,
    localparam int unsigned TRI_W = gridrt_pkg::TRI_W,
    localparam int unsigned TASK_W = gridrt_pkg::TASK_W,
    localparam int unsigned SLOT_W = gridrt_pkg::SLOT_W
) (
    input  logic                                                     step_valid_i,
    input  logic                   [gridrt_pkg::BLOCK_W-1:0]         step_block_i,
    input  logic                   [7:0]                             step_cand_i,
    input  logic                   [2:0]                             step_jump_i,
    input  logic                   [EXPS-1:0]                        task_valid_i,
    input  logic                   [EXPS-1:0][TASK_W-1:0]            task_i,  // task_t
    input  logic                   [EXPS-1:0][PE_W-1:0]              task_pe_i,
    input  logic                   [EXPS-1:0]                        expand_drop_i,
    input  logic                   [PES-1:0]                         test_valid_i,
    input  logic                   [PES-1:0][TRI_W-1:0]              test_triangle_i,
    input  logic                   [PES-1:0]                         test_hit_i,
    input  logic                   [PES-1:0][SLOT_W:0]               drop_i,  // slot_event_t
    input  logic                   [PES-1:0]                         drop_cancelled_i,
    input  logic                                                     hit_valid_i,
    input  gridrt_pkg::event_t                                       hit_i,
    input  gridrt_pkg::interrupt_t                                   interrupt_i,
    input  logic                                                     commit_i,
    input  logic                                                     commit_hit_i,
    input  logic                   [gridrt_pkg::ID_W-1:0]            commit_id_i,
    output gridrt_pkg::tap_t                                         tap_o
);
  gridrt_pkg::task_t made;
  logic [PE_W-1:0] made_pe;
  always_comb begin
    made = '0;
    made_pe = '0;
    for (int unsigned e = 0; e < EXPS; e++) begin
      if (task_valid_i[e]) begin
        made = made | task_i[e];
        made_pe = made_pe | (task_pe_i[e] & PE_W'(PES - 1));
      end
    end
  end

  // Octants of the voxel that the ray touches, by dominant axis (bit a + 2 b + 4 c), then by x, y, z.
  logic [7:0] turned, octants;
  always_comb begin
    turned = '0;
    for (int unsigned j = 0; j < 4; j++) begin
      for (int unsigned o = 0; o < 4; o++) begin
        if (made.cells[16+4*j+2*(o%2)+:2] != '0 && made.cells[4*j+2*(o/2)+:2] != '0) begin
          turned[j/2+2*o] = 1'b1;
        end
      end
    end
    for (int unsigned o = 0; o < 8; o++) begin
      case (made.cells[gridrt_pkg::CELLS_W-1-:2])
        2'd0: octants[o] = turned[o];
        2'd1: octants[o] = turned[(o/2)%4+4*(o%2)];
        default: octants[o] = turned[o/4+2*(o%4)];
      endcase
    end
  end
  always_comb begin
    tap_o = '0;
    tap_o.step_valid = step_valid_i;
    tap_o.step_block = step_block_i;
    tap_o.step_cand = step_cand_i;
    tap_o.step_jump = 8'(step_jump_i);
    tap_o.task_pe = made_pe;
    tap_o.task_valid = task_valid_i != '0;
    tap_o.task_first = made.first;
    tap_o.task_count = made.count;
    tap_o.task_octants = octants;
    tap_o.task_enter = made.enter;
    tap_o.expand_drop = expand_drop_i != '0;
    for (int unsigned p = 0; p < PES; p++) begin
      tap_o.test_valid[p] = test_valid_i[p];
      tap_o.test_triangle[p] = test_triangle_i[p];
      tap_o.test_hit[p] = test_hit_i[p];
      tap_o.drop_valid[p] = drop_i[p][SLOT_W];
      tap_o.drop_cancelled[p] = drop_cancelled_i[p];
    end
    tap_o.hit_valid = hit_valid_i;
    tap_o.hit_quotient = hit_i.quotient;
    tap_o.hit_id = hit_i.id;
    tap_o.interrupt_valid = interrupt_i.valid;
    tap_o.interrupt_limit = interrupt_i.limit;
    tap_o.commit_valid = commit_i;
    tap_o.commit_hit = commit_hit_i;
    tap_o.commit_id = commit_id_i;
  end

  logic unused;
  assign unused = &{1'b0, made.slot, hit_i.slot, hit_i.last, hit_i.hit, hit_i.limit,
                    interrupt_i.slot, drop_i};
endmodule
