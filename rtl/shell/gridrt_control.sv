// What is done with each frame: the order of its checks, where its payload goes, and its answers.
// Errors about a frame are told once its payload's CRC has been checked; a bad CRC comes first.
module gridrt_control #(
    parameter int unsigned MAX_PAYLOAD = 16384,  // bytes, a multiple of 4, below 4 MiB
    localparam int unsigned COUNT_W = gridrt_shell_pkg::COUNT_W
) (
    input  logic                                   clk_i,
    input  logic                                   rst_ni,
    input  logic                                   clear_i,
    // From gridrt_frame_in.
    input  logic                                   start_valid_i,
    output logic                                   start_ready_o,
    input  logic                                   start_alien_i,
    input  logic                     [7:0]         type_i,
    input  logic                     [7:0]         layout_i,
    input  logic                     [31:0]        sequence_i,
    input  logic                     [22:0]        length_i,
    input  logic                                   byte_valid_i,
    output logic                                   byte_ready_o,
    input  logic                     [7:0]         byte_i,
    input  logic                                   end_valid_i,
    output logic                                   end_ready_o,
    input  logic                                   end_good_i,
    // To gridrt_frame_out's queues; a frame has one answer or two.
    input  logic                                   room_i,  // for two
    output logic                                   answer_valid_o,
    output gridrt_shell_pkg::answer_t              answer_o,
    output logic                                   verdict_valid_o,
    output gridrt_shell_pkg::verdict_t             verdict_o,
    // The first bytes of a payload, the last one on top: a head or a ray record.
    output logic                     [127:0]       head_o,
    // To gridrt_loader.
    output logic                                   load_check_o,
    input  logic                                   load_checked_i,
    output logic                                   load_byte_valid_o,
    output logic                                   load_end_o,
    output logic                                   load_good_o,
    input  logic                                   load_ended_i,
    output logic                                   commit_o,
    input  logic                                   committed_i,
    input  gridrt_shell_pkg::refusal_t             load_refusal_i,
    input  logic                                   ready_i,  // an image is committed
    // To gridrt_rays.
    output logic                                   trace_o,  // a Trace begins
    output logic                                   record_valid_o,
    input  logic                                   record_ready_i,
    input  logic                     [COUNT_W-1:0] issued_i,
    input  logic                                   bad_ray_i,
    input  logic                                   busy_i  // rays in the engine
);
  localparam logic [7:0] NO_OP = gridrt_protocol_pkg::FRAME_TYPE_NO_OP;
  localparam logic [7:0] LOAD = gridrt_protocol_pkg::FRAME_TYPE_LOAD_SECTION;
  localparam logic [7:0] COMMIT = gridrt_protocol_pkg::FRAME_TYPE_COMMIT;
  localparam logic [7:0] TRACE = gridrt_protocol_pkg::FRAME_TYPE_TRACE;

  typedef enum logic [2:0] {
    IDLE,
    HEAD,
    DECIDE,
    CHECKED,
    BODY,
    LOADED,
    COMMITTED
  } state_e;
  state_e state;

  gridrt_shell_pkg::refusal_t refusal, first, second;
  logic refused;
  logic [127:0] head;
  logic [4:0] left;  // bytes of the head or of the record at hand
  logic record_full, shift;
  logic [22:0] body_length;
  logic load, trace, commit;  // of a frame that is not refused
  logic [7:0] kind;

  assign kind = type_i;
  assign refused = refusal.code != '0;
  assign load = kind == LOAD && !refused;
  assign trace = kind == TRACE && !refused;
  assign commit = kind == COMMIT && !refused;
  assign head_o = head;

  // Checks that need the frame's header only.
  always_comb begin
    first = '0;
    first.detail = {9'd0, length_i};
    if (length_i > 23'(MAX_PAYLOAD)) begin
      first.code = gridrt_protocol_pkg::ERROR_CODE_BAD_LENGTH;
    end else begin
      case (kind)
        NO_OP: ;
        LOAD: if (length_i < 23'd16) first.code = gridrt_protocol_pkg::ERROR_CODE_BAD_LENGTH;
        COMMIT: if (length_i != 23'd8) first.code = gridrt_protocol_pkg::ERROR_CODE_BAD_LENGTH;
        TRACE: begin
          if (!ready_i) begin
            first.code   = gridrt_protocol_pkg::ERROR_CODE_NOT_READY;
            first.detail = '0;
          end else if (layout_i != gridrt_protocol_pkg::LAYOUT_COMPACT) begin
            first.code   = gridrt_protocol_pkg::ERROR_CODE_BAD_LAYOUT;
            first.detail = {24'd0, layout_i};
          end else if (length_i < 23'd24 || length_i[3:0] != 4'd8) begin
            first.code = gridrt_protocol_pkg::ERROR_CODE_BAD_LENGTH;
          end
        end
        default: begin
          first.code   = gridrt_protocol_pkg::ERROR_CODE_BAD_TYPE;
          first.detail = {24'd0, kind};
        end
      endcase
    end
  end

  // Checks of the head: a count of rays, or bytes of a piece, that the length agrees with.
  logic [COUNT_W-1:0] count;
  logic [32:0] padded;
  assign count = length_i[COUNT_W+3:4];
  assign body_length = length_i - 23'd16;
  assign padded = {1'b0, head[127:96]} + 33'd3;
  always_comb begin
    second = '0;
    second.detail = {9'd0, length_i};
    if (trace && head[95:64] != 32'(count)) begin
      second.code = gridrt_protocol_pkg::ERROR_CODE_BAD_LENGTH;
    end
    if (load && padded[32:2] != {10'd0, body_length[22:2]}) begin
      second.code = gridrt_protocol_pkg::ERROR_CODE_BAD_LENGTH;
    end
  end

  // Loading waits until all rays have been answered.
  assign start_ready_o = state == IDLE && room_i && !clear_i &&
                         !(busy_i && (kind == LOAD || kind == COMMIT) && !start_alien_i);
  assign record_valid_o = record_full;
  always_comb begin
    case (state)
      HEAD: byte_ready_o = 1'b1;
      BODY: byte_ready_o = !record_full || record_ready_i;
      default: byte_ready_o = 1'b0;
    endcase
  end
  assign shift = byte_valid_i && byte_ready_o && (state == HEAD || (state == BODY && trace));
  assign load_check_o = state == DECIDE && load && second.code == '0;
  assign trace_o = state == DECIDE && trace && second.code == '0;
  assign load_byte_valid_o = state == BODY && load && byte_valid_i;

  // The end, when the last record is on its way.
  logic ends, answers, finishes;
  assign ends = end_valid_i && ((state == BODY && !record_full) || state == HEAD) && !clear_i;
  assign load_end_o = ends && load && state == BODY;
  assign load_good_o = end_good_i;
  assign commit_o = ends && commit && end_good_i;
  assign finishes = (ends && !(end_good_i && (load || commit))) ||
                    (state == LOADED && load_ended_i) || (state == COMMITTED && committed_i);
  assign end_ready_o = finishes && !clear_i;
  assign verdict_valid_o = ends && trace && state == BODY;
  assign verdict_o.bad = !end_good_i || bad_ray_i;
  assign verdict_o.missing = count - issued_i;

  gridrt_shell_pkg::refusal_t told;  // code 0: a NoOp
  always_comb begin
    answers = 1'b0;
    told = refusal;
    case (state)
      IDLE: begin
        answers = start_valid_i && start_ready_o && start_alien_i;
        told.code = gridrt_protocol_pkg::ERROR_CODE_BAD_VERSION;
        told.detail = 32'(gridrt_protocol_pkg::VERSION);
      end
      LOADED: begin
        told = load_refusal_i;
        answers = load_ended_i && load_refusal_i.code != '0;
      end
      COMMITTED: begin
        told = load_refusal_i;
        answers = committed_i;
      end
      default: begin
        answers = ends;
        if (!end_good_i) begin
          told.code   = gridrt_protocol_pkg::ERROR_CODE_BAD_PAYLOAD_CRC;
          told.detail = '0;
        end else if (load || commit) begin
          answers = 1'b0;
        end else if (trace) begin
          answers = ends && bad_ray_i;
          told.code = gridrt_protocol_pkg::ERROR_CODE_BAD_RAY;
          told.detail = 32'(issued_i);
        end
      end
    endcase
    answer_o.kind = (told.code == '0) ? gridrt_shell_pkg::ANSWER_NO_OP :
                                        gridrt_shell_pkg::ANSWER_ERROR;
    answer_o.sequence_ = sequence_i;
    answer_o.first = {16'd0, told.code};
    answer_o.second = told.detail;
    if (trace_o) begin
      answer_o.kind = gridrt_shell_pkg::ANSWER_HITS;
      answer_o.first = 32'(count);
      answer_o.second = head[127:96];
    end
  end
  assign answer_valid_o = (answers || trace_o) && !clear_i;

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      state <= IDLE;
      record_full <= 1'b0;
      refusal <= '0;
    end else if (clear_i) begin
      state <= IDLE;
      record_full <= 1'b0;
    end else begin
      case (state)
        IDLE: begin
          record_full <= 1'b0;
          if (start_valid_i && start_ready_o && !start_alien_i) begin
            refusal <= first;
            state   <= (first.code != '0 || kind == NO_OP) ? BODY : HEAD;
          end
        end
        HEAD: begin
          if (ends) state <= IDLE;
          else if (shift && left == 5'd1) state <= DECIDE;
        end
        DECIDE: begin
          refusal <= second;
          state   <= load_check_o ? CHECKED : BODY;
        end
        CHECKED: begin
          if (load_checked_i) begin
            refusal <= load_refusal_i;
            state   <= BODY;
          end
        end
        BODY: begin
          if (record_full && record_ready_i) record_full <= 1'b0;
          if (shift && left == 5'd1) record_full <= 1'b1;
          if (ends) begin
            state <= IDLE;
            if (end_good_i && load) state <= LOADED;
            if (end_good_i && commit) state <= COMMITTED;
          end
        end
        LOADED: if (load_ended_i) state <= IDLE;
        default: if (committed_i) state <= IDLE;
      endcase
    end
  end
  always_ff @(posedge clk_i) begin
    if (shift) head <= {byte_i, head[127:8]};
    if (state == IDLE) left <= (kind == LOAD) ? 5'd16 : 5'd8;
    else if (state == DECIDE) left <= 5'd16;
    else if (shift) left <= (left == 5'd1) ? 5'd16 : left - 1'b1;
  end

  if (MAX_PAYLOAD < 64 || MAX_PAYLOAD > gridrt_protocol_pkg::MAX_PAYLOAD ||
      MAX_PAYLOAD % 4 != 0) begin : gen_illegal
    $error("gridrt_control: MAX_PAYLOAD must be a multiple of 4, 64 to 4 MiB");
  end
  logic unused;
  assign unused = &{1'b0, padded, body_length};
endmodule
