// The whole device but its link: the shell and the engine behind it. Frames from the host come in
// on rx, frames to the host go out on tx, a byte a clock; reports are served through the register
// bus (hal/protocol/protocol.toml says what both mean).
module gridrt_core #(
    parameter int unsigned B = 17,  // lattice bits, 4 to 17
    parameter int unsigned PES = 4,  // 1, 2 or 4
    parameter int unsigned TUS = 3,  // of the engine, as those below: gridrt_engine.sv
    parameter int unsigned SLOTS = 63,
    parameter int unsigned ROB = 256,
    parameter int unsigned QUEUE = 16,
    parameter int unsigned AHEAD = 2,
    parameter int unsigned BLOCKS = 4096,
    parameter int unsigned CELLS = 6144,
    parameter int unsigned REFS = 8192,
    parameter int unsigned TRIS = 4096,
    parameter int unsigned VERTS = 2560,
    parameter int unsigned DIVIDERS = 2,
    parameter bit MASK = 1'b1,
    parameter bit CANCEL = 1'b1,
    parameter bit FEEDBACK = 1'b1,
    parameter int unsigned MAX_PAYLOAD = 16384,  // bytes of a frame's payload
    parameter int unsigned CLOCK_HZ = 60000000,
    parameter logic [63:0] NAME = 64'h6D6973,  // ASCII, the first letter lowest: "sim"
    parameter int unsigned LOG_WORDS = 512  // of the event log
) (
    input  logic        clk_i,
    input  logic        rst_ni,
    input  logic        rx_valid_i,
    output logic        rx_ready_o,
    input  logic [ 7:0] rx_data_i,
    output logic        tx_valid_o,
    input  logic        tx_ready_i,
    output logic [ 7:0] tx_data_o,
    // A request stays until reg_ready_o; what is read is valid in that clock.
    input  logic        reg_valid_i,
    input  logic        reg_write_i,
    input  logic [11:0] reg_address_i,  // of bytes; words of four are read and written
    input  logic [31:0] reg_write_data_i,
    output logic        reg_ready_o,
    output logic [31:0] reg_read_data_o,
    // For who watches the board.
    output logic        quiet_o,  // no frame, ray or answer is under way
    output logic        busy_o,  // rays are in the engine
    output logic        answered_o,  // one of them has been answered
    output logic        image_o  // an image is ready
);
  gridrt_pkg::load_t load;
  logic config_start, config_done;
  logic [2:0][gridrt_pkg::AXIS_W-1:0] grid_count;
  logic [2:0][gridrt_state_pkg::EDGE_W-1:0] grid_edge;
  logic ray_valid, ray_ready, ray_any, hit_valid, hit_ready, hit;
  logic [2:0][B-1:0] ray_p0, ray_p1;
  logic [gridrt_pkg::ID_W-1:0] ray_ignore, hit_id;
  gridrt_pkg::counts_t counts;
  gridrt_pkg::tap_t tap;
  logic engine_hit_valid, hung;
  assign hit_valid = engine_hit_valid && !hung;
`ifdef GRIDRT_TEST_HANG
  // For tests of the watchdog: behind a ray that ignores this id, no hit is offered any more.
  logic doomed;
  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      doomed <= 1'b0;
      hung   <= 1'b0;
    end else begin
      if (ray_valid && ray_ready && ray_ignore == gridrt_pkg::ID_W'('hDEAD0)) doomed <= 1'b1;
      if (doomed && !(hit_valid && !hit_ready)) hung <= 1'b1;
    end
  end
`else
  assign hung = 1'b0;
`endif

  gridrt_shell #(
      .B(B),
      .PES(PES),
      .BLOCKS(BLOCKS),
      .CELLS(CELLS),
      .REFS(REFS),
      .TRIS(TRIS),
      .VERTS(VERTS),
      .MAX_PAYLOAD(MAX_PAYLOAD),
      .CLOCK_HZ(CLOCK_HZ),
      .NAME(NAME),
      .LOG_WORDS(LOG_WORDS)
  ) u_shell (
      .clk_i,
      .rst_ni,
      .rx_valid_i,
      .rx_ready_o,
      .rx_data_i,
      .tx_valid_o,
      .tx_ready_i,
      .tx_data_o,
      .reg_valid_i,
      .reg_write_i,
      .reg_address_i,
      .reg_write_data_i,
      .reg_ready_o,
      .reg_read_data_o,
      .quiet_o,
      .busy_o,
      .answered_o,
      .image_o,
      .load_o(load),
      .config_o(config_start),
      .grid_count_o(grid_count),
      .grid_edge_o(grid_edge),
      .config_done_i(config_done),
      .ray_valid_o(ray_valid),
      .ray_ready_i(ray_ready),
      .ray_p0_o(ray_p0),
      .ray_p1_o(ray_p1),
      .ray_ignore_o(ray_ignore),
      .ray_any_o(ray_any),
      .hit_valid_i(hit_valid),
      .hit_ready_o(hit_ready),
      .hit_i(hit),
      .hit_id_i(hit_id),
      .counts_i(counts),
      .tap_i(tap)
  );

  gridrt_engine #(
      .B(B),
      .PES(PES),
      .TUS(TUS),
      .SLOTS(SLOTS),
      .ROB(ROB),
      .QUEUE(QUEUE),
      .AHEAD(AHEAD),
      .BLOCKS(BLOCKS),
      .CELLS(CELLS),
      .REFS(REFS),
      .TRIS(TRIS),
      .VERTS(VERTS),
      .DIVIDERS(DIVIDERS),
      .MASK(MASK),
      .CANCEL(CANCEL),
      .FEEDBACK(FEEDBACK)
  ) u_engine (
      .clk_i,
      .rst_ni,
      .load_i(load),
      .config_i(config_start),
      .grid_count_i(grid_count),
      .grid_edge_i(grid_edge),
      .config_done_o(config_done),
      .ray_valid_i(ray_valid),
      .ray_ready_o(ray_ready),
      .ray_p0_i(ray_p0),
      .ray_p1_i(ray_p1),
      .ray_ignore_i(ray_ignore),
      .ray_any_i(ray_any),
      .hit_valid_o(engine_hit_valid),
      .hit_ready_i(hit_ready && !hung),
      .hit_o(hit),
      .hit_id_o(hit_id),
      .counts_o(counts),
      .tap_o(tap)
  );
endmodule
