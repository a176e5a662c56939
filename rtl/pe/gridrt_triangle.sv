// The exact test of a segment against a triangle, one a clock (Moeller and Trumbore's arrangement
// in integers, docs/numerics.md section 3):
//   D = P1 - P0, E1 = V1 - V0, E2 = V2 - V0, T = P0 - V0
//   det = E1.(D x E2)   u = T.(D x E2)   v = D.(T x E1)   tn = E2.(T x E1)   w = det - u - v
// A hit has det != 0 and u, v, w, tn and det - tn all zero or of det's sign.
//
// Widths at B = 17: differences 18 bits; minors of D x E2 36 bits, those of T x E1 35 (both vectors
// start at V0); volumes of four points of the box at most 2 (2^B - 1)^3, so u, v, w and tn take
// 3 B + 2 bits with their sign. det is u + v + w: where all have one sign, it is below 2^(3 B + 2), and
// elsewhere there is no hit, whatever is left of det in one bit more.
//
// Minors and sums of products are made in slices of multipliers (gridrt_product_pair,
// gridrt_dot_product): the axes follow each other by a clock.
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
  localparam int unsigned S_W = 3 * B + 3;  // sums
  localparam int unsigned STAGES = 12;

  if (B < 4 || B > 17) begin : gen_illegal
    $error("gridrt_triangle: B must be 4 to 17");
  end

  // Valid bits and what travels along.
  logic [STAGES:1] valid, moves;
  logic enters;
  assign enters = gridrt_pkg::FREE_RUNNING || valid_i;
  assign moves  = gridrt_pkg::FREE_RUNNING ? '1 : valid;
  logic [STAGES:1][META-1:0] meta;
  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) valid <= '0;
    else valid <= {valid[STAGES-1:1], valid_i};
  end
  always_ff @(posedge clk_i) begin
    if (enters) meta[1] <= meta_i;
    for (int unsigned i = 2; i <= STAGES; i++) begin
      if (moves[i-1]) meta[i] <= meta[i-1];
    end
  end

  // 1: differences; what follows is that of tests before, as long as somebody needs it.
  logic [6:1][2:0][17:0] e1, e2, t, d;  // clock, axis
  function automatic logic [17:0] difference(input logic [B-1:0] a, input logic [B-1:0] b);
    difference = 18'(a) - 18'(b);
  endfunction
  always_ff @(posedge clk_i) begin
    if (enters) begin
      for (int unsigned a = 0; a < 3; a++) begin
        e1[1][a] <= difference(v_i[1][a], v_i[0][a]);
        e2[1][a] <= difference(v_i[2][a], v_i[0][a]);
        t[1][a]  <= difference(p0_i[a], v_i[0][a]);
        d[1][a]  <= 18'($signed(d_i[a]));
      end
    end
    for (int unsigned i = 2; i <= 6; i++) begin
      if (moves[i-1]) begin
        e1[i] <= e1[i-1];
        e2[i] <= e2[i-1];
        t[i]  <= t[i-1];
        d[i]  <= d[i-1];
      end
    end
  end

  // 4, 5 and 6: minors of D x E2 and T x E1 on the axes x, y and z, cut to the bits that they can take.
  logic [2:0][35:0] q, r;
  logic [3:0] unused;
  for (genvar a = 0; a < 3; a++) begin : gen_axis
    localparam int unsigned NEXT = (a + 1) % 3;
    localparam int unsigned LAST = (a + 2) % 3;
    logic [53:0] q_sum, r_sum;
    gridrt_product_pair #(
        .SUBTRACT(1'b1)
    ) u_q (
        .clk_i,
        .valid_i(valid[1+a]),
        .a_i({d[1+a][LAST], d[1+a][NEXT]}),
        .b_i({e2[1+a][NEXT], e2[1+a][LAST]}),
        .sum_i('0),
        .sum_o(q_sum)
    );
    gridrt_product_pair #(
        .SUBTRACT(1'b1)
    ) u_r (
        .clk_i,
        .valid_i(valid[1+a]),
        .a_i({t[1+a][LAST], t[1+a][NEXT]}),
        .b_i({e1[1+a][NEXT], e1[1+a][LAST]}),
        .sum_i('0),
        .sum_o(r_sum)
    );
    assign q[a] = q_sum[35:0];
    assign r[a] = r_sum[35:0];
    assign unused[a] = ^{q_sum, r_sum};
  end

  // 9: sums over the axes.
  logic [53:0] det, u, v, tn;
  assign unused[3] = ^{det, u, v, tn};
  gridrt_dot_product u_det (
      .clk_i,
      .valid_i(valid[6:4]),
      .a_i({e1[6][2], e1[5][1], e1[4][0]}),
      .b_i(q),
      .sum_o(det)
  );
  gridrt_dot_product u_u (
      .clk_i,
      .valid_i(valid[6:4]),
      .a_i({t[6][2], t[5][1], t[4][0]}),
      .b_i(q),
      .sum_o(u)
  );
  gridrt_dot_product u_v (
      .clk_i,
      .valid_i(valid[6:4]),
      .a_i({d[6][2], d[5][1], d[4][0]}),
      .b_i(r),
      .sum_o(v)
  );
  gridrt_dot_product u_tn (
      .clk_i,
      .valid_i(valid[6:4]),
      .a_i({e2[6][2], e2[5][1], e2[4][0]}),
      .b_i(r),
      .sum_o(tn)
  );

  // 10: out of the slices, which are far away.
  logic signed [S_W-1:0] det_10, u_10, v_10, tn_10;
  always_ff @(posedge clk_i) begin
    if (moves[9]) begin
      det_10 <= S_W'(det);
      u_10 <= S_W'(u);
      v_10 <= S_W'(v);
      tn_10 <= S_W'(tn);
    end
  end

  // 11: what is left of det.
  logic signed [S_W-1:0] det_11, tn_11, uv_11, rest_11;
  logic u_zero, u_minus, v_zero, v_minus;
  always_ff @(posedge clk_i) begin
    if (moves[10]) begin
      det_11 <= det_10;
      tn_11 <= tn_10;
      uv_11 <= u_10 + v_10;
      rest_11 <= det_10 - tn_10;
      u_zero <= u_10 == '0;
      u_minus <= u_10[S_W-1];
      v_zero <= v_10 == '0;
      v_minus <= v_10[S_W-1];
    end
  end

  // 12: w, magnitudes and the signs that are known.
  logic signed [S_W-1:0] w_12;
  logic [MAG_W-1:0] det_12, tn_12;
  logic good_12, minus_12;
  logic [MAG_W-1:0] det_size, tn_size;
  gridrt_add_sub #(
      .WIDTH(MAG_W)
  ) i_det_size (
      .sub_i(det_11[S_W-1]),
      .a_i  ('0),
      .b_i  (det_11[MAG_W-1:0]),
      .sum_o(det_size)
  );
  gridrt_add_sub #(
      .WIDTH(MAG_W)
  ) i_tn_size (
      .sub_i(tn_11[S_W-1]),
      .a_i  ('0),
      .b_i  (tn_11[MAG_W-1:0]),
      .sum_o(tn_size)
  );
  always_ff @(posedge clk_i) begin
    if (moves[11]) begin
      w_12 <= det_11 - uv_11;
      det_12 <= det_size;
      tn_12 <= tn_size;
      minus_12 <= det_11[S_W-1];
      good_12 <= det_11 != '0 && (u_zero || u_minus == det_11[S_W-1]) &&
          (v_zero || v_minus == det_11[S_W-1]) && (tn_11 == '0 || tn_11[S_W-1] == det_11[S_W-1]) &&
          (rest_11 == '0 || rest_11[S_W-1] == det_11[S_W-1]);
    end
  end

  assign valid_o = valid[STAGES];
  assign hit_o = good_12 && (w_12 == '0 || w_12[S_W-1] == minus_12);
  assign det_o = det_12;
  assign tn_o = tn_12;
  assign meta_o = meta[STAGES];
endmodule
