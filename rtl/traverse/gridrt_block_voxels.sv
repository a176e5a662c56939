// Which voxels of a 2x2x2 block a ray meets, and its way through the block's halves, from the
// half-voxels in which it is at the five half-slab faces: clocks 5 and 6 of a step.
module gridrt_block_voxels (
    input  logic                clk_i,
    input  logic [1:0]          valid_i,       // of clocks 6 and 5
    input  logic [1:0]          s5_axis_i,     // dominant
    input  logic [2:0]          s5_neg_i,      // mirrored axes
    input  logic [1:0]          s5_first_i,    // half-slabs that hold a part of the segment
    input  logic [1:0]          s5_last_i,
    input  logic [1:0]          s5_sub_i,      // block looked at: bit 0 b-neighbour, bit 1 c-neighbour
    input  logic [1:0][4:0][2:0] s5_sample_i,  // from the entry block's first half, 0 .. 7
    output logic [3:1]          s6_touched_o,  // neighbours (as s5_sub_i) met in this block-slab
    output logic [7:0]          s7_met_o,      // bits x + 2 y + 4 z, not mirrored
    output gridrt_pkg::way_t    s7_way_o
);
  // Clock 5: halves of this block by half-slab, turned back from mirrored to actual ones. The samples
  // are turned, not what comes of them, which is wider.
  logic [3:0] holds, actual_holds;
  logic [2:0] neg;  // dominant, b, c
  logic [1:0][4:0][2:0] sample;  // bit 2: outside of this block
  logic [1:0][4:0][3:0] at;  // lateral axis, face, half
  logic [1:0][3:0][3:0] actual;  // lateral axis, half-slab, half
  logic [1:0][3:0][1:0] blocks;  // lateral axis, half-slab, block
  logic [3:1] touched;
  always_comb begin
    case (s5_axis_i)
      2'd0: neg = s5_neg_i;
      2'd1: neg = {s5_neg_i[0], s5_neg_i[2:1]};
      default: neg = {s5_neg_i[1:0], s5_neg_i[2]};
    endcase
    for (int unsigned n = 0; n < 2; n++) begin
      for (int unsigned k = 0; k < 5; k++) begin
        sample[n][k] = (neg[0] ? s5_sample_i[n][4-k] : s5_sample_i[n][k]) ^
                       {s5_sub_i[n], {2{neg[n+1]}}};
        for (int unsigned h = 0; h < 4; h++) at[n][k][h] = sample[n][k] == 3'(h);
      end
      for (int unsigned i = 0; i < 4; i++) actual[n][i] = at[n][i] | at[n][i+1];
      for (int unsigned i = 0; i < 4; i++) begin
        blocks[n][i][0] = !(s5_sample_i[n][i][2] && s5_sample_i[n][i+1][2]);
        blocks[n][i][1] = s5_sample_i[n][i][2] || s5_sample_i[n][i+1][2];
      end
    end
    touched = '0;
    for (int unsigned i = 0; i < 4; i++) begin
      holds[i] = 2'(i) >= s5_first_i && 2'(i) <= s5_last_i;
      for (int unsigned s = 1; s < 4; s++) begin
        if (holds[i] && blocks[0][i][s%2] && blocks[1][i][s/2]) touched[s] = 1'b1;
      end
    end
    for (int unsigned i = 0; i < 4; i++) actual_holds[i] = neg[0] ? holds[3-i] : holds[i];
  end
  logic [1:0] s6_axis;
  logic [3:0] s6_holds;
  logic [1:0][3:0][3:0] s6_halves;
  always_ff @(posedge clk_i) begin
    if (valid_i[0]) begin
      s6_axis <= s5_axis_i;
      s6_holds <= actual_holds;
      s6_halves <= actual;
      s6_touched_o <= touched;
    end
  end

  // Clock 6: voxels (a, b, c), then in the order x, y, z.
  logic [7:0] met;  // a + 2 b + 4 c
  logic [7:0] turned;
  always_comb begin
    met = '0;
    for (int unsigned v = 0; v < 8; v++) begin
      for (int unsigned j = 0; j < 2; j++) begin
        if (s6_holds[2*(v%2)+j] && s6_halves[0][2*(v%2)+j][2*((v/2)%2)+:2] != '0 &&
            s6_halves[1][2*(v%2)+j][2*(v/4)+:2] != '0) begin
          met[v] = 1'b1;
        end
      end
    end
    // v: a voxel by x, y, z. Its bits in the order a, b, c are rotated by the dominant axis.
    for (int unsigned v = 0; v < 8; v++) begin
      case (s6_axis)
        2'd0: turned[v] = met[v];
        2'd1: turned[v] = met[(v/2)%4+4*(v%2)];  // a is y, b is z, c is x
        default: turned[v] = met[v/4+2*(v%4)];  // a is z, b is x, c is y
      endcase
    end
  end
  always_ff @(posedge clk_i) begin
    if (valid_i[1]) begin
      s7_met_o <= turned;
      s7_way_o <= {s6_axis, s6_holds, s6_halves};
    end
  end
endmodule
