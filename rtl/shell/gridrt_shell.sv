// Everything between the link's bytes and the engine: frames, images, rays, hits, registers, log.
// hal/protocol/protocol.toml says what frames and registers mean.
//
// Payloads stream: a byte a clock, nothing is stored. So the hits of a Trace are on their way before
// its CRC has been checked; if it does not match, or a ray is outside the lattice box, the frame of
// hits gets a CRC that does not match either, and an Error follows. A repeated Trace is traced and
// answered again.
module gridrt_shell #(
    parameter int unsigned B = 17,
    parameter int unsigned PES = 4,
    parameter int unsigned BLOCKS = 4096,
    parameter int unsigned CELLS = 6144,
    parameter int unsigned REFS = 8192,
    parameter int unsigned TRIS = 4096,
    parameter int unsigned VERTS = 2560,
    parameter int unsigned MAX_PAYLOAD = 16384,
    parameter int unsigned CLOCK_HZ = 60000000,
    parameter logic [63:0] NAME = 64'h6D6973,  // ASCII, the first letter lowest: "sim"
    parameter int unsigned LOG_WORDS = 512
) (
    input  logic                                                   clk_i,
    input  logic                                                   rst_ni,
    input  logic                                                   rx_valid_i,
    output logic                                                   rx_ready_o,
    input  logic                [7:0]                              rx_data_i,
    output logic                                                   tx_valid_o,
    input  logic                                                   tx_ready_i,
    output logic                [7:0]                              tx_data_o,
    input  logic                                                   reg_valid_i,
    input  logic                                                   reg_write_i,
    input  logic                [11:0]                             reg_address_i,
    input  logic                [31:0]                             reg_write_data_i,
    output logic                                                   reg_ready_o,
    output logic                [31:0]                             reg_read_data_o,
    // For who watches the board.
    output logic                                                   quiet_o,  // nothing is under way
    output logic                                                   busy_o,  // rays are in the engine
    output logic                                                   answered_o,  // one was answered
    output logic                                                   image_o,  // an image is ready
    // The engine.
    output gridrt_pkg::load_t                                      load_o,
    output logic                                                   config_o,
    output logic                [2:0][gridrt_pkg::AXIS_W-1:0]      grid_count_o,
    output logic                [2:0][gridrt_state_pkg::EDGE_W-1:0] grid_edge_o,
    input  logic                                                   config_done_i,
    output logic                                                   ray_valid_o,
    input  logic                                                   ray_ready_i,
    output logic                [2:0][B-1:0]                       ray_p0_o,
    output logic                [2:0][B-1:0]                       ray_p1_o,
    output logic                [gridrt_pkg::ID_W-1:0]             ray_ignore_o,
    output logic                                                   ray_any_o,
    input  logic                                                   hit_valid_i,
    output logic                                                   hit_ready_o,
    input  logic                                                   hit_i,
    input  logic                [gridrt_pkg::ID_W-1:0]             hit_id_i,
    input  gridrt_pkg::counts_t                                    counts_i,
    input  gridrt_pkg::tap_t                                       tap_i
);
  localparam int unsigned FLIGHT_W = 12;

  logic clear;

  // Bytes in.
  logic rx_valid, rx_ready;
  gridrt_stall #(
      .SEED(11),
      .WIDTH(8)
  ) u_rx_stall (
      .clk_i,
      .rst_ni,
      .in_valid_i(rx_valid_i),
      .in_ready_o(rx_ready_o),
      .out_valid_o(rx_valid),
      .out_ready_i(rx_ready),
      .data_i(rx_data_i)
  );
  logic start_valid, start_ready, start_alien, byte_valid, byte_ready, end_valid, end_ready;
  logic end_good, bad_frame, frame_idle, answers_idle;
  logic [7:0] frame_type, layout, data;
  logic [31:0] sequence_, idle_clocks;
  logic [22:0] length;
  gridrt_frame_in u_frame_in (
      .clk_i,
      .rst_ni,
      .clear_i(clear),
      .rx_valid_i(rx_valid),
      .rx_ready_o(rx_ready),
      .rx_data_i,
      .idle_clocks_i(idle_clocks),
      .start_valid_o(start_valid),
      .start_ready_i(start_ready),
      .start_alien_o(start_alien),
      .type_o(frame_type),
      .layout_o(layout),
      .sequence_o(sequence_),
      .length_o(length),
      .byte_valid_o(byte_valid),
      .byte_ready_i(byte_ready),
      .byte_o(data),
      .end_valid_o(end_valid),
      .end_ready_i(end_ready),
      .end_good_o(end_good),
      .bad_frame_o(bad_frame),
      .idle_o(frame_idle)
  );

  // What each frame asks for.
  logic room, answer_push, verdict_push;
  gridrt_shell_pkg::answer_t answer_in;
  gridrt_shell_pkg::verdict_t verdict_in;
  logic [127:0] head;
  logic load_check, load_checked, load_byte_valid, load_end, load_good, load_ended;
  logic commit, committed, trace, record_valid, record_ready, issue, bad_ray, busy;
  logic [gridrt_shell_pkg::COUNT_W-1:0] issued;
  gridrt_shell_pkg::refusal_t load_refusal;
  gridrt_shell_pkg::header_t header;
  logic [7:0] device_state;
  gridrt_control #(
      .MAX_PAYLOAD(MAX_PAYLOAD)
  ) u_control (
      .clk_i,
      .rst_ni,
      .clear_i(clear),
      .start_valid_i(start_valid),
      .start_ready_o(start_ready),
      .start_alien_i(start_alien),
      .type_i(frame_type),
      .layout_i(layout),
      .sequence_i(sequence_),
      .length_i(length),
      .byte_valid_i(byte_valid),
      .byte_ready_o(byte_ready),
      .byte_i(data),
      .end_valid_i(end_valid),
      .end_ready_o(end_ready),
      .end_good_i(end_good),
      .room_i(room),
      .answer_valid_o(answer_push),
      .answer_o(answer_in),
      .verdict_valid_o(verdict_push),
      .verdict_o(verdict_in),
      .head_o(head),
      .load_check_o(load_check),
      .load_checked_i(load_checked),
      .load_byte_valid_o(load_byte_valid),
      .load_end_o(load_end),
      .load_good_o(load_good),
      .load_ended_i(load_ended),
      .commit_o(commit),
      .committed_i(committed),
      .load_refusal_i(load_refusal),
      .ready_i(device_state == gridrt_protocol_pkg::DEVICE_STATE_READY),
      .trace_o(trace),
      .record_valid_o(record_valid),
      .record_ready_i(record_ready),
      .issued_i(issued),
      .bad_ray_i(bad_ray),
      .busy_i(busy)
  );

  gridrt_loader #(
      .B(B),
      .PES(PES),
      .BLOCKS(BLOCKS),
      .CELLS(CELLS),
      .REFS(REFS),
      .TRIS(TRIS),
      .VERTS(VERTS)
  ) u_loader (
      .clk_i,
      .rst_ni,
      .clear_i(clear),
      .check_i(load_check),
      .head_i(head),
      .checked_o(load_checked),
      .byte_valid_i(load_byte_valid),
      .byte_i(data),
      .end_i(load_end),
      .good_i(load_good),
      .ended_o(load_ended),
      .commit_i(commit),
      .pe_mask_i(head[127:64]),
      .committed_o(committed),
      .refusal_o(load_refusal),
      .state_o(device_state),
      .header_o(header),
      .load_o,
      .config_o,
      .config_done_i
  );
  assign grid_count_o = header.count;
  assign grid_edge_o = header.edges;

  logic ray_valid, ray_ready;
  gridrt_rays #(
      .B(B)
  ) u_rays (
      .clk_i,
      .rst_ni,
      .begin_i(trace),
      .box_i(header.box),
      .record_valid_i(record_valid),
      .record_ready_o(record_ready),
      .record_i(head),
      .issue_o(issue),
      .issued_o(issued),
      .bad_o(bad_ray),
      .ray_valid_o(ray_valid),
      .ray_ready_i(ray_ready),
      .ray_p0_o,
      .ray_p1_o,
      .ray_ignore_o,
      .ray_any_o
  );
  gridrt_stall #(
      .SEED(12),
      .WIDTH(6 * B + gridrt_pkg::ID_W + 1)
  ) u_ray_stall (
      .clk_i,
      .rst_ni,
      .in_valid_i(ray_valid),
      .in_ready_o(ray_ready),
      .out_valid_o(ray_valid_o),
      .out_ready_i(ray_ready_i),
      .data_i({ray_p0_o, ray_p1_o, ray_ignore_o, ray_any_o})
  );

  logic hit_valid, hit_ready;
  gridrt_stall #(
      .SEED(13),
      .WIDTH(gridrt_pkg::ID_W + 1)
  ) u_hit_stall (
      .clk_i,
      .rst_ni,
      .in_valid_i(hit_valid_i),
      .in_ready_o(hit_ready_o),
      .out_valid_o(hit_valid),
      .out_ready_i(hit_ready),
      .data_i({hit_i, hit_id_i})
  );
  gridrt_answers u_answers (
      .clk_i,
      .rst_ni,
      .clear_i(clear),
      .room_o(room),
      .idle_o(answers_idle),
      .answer_valid_i(answer_push),
      .answer_i(answer_in),
      .verdict_valid_i(verdict_push),
      .verdict_i(verdict_in),
      .hit_valid_i(hit_valid),
      .hit_ready_o(hit_ready),
      .hit_i,
      .hit_id_i,
      .tx_valid_o,
      .tx_ready_i,
      .tx_data_o
  );

  // Rays on their way to the engine and in it. A Reset waits until they have left; its last clocks
  // are for what the engine counts a clock late.
  logic [FLIGHT_W-1:0] flying;
  logic hit_taken, reset, reset_done;
  logic [2:0] quiet;
  logic [31:0] bad_frames;
  gridrt_shell_pkg::refusal_t last_error;
  assign busy = flying != '0;
  assign busy_o = busy;
  assign answered_o = hit_taken;
  assign image_o = device_state == gridrt_protocol_pkg::DEVICE_STATE_READY;
  assign quiet_o = frame_idle && answers_idle && !busy && !clear;
  assign hit_taken = hit_valid && hit_ready;
  assign reset_done = clear && quiet == '1;
  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      clear <= 1'b0;
      flying <= '0;
      quiet <= '0;
      bad_frames <= '0;
      last_error <= '0;
    end else begin
      if (issue && !hit_taken) flying <= flying + 1'b1;
      if (hit_taken && !issue) flying <= flying - 1'b1;
      quiet <= (clear && !busy) ? quiet + 1'b1 : '0;
      if (reset) clear <= 1'b1;
      else if (reset_done) clear <= 1'b0;
      if (bad_frame && bad_frames != '1) bad_frames <= bad_frames + 1'b1;
      if (clear) begin
        last_error <= '0;
      end else if (answer_push && answer_in.kind == gridrt_shell_pkg::ANSWER_ERROR) begin
        last_error.code <= answer_in.first[15:0];
        last_error.detail <= answer_in.second;
      end
    end
  end

  logic [3:0] total_select;
  logic [47:0] total;
  gridrt_totals u_totals (
      .clk_i,
      .rst_ni,
      .clear_i(clear),
      .counts_i,
      .select_i(total_select),
      .total_o(total)
  );
  logic log_begin, log_stop, log_on, log_overflow, log_take;
  logic [31:0] log_word;
  logic [$clog2(LOG_WORDS):0] log_count;
  gridrt_log #(
      .WORDS(LOG_WORDS)
  ) u_log (
      .clk_i,
      .rst_ni,
      .begin_i(log_begin),
      .stop_i(log_stop),
      .on_o(log_on),
      .tap_i,
      .count_o(log_count),
      .overflow_o(log_overflow),
      .word_o(log_word),
      .take_i(log_take)
  );
  gridrt_registers #(
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
      .LOG_W($clog2(LOG_WORDS) + 1)
  ) u_registers (
      .clk_i,
      .rst_ni,
      .reg_valid_i,
      .reg_write_i,
      .reg_address_i,
      .reg_write_data_i,
      .reg_ready_o,
      .reg_read_data_o,
      .reset_o(reset),
      .reset_done_i(reset_done),
      .state_i(device_state),
      .error_i(last_error),
      .bad_frames_i(bad_frames),
      .total_select_o(total_select),
      .total_i(total),
      .idle_clocks_o(idle_clocks),
      .log_begin_o(log_begin),
      .log_stop_o(log_stop),
      .log_on_i(log_on),
      .log_count_i(log_count),
      .log_overflow_i(log_overflow),
      .log_word_i(log_word),
      .log_take_o(log_take)
  );

  logic unused;
  assign unused = &{1'b0, header};

`ifdef GRIDRT_ASSERT
  always_ff @(posedge clk_i) begin
    if (rst_ni) begin
      assert (!(load_o.valid && busy));
      assert (flying != '1);
      assert (!(hit_taken && !issue && !busy));
    end
  end
`endif
endmodule
