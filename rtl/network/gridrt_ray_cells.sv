// Where a ray is within one voxel of a block, quarter by quarter, from its way through the block.
module gridrt_ray_cells (
    input  gridrt_pkg::way_t                     way_i,
    input  logic             [              2:0] voxel_i,  // of the block: z, y, x
    output logic             [gridrt_pkg::CELLS_W-1:0] cells_o
);
  // By dominant axis a, then b and c. A sample with its uppermost bit is outside of the block.
  logic [2:0] voxel;
  logic [1:0][4:0][3:0] sample, at;  // lateral axis; face of the voxel's quarter-slabs; quarter
  logic [3:0] holds;
  logic [1:0][3:0][3:0] cells;
  always_comb begin
    case (way_i.axis)
      2'd0: voxel = voxel_i;
      2'd1: voxel = {voxel_i[0], voxel_i[2:1]};
      default: voxel = {voxel_i[1:0], voxel_i[2]};
    endcase
    holds = voxel[0] ? way_i.holds[7:4] : way_i.holds[3:0];
    for (int unsigned n = 0; n < 2; n++) begin
      for (int unsigned k = 0; k < 5; k++) begin
        sample[n][k] = voxel[0] ? way_i.samples[n][k+4] : way_i.samples[n][k];
        for (int unsigned q = 0; q < 4; q++) begin
          at[n][k][q] = sample[n][k] == {1'b0, voxel[n+1], 2'(q)};
        end
      end
      for (int unsigned j = 0; j < 4; j++) begin
        cells[n][j] = at[n][j] | at[n][j+1];
      end
    end
    for (int unsigned j = 0; j < 4; j++) begin
      if (!holds[j]) cells[0][j] = '0;
    end
  end
  assign cells_o = {way_i.axis, cells[0], cells[1]};
endmodule
