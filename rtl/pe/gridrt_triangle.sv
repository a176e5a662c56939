// The exact test of a segment against a triangle, one a clock (Moeller and Trumbore's arrangement
// in integers, docs/numerics.md section 3):
//   D = P1 - P0, E1 = V1 - V0, E2 = V2 - V0, T = P0 - V0
//   det = E1.(D x E2)   u = T.(D x E2)   v = D.(T x E1)   tn = E2.(T x E1)   w = det - u - v
// A hit has det != 0 and u, v, w, tn and det - tn all zero or of det's sign.
//
// Widths at B = 17: differences 18 bits; minors of D x E2 36 bits, those of T x E1 35 (both vectors
// start at V0); volumes of four points of the box at most 2 (2^B - 1)^3, so u, v, w and tn take
// 3 B + 2 bits with their sign, and det, which is u + v + w, two more. Where all have one sign, det is below 2^(3 B + 2).
module gridrt_triangle #(
    parameter int unsigned B = 17,
    parameter int unsigned META = 8,  // bits that travel along
    localparam int unsigned MAG_W = 3 * B + 2  // |det| and |tn| of a hit
) (
    input  logic                 clk_i,
    input  logic                 rst_ni,
    input  logic                 valid_i,
    input  logic [2:0][B-1:0]    p0_i,
    input  logic [2:0][B:0]      d_i,      // signed
    input  logic [2:0][2:0][B-1:0] v_i,    // corner, axis
    input  logic [META-1:0]      meta_i,
    output logic                 valid_o,
    output logic                 hit_o,
    output logic [MAG_W-1:0]     tn_o,     // |tn| of a hit
    output logic [MAG_W-1:0]     det_o,    // |det| of a hit
    output logic [META-1:0]      meta_o
);
  localparam int unsigned D_W = B + 1;  // differences
  localparam int unsigned Q_W = 2 * B + 2;  // minors of D x E2
  localparam int unsigned R_W = 2 * B + 1;  // minors of T x E1
  localparam int unsigned S_W = 3 * B + 4;  // sums
  localparam int unsigned STAGES = 8;

  if (B < 4 || B > 17) begin : gen_illegal
    $error("gridrt_triangle: B must be 4 to 17");
  end

  // Valid bits and what travels along.
  logic [STAGES:1] valid;
  logic [STAGES:1][META-1:0] meta;
  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) valid <= '0;
    else valid <= {valid[STAGES-1:1], valid_i};
  end
  always_ff @(posedge clk_i) begin
    if (valid_i) meta[1] <= meta_i;
    for (int unsigned i = 2; i <= STAGES; i++) begin
      if (valid[i-1]) meta[i] <= meta[i-1];
    end
  end

  // 1: differences.
  logic signed [D_W-1:0] e1_x, e1_y, e1_z, e2_x, e2_y, e2_z, t_x, t_y, t_z, d_x, d_y, d_z;
  always_ff @(posedge clk_i) begin
    if (valid_i) begin
      e1_x <= $signed({1'b0, v_i[1][0]}) - $signed({1'b0, v_i[0][0]});
      e1_y <= $signed({1'b0, v_i[1][1]}) - $signed({1'b0, v_i[0][1]});
      e1_z <= $signed({1'b0, v_i[1][2]}) - $signed({1'b0, v_i[0][2]});
      e2_x <= $signed({1'b0, v_i[2][0]}) - $signed({1'b0, v_i[0][0]});
      e2_y <= $signed({1'b0, v_i[2][1]}) - $signed({1'b0, v_i[0][1]});
      e2_z <= $signed({1'b0, v_i[2][2]}) - $signed({1'b0, v_i[0][2]});
      t_x  <= $signed({1'b0, p0_i[0]}) - $signed({1'b0, v_i[0][0]});
      t_y  <= $signed({1'b0, p0_i[1]}) - $signed({1'b0, v_i[0][1]});
      t_z  <= $signed({1'b0, p0_i[2]}) - $signed({1'b0, v_i[0][2]});
      d_x  <= $signed(d_i[0]);
      d_y  <= $signed(d_i[1]);
      d_z  <= $signed(d_i[2]);
    end
  end

  // 2: products of the minors.
  logic signed [2*D_W-1:0] q_yz, q_zy, q_zx, q_xz, q_xy, q_yx;
  logic signed [2*D_W-1:0] r_yz, r_zy, r_zx, r_xz, r_xy, r_yx;
  logic [2:0][D_W-1:0] e1_2, e2_2, t_2, d_2;
  always_ff @(posedge clk_i) begin
    if (valid[1]) begin
      q_yz <= d_y * e2_z;
      q_zy <= d_z * e2_y;
      q_zx <= d_z * e2_x;
      q_xz <= d_x * e2_z;
      q_xy <= d_x * e2_y;
      q_yx <= d_y * e2_x;
      r_yz <= t_y * e1_z;
      r_zy <= t_z * e1_y;
      r_zx <= t_z * e1_x;
      r_xz <= t_x * e1_z;
      r_xy <= t_x * e1_y;
      r_yx <= t_y * e1_x;
      e1_2 <= {e1_z, e1_y, e1_x};
      e2_2 <= {e2_z, e2_y, e2_x};
      t_2  <= {t_z, t_y, t_x};
      d_2  <= {d_z, d_y, d_x};
    end
  end

  // 3: minors, cut to the bits that they can take.
  logic signed [Q_W-1:0] q_x, q_y, q_z;
  logic signed [R_W-1:0] r_x, r_y, r_z;
  logic [2:0][D_W-1:0] e1_3, e2_3, t_3, d_3;
  always_ff @(posedge clk_i) begin
    if (valid[2]) begin
      q_x  <= Q_W'(q_yz - q_zy);
      q_y  <= Q_W'(q_zx - q_xz);
      q_z  <= Q_W'(q_xy - q_yx);
      r_x  <= R_W'(r_yz - r_zy);
      r_y  <= R_W'(r_zx - r_xz);
      r_z  <= R_W'(r_xy - r_yx);
      e1_3 <= e1_2;
      e2_3 <= e2_2;
      t_3  <= t_2;
      d_3  <= d_2;
    end
  end

  // 4: products of the determinants.
  logic signed [D_W+Q_W-1:0] det_x, det_y, det_z, u_x, u_y, u_z;
  logic signed [D_W+R_W-1:0] v_x, v_y, v_z, tn_x, tn_y, tn_z;
  always_ff @(posedge clk_i) begin
    if (valid[3]) begin
      det_x <= $signed(e1_3[0]) * q_x;
      det_y <= $signed(e1_3[1]) * q_y;
      det_z <= $signed(e1_3[2]) * q_z;
      u_x   <= $signed(t_3[0]) * q_x;
      u_y   <= $signed(t_3[1]) * q_y;
      u_z   <= $signed(t_3[2]) * q_z;
      v_x   <= $signed(d_3[0]) * r_x;
      v_y   <= $signed(d_3[1]) * r_y;
      v_z   <= $signed(d_3[2]) * r_z;
      tn_x  <= $signed(e2_3[0]) * r_x;
      tn_y  <= $signed(e2_3[1]) * r_y;
      tn_z  <= $signed(e2_3[2]) * r_z;
    end
  end

  // 5 and 6: sums.
  logic signed [S_W-1:0] det_5, det_z5, u_5, u_z5, v_5, v_z5, tn_5, tn_z5;
  logic signed [S_W-1:0] det_6, u_6, v_6, tn_6;
  always_ff @(posedge clk_i) begin
    if (valid[4]) begin
      det_5  <= S_W'(det_x) + S_W'(det_y);
      det_z5 <= S_W'(det_z);
      u_5    <= S_W'(u_x) + S_W'(u_y);
      u_z5   <= S_W'(u_z);
      v_5    <= S_W'(v_x) + S_W'(v_y);
      v_z5   <= S_W'(v_z);
      tn_5   <= S_W'(tn_x) + S_W'(tn_y);
      tn_z5  <= S_W'(tn_z);
    end
    if (valid[5]) begin
      det_6 <= det_5 + det_z5;
      u_6   <= u_5 + u_z5;
      v_6   <= v_5 + v_z5;
      tn_6  <= tn_5 + tn_z5;
    end
  end

  // 7: what is left of det.
  logic signed [S_W-1:0] det_7, tn_7, uv_7, rest_7;
  logic u_zero, u_minus, v_zero, v_minus;
  always_ff @(posedge clk_i) begin
    if (valid[6]) begin
      det_7   <= det_6;
      tn_7    <= tn_6;
      uv_7    <= u_6 + v_6;
      rest_7  <= det_6 - tn_6;
      u_zero  <= u_6 == '0;
      u_minus <= u_6[S_W-1];
      v_zero  <= v_6 == '0;
      v_minus <= v_6[S_W-1];
    end
  end

  // 8: w, magnitudes and the signs that are known.
  logic signed [S_W-1:0] w_8;
  logic [MAG_W-1:0] det_8, tn_8;
  logic good_8, minus_8;
  logic [MAG_W-1:0] det_size, tn_size;
  gridrt_add_sub #(
      .WIDTH(MAG_W)
  ) i_det_size (
      .sub_i(det_7[S_W-1]),
      .a_i  ('0),
      .b_i  (det_7[MAG_W-1:0]),
      .sum_o(det_size)
  );
  gridrt_add_sub #(
      .WIDTH(MAG_W)
  ) i_tn_size (
      .sub_i(tn_7[S_W-1]),
      .a_i  ('0),
      .b_i  (tn_7[MAG_W-1:0]),
      .sum_o(tn_size)
  );
  always_ff @(posedge clk_i) begin
    if (valid[7]) begin
      w_8 <= det_7 - uv_7;
      det_8 <= det_size;
      tn_8 <= tn_size;
      minus_8 <= det_7[S_W-1];
      good_8 <= det_7 != '0 && (u_zero || u_minus == det_7[S_W-1]) &&
          (v_zero || v_minus == det_7[S_W-1]) && (tn_7 == '0 || tn_7[S_W-1] == det_7[S_W-1]) &&
          (rest_7 == '0 || rest_7[S_W-1] == det_7[S_W-1]);
    end
  end

  assign valid_o = valid[STAGES];
  assign hit_o = good_8 && (w_8 == '0 || w_8[S_W-1] == minus_8);
  assign det_o = det_8;
  assign tn_o = tn_8;
  assign meta_o = meta[STAGES];
endmodule
