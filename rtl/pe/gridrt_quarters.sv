// A reference's code: a declet of densely packed decimal of three digits, each an interval of
// quarters of the voxel (QUARTER_INTERVALS of the protocol).
module gridrt_quarters (
    input  logic [9:0]      code_i,
    output logic [2:0][3:0] masks_o  // z, y, x
);
  logic [2:0] big;  // digits of 8 or 9
  logic [2:0][2:0] small_digit;  // the others; of large ones the lowest bit
  always_comb begin
    big = '0;
    small_digit = {code_i[9:7], code_i[6:4], code_i[2:0]};
    if (code_i[3]) begin
      case (code_i[2:1])
        2'd0: big = 3'b001;
        2'd1: begin
          big = 3'b010;
          small_digit[0][2:1] = code_i[6:5];
        end
        2'd2: begin
          big = 3'b100;
          small_digit[0][2:1] = code_i[9:8];
        end
        default: begin
          big = {code_i[6:5] != 2'd2, code_i[6:5] != 2'd1, code_i[6:5] != 2'd0};
          small_digit[1][2:1] = code_i[9:8];
          small_digit[0][2:1] = code_i[9:8];
        end
      endcase
    end
    for (int unsigned a = 0; a < 3; a++) begin
      if (big[a]) begin
        masks_o[a] = small_digit[a][0] ? 4'hF : 4'hE;
      end else begin
        case (small_digit[a])
          3'd0: masks_o[a] = 4'h1;
          3'd1: masks_o[a] = 4'h2;
          3'd2: masks_o[a] = 4'h4;
          3'd3: masks_o[a] = 4'h8;
          3'd4: masks_o[a] = 4'h3;
          3'd5: masks_o[a] = 4'h6;
          3'd6: masks_o[a] = 4'hC;
          default: masks_o[a] = 4'h7;
        endcase
      end
    end
  end
endmodule
