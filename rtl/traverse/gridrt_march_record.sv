// What the block's record says, clocks 3 to 7 of a step: is it occupied, where are its cells, and how
// many block-slabs may be left behind because nothing lies within as many blocks around.
module gridrt_march_record (
    input  logic        clk_i,
    input  logic [3:0]  valid_i,        // of clocks 6 to 3
    input  logic [21:0] s3_data_i,      // occupied, then the record
    input  logic [1:0]  s3_axis_i,
    input  logic [2:0]  s3_neg_i,
    input  logic        s3_aside_i,     // a neighbour of the ray's block: its jump does not count
    output logic [2:0]  s3_ahead_o,     // block-slabs on, 1 .. 7, if the slab is done with
    output logic [2:0]  s6_jump_o,      // 0: there is no jump
    output logic [2:0]  s7_jump_o,
    output logic        s7_occupied_o,
    output logic [20:0] s7_record_o
);
  logic s3_occupied, s4_occupied, s5_occupied, s6_occupied;
  logic [20:0] s3_record, s4_record, s5_record, s6_record;
  logic [2:0] s3_jump, s4_jump, s5_jump;
  assign s3_occupied = s3_data_i[21];
  assign s3_record = s3_data_i[20:0];
  always_comb begin
    s3_jump = 3'd0;
    for (int unsigned a = 0; a < 3; a++) begin
      if (s3_axis_i == 2'(a)) s3_jump = s3_neg_i[a] ? s3_record[6*a+3+:3] : s3_record[6*a+:3];
    end
    if (s3_occupied || s3_aside_i) s3_jump = 3'd0;
    s3_ahead_o = (s3_jump != 3'd0) ? s3_jump : 3'd1;
  end
  always_ff @(posedge clk_i) begin
    if (valid_i[0]) begin
      s4_jump <= s3_jump;
      s4_occupied <= s3_occupied;
      s4_record <= s3_record;
    end
    if (valid_i[1]) begin
      s5_jump <= s4_jump;
      s5_occupied <= s4_occupied;
      s5_record <= s4_record;
    end
    if (valid_i[2]) begin
      s6_jump_o <= s5_jump;
      s6_occupied <= s5_occupied;
      s6_record <= s5_record;
    end
    if (valid_i[3]) begin
      s7_jump_o <= s6_jump_o;
      s7_occupied_o <= s6_occupied;
      s7_record_o <= s6_record;
    end
  end
endmodule
