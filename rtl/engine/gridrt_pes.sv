// The PEs, each behind registers of its own: what goes to them comes from far away.
module gridrt_pes #(
    parameter int unsigned B = 17,
    parameter int unsigned PES = 4,
    parameter int unsigned SLOTS = 64,
    parameter int unsigned REFS = 8192,
    parameter int unsigned TRIS = 4096,
    parameter int unsigned VERTS = 2560,
    parameter bit MASK = 1'b1,
    parameter bit CANCEL = 1'b1,
    parameter int unsigned DIVIDERS = 2,
    localparam int unsigned TASK_W = gridrt_pkg::TASK_W,
    localparam int unsigned EVENT_W = gridrt_pkg::EVENT_W,
    localparam int unsigned TRI_W = gridrt_pkg::TRI_W,
    localparam int unsigned SLOT_W = gridrt_pkg::SLOT_W
) (
    input  logic                             clk_i,
    input  logic                             rst_ni,
    input  gridrt_pkg::load_t                load_i,
    // A ray enters a slot.
    input  gridrt_pkg::slot_event_t          alloc_i,
    input  logic [2:0][B-1:0]                ray_p0_i,
    input  logic [2:0][B:0]                  ray_d_i,
    input  logic [B-1:0]                     ray_length_i,
    input  logic [gridrt_pkg::ID_W-1:0]      ray_ignore_i,
    input  logic                             ray_any_i,
    input  gridrt_pkg::interrupt_t           interrupt_i,
    // By PE, as gridrt_pe has them.
    input  logic [PES-1:0]                   task_valid_i,
    output logic [PES-1:0]                   task_ready_o,
    input  logic [PES-1:0][TASK_W-1:0]       task_i,
    output logic [PES-1:0]                   event_valid_o,
    input  logic [PES-1:0]                   event_ready_i,
    output logic [PES-1:0][EVENT_W-1:0]      event_o,
    output logic [PES-1:0][SLOT_W:0]         drop_o,
    output logic [PES-1:0]                   drop_cancelled_o,
    output logic [PES-1:0]                   test_o,
    output logic [PES-1:0][3:0]              masked_o,
    output logic [PES-1:0]                   busy_o,
    output logic [PES-1:0]                   divider_wait_o,
    output logic [PES-1:0]                   tap_test_valid_o,
    output logic [PES-1:0][TRI_W-1:0]        tap_test_triangle_o,
    output logic [PES-1:0]                   tap_test_hit_o
);
  for (genvar p = 0; p < PES; p++) begin : gen_pe
    // A section's record goes to the memories of one PE.
    gridrt_pkg::load_t load;
    logic mine;
    assign mine = load_i.valid && load_i.pe == gridrt_pkg::PE_W'(p);
    always_ff @(posedge clk_i or negedge rst_ni) begin
      if (!rst_ni) load <= '0;
      else if (mine) load <= load_i;
      else load.valid <= 1'b0;
    end

    logic near_valid, near_ready, one_valid, one_ready, event_from, event_taken;
    logic [TASK_W-1:0] one;
    gridrt_skid #(
        .WIDTH(TASK_W)
    ) u_task (
        .clk_i,
        .rst_ni,
        .in_valid_i (task_valid_i[p]),
        .in_ready_o (task_ready_o[p]),
        .in_data_i  (task_i[p]),
        .out_valid_o(near_valid),
        .out_ready_i(near_ready),
        .out_data_o (one)
    );
    gridrt_stall #(
        .SEED(21 + p),
        .WIDTH(TASK_W)
    ) u_task_stall (
        .clk_i,
        .rst_ni,
        .in_valid_i (near_valid),
        .in_ready_o (near_ready),
        .out_valid_o(one_valid),
        .out_ready_i(one_ready),
        .data_i(one)
    );
    gridrt_pe #(
        .B(B),
        .SLOTS(SLOTS),
        .REFS(REFS),
        .TRIS(TRIS),
        .VERTS(VERTS),
        .MASK(MASK),
        .CANCEL(CANCEL),
        .DIVIDERS(DIVIDERS),
        .NUMBER(p)
    ) u_pe (
        .clk_i,
        .rst_ni,
        .load_i(load),
        .alloc_i,
        .ray_p0_i,
        .ray_d_i,
        .ray_length_i,
        .ray_ignore_i,
        .ray_any_i,
        .task_valid_i(one_valid),
        .task_ready_o(one_ready),
        .task_i(one),
        .interrupt_i,
        .event_valid_o(event_from),
        .event_ready_i(event_taken),
        .event_o(event_o[p]),
        .drop_o(drop_o[p]),
        .drop_cancelled_o(drop_cancelled_o[p]),
        .test_o(test_o[p]),
        .masked_o(masked_o[p]),
        .busy_o(busy_o[p]),
        .divider_wait_o(divider_wait_o[p]),
        .tap_test_valid_o(tap_test_valid_o[p]),
        .tap_test_triangle_o(tap_test_triangle_o[p]),
        .tap_test_hit_o(tap_test_hit_o[p])
    );
    gridrt_stall #(
        .SEED(31 + p),
        .WIDTH(EVENT_W)
    ) u_event_stall (
        .clk_i,
        .rst_ni,
        .in_valid_i (event_from),
        .in_ready_o (event_taken),
        .out_valid_o(event_valid_o[p]),
        .out_ready_i(event_ready_i[p]),
        .data_i(event_o[p])
    );
  end
endmodule
