// Loads images: what a LoadSection frame brings goes to the image header or, as records, to the
// memories. A frame that turns out bad changes nothing that counts: a section is taken up again
// where the last good frame left it. Once an image is committed its sections stay as they are until
// another header comes.
module gridrt_loader #(
    parameter int unsigned B = 17,
    parameter int unsigned PES = 4,
    parameter int unsigned BLOCKS = 4096,
    parameter int unsigned CELLS = 6144,
    parameter int unsigned REFS = 8192,
    parameter int unsigned TRIS = 4096,
    parameter int unsigned VERTS = 2560
) (
    input  logic                               clk_i,
    input  logic                               rst_ni,
    input  logic                               clear_i,
    // A frame: its head is checked, then come all bytes behind the head, then its end.
    input  logic                               check_i,  // a pulse
    input  logic                       [127:0] head_i,  // held until ended
    output logic                               checked_o,  // a pulse, with refusal_o
    input  logic                               byte_valid_i,
    input  logic                       [  7:0] byte_i,
    input  logic                               end_i,  // a pulse
    input  logic                               good_i,  // valid with end_i
    output logic                               ended_o,  // a pulse, with refusal_o
    input  logic                               commit_i,  // a pulse
    input  logic                       [ 63:0] pe_mask_i,  // held until committed_o
    output logic                               committed_o,  // a pulse, with refusal_o
    output gridrt_shell_pkg::refusal_t         refusal_o,
    output logic                       [  7:0] state_o,  // device_state_e
    output gridrt_shell_pkg::header_t          header_o,
    output gridrt_pkg::load_t                  load_o,
    output logic                               config_o,
    input  logic                               config_done_i
);
  localparam logic [31:0] MOST_HEADER = 32'd3300;  // what a device has to take: 197 entries

  typedef enum logic [2:0] {
    IDLE,
    CHECK,
    BYTES,
    FINISH,
    RESULT
  } state_e;
  typedef enum logic [1:0] {
    IGNORE,
    HEADER,
    SECTION
  } target_e;
  state_e state;
  target_e target, chosen;
  logic [7:0] device;
  logic ready;

  // LoadHead.
  logic [7:0] kind, pe;
  logic [31:0] offset, total, bytes, where;
  logic [32:0] piece_end;
  assign kind = head_i[7:0];
  assign pe = head_i[15:8];
  assign offset = head_i[63:32];
  assign total = head_i[95:64];
  assign bytes = head_i[127:96];
  assign where = {16'd0, pe, kind};
  assign piece_end = {1'b0, offset} + {1'b0, bytes};

  // Sections: directory entry and state.
  logic [3:0] slot, commit_slot, read_slot, target_slot, entry_slot;
  logic [15:0] present, valid, entry_bytes, read_bytes, target_bytes;
  logic [31:0] entry_crc, read_crc;
  logic entry_write, save, committing;
  gridrt_shell_pkg::saved_t kept, read_state, now;
  gridrt_slot u_slot (
      .kind_i(kind),
      .pe_i  (pe),
      .slot_o(slot)
  );
  assign read_slot = committing ? commit_slot : slot;
  gridrt_lutram #(
      .WIDTH(48),
      .DEPTH(16)
  ) u_directory (
      .clk_i,
      .write_i(entry_write),
      .write_address_i(entry_slot),
      .write_data_i({entry_bytes, entry_crc}),
      .read_address_i(read_slot),
      .read_data_o({read_bytes, read_crc})
  );
  gridrt_lutram #(
      .WIDTH(16),
      .DEPTH(16)
  ) u_sizes (
      .clk_i,
      .write_i(entry_write),
      .write_address_i(entry_slot),
      .write_data_i(entry_bytes),
      .read_address_i(target_slot),
      .read_data_o(target_bytes)
  );
  gridrt_lutram #(
      .WIDTH(gridrt_shell_pkg::SAVED_W),
      .DEPTH(16)
  ) u_states (
      .clk_i,
      .write_i(save),
      .write_address_i(slot),
      .write_data_i(now),
      .read_address_i(read_slot),
      .read_data_o(kept)
  );
  always_comb begin
    read_state = kept;
    if (!valid[read_slot]) begin
      read_state = '0;
      read_state.crc = gridrt_shell_pkg::CRC_START;
    end
  end

  logic header_begin, header_complete, header_finish;
  logic [11:0] header_progress;
  gridrt_shell_pkg::refusal_t header_refusal, commit_refusal, objection, refusal;

  // Whether and where a piece is taken.
  logic restart, in_part;
  always_comb begin
    objection = '0;
    objection.detail = where;
    chosen = IGNORE;
    restart = offset == '0;
    in_part = piece_end <= {17'd0, read_state.progress};
    if (piece_end > {1'b0, total}) begin
      objection.code = gridrt_protocol_pkg::ERROR_CODE_BAD_SECTION;
    end else if (kind == gridrt_protocol_pkg::SECTION_KIND_HEADER) begin
      objection.detail = '0;
      if (total > MOST_HEADER) begin
        objection.code = gridrt_protocol_pkg::ERROR_CODE_TOO_LARGE;
      end else if (restart || (offset == {20'd0, header_progress} && !header_complete)) begin
        chosen = HEADER;
      end else if (piece_end > {21'd0, header_progress}) begin
        objection.code = gridrt_protocol_pkg::ERROR_CODE_MISSING_SECTION;
      end
    end else if (kind > gridrt_protocol_pkg::SECTION_KIND_VERTICES) begin
      objection.code = gridrt_protocol_pkg::ERROR_CODE_BAD_SECTION;
    end else if (!header_complete) begin
      objection.code = gridrt_protocol_pkg::ERROR_CODE_MISSING_SECTION;
      objection.detail = '0;
    end else if (pe >= 8'(PES) || (slot[3:2] == 2'd0 && pe != '0) || !present[slot] ||
                 total != {16'd0, read_bytes}) begin
      objection.code = gridrt_protocol_pkg::ERROR_CODE_BAD_SECTION;
    end else if (!ready) begin
      if (restart || offset == {16'd0, read_state.progress}) chosen = SECTION;
      else if (!in_part) objection.code = gridrt_protocol_pkg::ERROR_CODE_MISSING_SECTION;
    end
  end

  logic [22:0] left;  // bytes of the piece; padding follows
  logic taken;
  assign taken = byte_valid_i && state == BYTES && left != '0;
  logic accept;
  assign accept = state == CHECK && objection.code == '0;
  // A piece that is objected to is nobody's, so this need not wait for what objects to sections.
  assign header_begin = clear_i || (state == CHECK && chosen == HEADER && restart) ||
                        (end_i && state == BYTES && !good_i && target == HEADER);
  assign header_finish = state == FINISH && target == HEADER &&
                         {20'd0, header_progress} == total;
  assign save = state == FINISH && target == SECTION;

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      state <= IDLE;
      valid <= '0;
      ready <= 1'b0;
      committing <= 1'b0;
      device <= gridrt_protocol_pkg::DEVICE_STATE_EMPTY;
    end else if (clear_i) begin
      state <= IDLE;
      valid <= '0;
      ready <= 1'b0;
      committing <= 1'b0;
      device <= gridrt_protocol_pkg::DEVICE_STATE_EMPTY;
    end else begin
      case (state)
        IDLE: begin
          if (check_i) state <= CHECK;
          if (commit_i) committing <= 1'b1;
          if (committed_o) begin
            committing <= 1'b0;
            ready <= commit_refusal.code == '0;
            device <= (commit_refusal.code == '0) ? gridrt_protocol_pkg::DEVICE_STATE_READY :
                                                    gridrt_protocol_pkg::DEVICE_STATE_FAILED;
          end
        end
        CHECK: begin
          state <= (objection.code == '0) ? BYTES : IDLE;
          if (accept && chosen == SECTION && restart) valid[slot] <= 1'b0;
        end
        BYTES: if (end_i) state <= good_i ? FINISH : IDLE;
        FINISH: begin
          state <= RESULT;
          if (save) valid[slot] <= 1'b1;
        end
        default: begin
          state <= IDLE;
          if (refusal_o.code != '0) device <= gridrt_protocol_pkg::DEVICE_STATE_FAILED;
        end
      endcase
      if (header_begin) begin
        valid  <= '0;
        ready  <= 1'b0;
        device <= gridrt_protocol_pkg::DEVICE_STATE_LOADING;
      end
    end
  end
  logic finished;  // the header's refusal is of this frame
  always_ff @(posedge clk_i) begin
    refusal <= objection;
    finished <= header_finish;
    if (state == CHECK) begin
      target <= chosen;
      left   <= bytes[22:0];
    end else if (taken) begin
      left <= left - 1'b1;
    end
  end
  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) checked_o <= 1'b0;
    else checked_o <= state == CHECK && !clear_i;
  end
  assign ended_o = state == RESULT;

  gridrt_image_header #(
      .B(B),
      .PES(PES),
      .BLOCKS(BLOCKS),
      .CELLS(CELLS),
      .REFS(REFS),
      .TRIS(TRIS),
      .VERTS(VERTS)
  ) u_header (
      .clk_i,
      .rst_ni,
      .begin_i(header_begin),
      .byte_valid_i(taken && target == HEADER),
      .byte_i,
      .finish_i(header_finish),
      .complete_o(header_complete),
      .refusal_o(header_refusal),
      .progress_o(header_progress),
      .header_o,
      .present_o(present),
      .entry_write_o(entry_write),
      .entry_slot_o(entry_slot),
      .entry_bytes_o(entry_bytes),
      .entry_crc_o(entry_crc)
  );

  gridrt_shell_pkg::saved_t restored;
  always_comb begin
    restored = read_state;
    if (restart) begin
      restored = '0;
      restored.crc = gridrt_shell_pkg::CRC_START;
    end
  end
  gridrt_records u_records (
      .clk_i,
      .rst_ni,
      .restore_i(state == CHECK),
      .saved_i(restored),
      .state_o(now),
      .kind_i(kind),
      .pe_i(pe[1:0]),
      .byte_valid_i(taken && target == SECTION),
      .byte_i,
      .header_i(header_o),
      .target_slot_o(target_slot),
      .target_bytes_i(target_bytes),
      .load_o
  );
  gridrt_commit #(
      .PES(PES)
  ) u_commit (
      .clk_i,
      .rst_ni,
      .clear_i,
      .start_i(commit_i),
      .pe_mask_i,
      .configured_i(ready),
      .header_complete_i(header_complete),
      .header_refusal_i(header_refusal),
      .header_i(header_o),
      .slot_o(commit_slot),
      .present_i(present[commit_slot]),
      .entry_bytes_i(read_bytes),
      .entry_crc_i(read_crc),
      .saved_i(read_state),
      .config_o,
      .config_done_i,
      .done_o(committed_o),
      .refusal_o(commit_refusal)
  );

  gridrt_shell_pkg::refusal_t result;
  always_comb begin
    result = '0;
    if (finished) result = header_refusal;
    refusal_o = refusal;
    if (committing) refusal_o = commit_refusal;
    else if (state == RESULT) refusal_o = result;
  end
  assign state_o = device;

  logic unused;
  assign unused = &{1'b0, head_i};
endmodule
