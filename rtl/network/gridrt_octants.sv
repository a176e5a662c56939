// The octants of a voxel that a ray touches, from its way through the voxel's block.
module gridrt_octants (
    input  gridrt_pkg::way_t       way_i,
    input  logic             [2:0] voxel_i,   // of the block: z, y, x
    output logic             [7:0] octants_o  // bit x + 2 y + 4 z
);
  // The voxel and its octants by dominant axis a, then b and c.
  logic [2:0] voxel;
  logic [1:0][1:0] b, c;  // by half-slab of the voxel: its halves
  logic [7:0] octants;  // a + 2 b + 4 c
  always_comb begin
    case (way_i.axis)
      2'd0: voxel = voxel_i;
      2'd1: voxel = {voxel_i[0], voxel_i[2:1]};
      default: voxel = {voxel_i[1:0], voxel_i[2]};
    endcase
    for (int unsigned j = 0; j < 2; j++) begin
      b[j] = voxel[1] ? way_i.halves[0][{voxel[0], 1'(j)}][3:2] : way_i.halves[0][{voxel[0], 1'(j)}][1:0];
      c[j] = voxel[2] ? way_i.halves[1][{voxel[0], 1'(j)}][3:2] : way_i.halves[1][{voxel[0], 1'(j)}][1:0];
      if (!way_i.holds[{voxel[0], 1'(j)}]) b[j] = '0;
    end
    for (int unsigned o = 0; o < 8; o++) octants[o] = b[o%2][(o/2)%2] && c[o%2][o/4];
    for (int unsigned o = 0; o < 8; o++) begin
      case (way_i.axis)
        2'd0: octants_o[o] = octants[o];
        2'd1: octants_o[o] = octants[(o/2)%4+4*(o%2)];
        default: octants_o[o] = octants[o/4+2*(o%4)];
      endcase
    end
  end
endmodule
