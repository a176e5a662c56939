// What the block's record says, clocks 3 to 9 of a step: is it occupied, where are its cells, and how
// many block-slabs may be left behind because nothing lies within as many blocks around.
module gridrt_march_record (
    input  logic        clk_i,
    input  logic [5:0]  valid_i,        // of clocks 8 to 3
    input  logic [21:0] s3_data_i,      // occupied, then the record
    input  logic [1:0]  s3_axis_i,
    input  logic [2:0]  s3_neg_i,
    input  logic        s3_aside_i,     // a neighbour of the ray's block: its jump does not count
    output logic [2:0]  s3_ahead_o,     // block-slabs on, 1 .. 7, if the slab is done with
    output logic [2:0]  s8_jump_o,      // 0: there is no jump
    output logic [2:0]  s9_jump_o,
    output logic        s9_occupied_o,
    output logic [20:0] s9_record_o
);
  logic [2:0] s3_jump;
  always_comb begin
    s3_jump = 3'd0;
    for (int unsigned a = 0; a < 3; a++) begin
      if (s3_axis_i == 2'(a)) s3_jump = s3_neg_i[a] ? s3_data_i[6*a+3+:3] : s3_data_i[6*a+:3];
    end
    if (s3_data_i[21] || s3_aside_i) s3_jump = 3'd0;
    s3_ahead_o = (s3_jump != 3'd0) ? s3_jump : 3'd1;
  end

  // {jump, occupied, record} in clocks 4 to 9.
  localparam int unsigned WIDTH = 3 + 22;
  logic [5:0][WIDTH-1:0] stage;
  always_ff @(posedge clk_i) begin
    if (valid_i[0]) stage[0] <= {s3_jump, s3_data_i};
    for (int unsigned i = 1; i < 6; i++) begin
      if (valid_i[i]) stage[i] <= stage[i-1];
    end
  end
  assign s8_jump_o = stage[4][WIDTH-1-:3];
  assign {s9_jump_o, s9_occupied_o, s9_record_o} = stage[5];
endmodule
