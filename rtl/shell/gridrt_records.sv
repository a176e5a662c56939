// Makes records of a section's bytes and sends them to the memories. A record that points outside
// its target (whose size the directory tells) marks the section as bad; it is written, but never
// used. The state of the section at hand can be put aside and taken up again between two frames.
module gridrt_records (
    input  logic                                    clk_i,
    input  logic                                    rst_ni,
    input  logic                                    restore_i,  // take up the state saved_i
    input  gridrt_shell_pkg::saved_t                saved_i,
    output gridrt_shell_pkg::saved_t                state_o,  // complete three clocks after a byte
    input  logic                             [ 7:0] kind_i,  // held while bytes come and 3 clocks more
    input  logic                             [ 1:0] pe_i,
    input  logic                                    byte_valid_i,
    input  logic                             [ 7:0] byte_i,
    input  gridrt_shell_pkg::header_t               header_i,
    // Bytes of the section that the record points into, in the same clock.
    output logic                             [ 3:0] target_slot_o,
    input  logic                             [15:0] target_bytes_i,
    output gridrt_pkg::load_t                       load_o
);
  gridrt_shell_pkg::saved_t state;
  logic [31:0] crc_next;
  logic [2:0] last;  // phase of a record's last byte
  logic [55:0] bytes, record, data;
  logic record_valid;
  logic [13:0] number;

  gridrt_crc32c u_crc (
      .crc_i (state.crc),
      .data_i(byte_i),
      .crc_o (crc_next)
  );
  // Seven bytes, the last one on top: shorter records are below it.
  assign bytes = {byte_i, state.part};
  always_comb begin
    case (kind_i)
      gridrt_protocol_pkg::SECTION_KIND_BLOCKS: begin
        last   = 3'(gridrt_protocol_pkg::BLOCK_RECORD_BYTES - 1);
        record = {16'd0, bytes[55:16]};
      end
      gridrt_protocol_pkg::SECTION_KIND_CELLS: begin
        last   = 3'(gridrt_protocol_pkg::CELL_RECORD_BYTES - 1);
        record = {24'd0, bytes[55:24]};
      end
      gridrt_protocol_pkg::SECTION_KIND_REFERENCES: begin
        last   = 3'(gridrt_protocol_pkg::REFERENCE_RECORD_BYTES - 1);
        record = {32'd0, bytes[55:32]};
      end
      default: begin  // triangles and vertices
        last   = 3'(gridrt_protocol_pkg::TRIANGLE_RECORD_BYTES - 1);
        record = bytes;
      end
    endcase
  end

  // What a record says is compared with what there is.
  gridrt_protocol_pkg::block_record_t block;
  gridrt_protocol_pkg::cell_record_t voxel;
  gridrt_protocol_pkg::reference_record_t reference_;
  gridrt_protocol_pkg::triangle_record_t triangle;
  gridrt_protocol_pkg::vertex_record_t vertex;
  assign block = data[39:0];
  assign voxel = data[31:0];
  assign reference_ = data[23:0];
  assign triangle = data;
  assign vertex = data;

  logic [3:0] occupied;
  logic [16:0] cell_end;  // bytes of references up to the end of the list
  logic [2:0] outside;
  logic [11:0] greatest;
  logic [3:0] over;
  logic bad;
  logic [14:0] list_end;
  logic [15:0] entry_end;
  always_comb begin
    occupied = '0;
    for (int unsigned v = 0; v < 8; v++) occupied = occupied + 4'(block.occupancy[v]);
  end
  assign list_end = 15'(voxel.first) + 15'(voxel.count);
  assign cell_end = {1'b0, list_end, 1'b0} + {2'd0, list_end};
  // Triangles and vertices have seven bytes.
  always_comb begin
    greatest = triangle.vertex[0];
    if (triangle.vertex[1] > greatest) greatest = triangle.vertex[1];
    if (triangle.vertex[2] > greatest) greatest = triangle.vertex[2];
    if (kind_i == gridrt_protocol_pkg::SECTION_KIND_REFERENCES) greatest = reference_.triangle;
  end
  assign entry_end = {1'b0, greatest, 3'd0} - {4'd0, greatest} + 16'd7;
  for (genvar a = 0; a < 3; a++) begin : gen_axis
    assign outside[a] = vertex.q[a] > {1'b0, header_i.max_q[a]};
  end
  always_comb begin
    bad = 1'b0;
    over = '0;
    target_slot_o = {2'd1, voxel.pe};
    case (kind_i)
      gridrt_protocol_pkg::SECTION_KIND_BLOCKS: begin
        // A jump out of an occupied block would lose its voxels.
        bad = occupied != '0 && (block.jump != '0 ||
              15'(block.base) + 15'(occupied) > {1'b0, header_i.cells});
      end
      gridrt_protocol_pkg::SECTION_KIND_CELLS: begin
        bad = {1'b0, voxel.pe} >= header_i.pes || voxel.count == '0;
        over[voxel.pe] = cell_end > {1'b0, target_bytes_i};
      end
      gridrt_protocol_pkg::SECTION_KIND_REFERENCES: begin
        target_slot_o = {2'd2, pe_i};
        bad = entry_end > target_bytes_i;
      end
      gridrt_protocol_pkg::SECTION_KIND_TRIANGLES: begin
        target_slot_o = {2'd3, pe_i};
        bad = entry_end > target_bytes_i || triangle.id >= header_i.local_ids;
      end
      default: bad = outside != '0;
    endcase
  end

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      record_valid <= 1'b0;
      load_o <= '0;
    end else begin
      record_valid <= byte_valid_i && state.phase == last;
      load_o.valid <= record_valid;
      load_o.kind <= kind_i;
      load_o.pe <= pe_i;
      load_o.index <= number;
      load_o.data <= data;
    end
  end
  always_ff @(posedge clk_i) begin
    if (byte_valid_i) begin
      data   <= record;
      number <= state.index;
    end
    if (restore_i) begin
      state <= saved_i;
    end else begin
      if (byte_valid_i) begin
        state.progress <= state.progress + 1'b1;
        state.crc <= crc_next;
        state.part <= bytes[55:8];
        state.phase <= (state.phase == last) ? '0 : state.phase + 1'b1;
        if (state.phase == last) state.index <= state.index + 1'b1;
      end
      if (record_valid) begin
        state.bad  <= state.bad || bad;
        state.over <= state.over | over;
      end
    end
  end
  assign state_o = state;

  logic unused;
  assign unused = &{1'b0, block.padding, voxel.padding, reference_.padding, reference_.quarters,
                    vertex.padding, header_i};
endmodule
