// Whether a ray and a reference share a cell of their voxel: in some quarter-slab of the dominant axis
// that the reference touches, the ray is in quarters of both other axes that it touches.
module gridrt_match (
    input  logic [2:0][3:0]                masks_i,  // of the reference: dominant axis, b, c
    input  logic [gridrt_pkg::CELLS_W-3:0] cells_i,  // of the ray, without the axis
    output logic                           match_o
);
  logic [1:0][3:0][3:0] cells;  // c, b
  logic [3:0] both;
  assign cells = {cells_i[15:0], cells_i[31:16]};
  always_comb begin
    for (int unsigned j = 0; j < 4; j++) begin
      both[j] = masks_i[0][j] && (masks_i[1] & cells[0][j]) != '0 &&
                (masks_i[2] & cells[1][j]) != '0;
    end
  end
  assign match_o = both != '0;
endmodule
