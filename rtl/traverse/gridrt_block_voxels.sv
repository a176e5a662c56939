// Which voxels of a 2x2x2 block a ray meets, and its way through the block, from the quarters in which
// it is at the nine quarter-slab faces: clocks 7 and 8 of a step.
module gridrt_block_voxels (
    input  logic                clk_i,
    input  logic [1:0]          valid_i,       // of clocks 8 and 7
    input  logic [1:0]          s7_axis_i,     // dominant
    input  logic [2:0]          s7_neg_i,      // mirrored axes
    input  logic [2:0]          s7_first_i,    // quarter-slabs that hold a part of the segment
    input  logic [2:0]          s7_last_i,
    input  logic [1:0]          s7_sub_i,      // block looked at: bit 0 b-neighbour, bit 1 c-neighbour
    input  logic [1:0][8:0][3:0] s7_sample_i,  // from the entry block's first quarter, 0 .. 15
    output logic [3:1]          s8_touched_o,  // neighbours (as s7_sub_i) met in this block-slab
    output logic [7:0]          s9_met_o,      // bits x + 2 y + 4 z, not mirrored
    output gridrt_pkg::way_t    s9_way_o
);
  // Clock 7: the samples, turned back from mirrored quarters of the entry block to actual ones of this
  // block, and outside of it where bit 3 is set.
  logic [7:0] holds, actual_holds;
  logic [2:0] neg;  // dominant, b, c
  logic [1:0][8:0][3:0] sample;
  logic [1:0][7:0][1:0] blocks;  // lateral axis, quarter-slab, block
  logic [3:1] touched;
  always_comb begin
    case (s7_axis_i)
      2'd0: neg = s7_neg_i;
      2'd1: neg = {s7_neg_i[0], s7_neg_i[2:1]};
      default: neg = {s7_neg_i[1:0], s7_neg_i[2]};
    endcase
    for (int unsigned n = 0; n < 2; n++) begin
      for (int unsigned k = 0; k < 9; k++) begin
        sample[n][k] = (neg[0] ? s7_sample_i[n][8-k] : s7_sample_i[n][k]) ^
                       {s7_sub_i[n], {3{neg[n+1]}}};
      end
      for (int unsigned i = 0; i < 8; i++) begin
        blocks[n][i][0] = !(s7_sample_i[n][i][3] && s7_sample_i[n][i+1][3]);
        blocks[n][i][1] = s7_sample_i[n][i][3] || s7_sample_i[n][i+1][3];
      end
    end
    touched = '0;
    for (int unsigned i = 0; i < 8; i++) begin
      holds[i] = 3'(i) >= s7_first_i && 3'(i) <= s7_last_i;
      for (int unsigned s = 1; s < 4; s++) begin
        if (holds[i] && blocks[0][i][s%2] && blocks[1][i][s/2]) touched[s] = 1'b1;
      end
    end
    for (int unsigned i = 0; i < 8; i++) actual_holds[i] = neg[0] ? holds[7-i] : holds[i];
  end
  logic [1:0] s8_axis;
  logic [7:0] s8_holds;
  logic [1:0][8:0][3:0] s8_sample;
  always_ff @(posedge clk_i) begin
    if (valid_i[0]) begin
      s8_axis <= s7_axis_i;
      s8_holds <= actual_holds;
      s8_sample <= sample;
      s8_touched_o <= touched;
    end
  end

  // Clock 8: voxels (a, b, c), then in the order x, y, z.
  logic [1:0][8:0][1:0] in_voxel;  // lateral axis, face, voxel
  logic [7:0] met;  // a + 2 b + 4 c
  logic [7:0] turned;
  always_comb begin
    for (int unsigned n = 0; n < 2; n++) begin
      for (int unsigned k = 0; k < 9; k++) begin
        in_voxel[n][k][0] = s8_sample[n][k][3:2] == 2'd0;
        in_voxel[n][k][1] = s8_sample[n][k][3:2] == 2'd1;
      end
    end
    met = '0;
    for (int unsigned v = 0; v < 8; v++) begin
      for (int unsigned j = 0; j < 4; j++) begin
        if (s8_holds[4*(v%2)+j] &&
            (in_voxel[0][4*(v%2)+j][(v/2)%2] || in_voxel[0][4*(v%2)+j+1][(v/2)%2]) &&
            (in_voxel[1][4*(v%2)+j][v/4] || in_voxel[1][4*(v%2)+j+1][v/4])) begin
          met[v] = 1'b1;
        end
      end
    end
    // v: a voxel by x, y, z. Its bits in the order a, b, c are rotated by the dominant axis.
    for (int unsigned v = 0; v < 8; v++) begin
      case (s8_axis)
        2'd0: turned[v] = met[v];
        2'd1: turned[v] = met[(v/2)%4+4*(v%2)];  // a is y, b is z, c is x
        default: turned[v] = met[v/4+2*(v%4)];  // a is z, b is x, c is y
      endcase
    end
  end
  always_ff @(posedge clk_i) begin
    if (valid_i[1]) begin
      s9_met_o <= turned;
      s9_way_o <= {s8_axis, s8_holds, s8_sample};
    end
  end
endmodule
