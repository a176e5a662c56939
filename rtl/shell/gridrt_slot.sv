// The number under which a section is kept: 0 blocks, 1 cells, 4 + PE references, 8 + PE triangles,
// 12 + PE vertices. Which kinds and PEs there are is for the caller to check.
module gridrt_slot (
    input  logic [7:0] kind_i,
    input  logic [7:0] pe_i,
    output logic [3:0] slot_o
);
  always_comb begin
    case (kind_i)
      gridrt_protocol_pkg::SECTION_KIND_BLOCKS: slot_o = 4'd0;
      gridrt_protocol_pkg::SECTION_KIND_CELLS: slot_o = 4'd1;
      gridrt_protocol_pkg::SECTION_KIND_REFERENCES: slot_o = {2'd1, pe_i[1:0]};
      gridrt_protocol_pkg::SECTION_KIND_TRIANGLES: slot_o = {2'd2, pe_i[1:0]};
      default: slot_o = {2'd3, pe_i[1:0]};
    endcase
  end
  logic unused;
  assign unused = &{1'b0, pe_i};
endmodule
