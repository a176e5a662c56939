// Quotient and limit of a hit, two bits a clock, 13 clocks in all:
//   quotient = floor(2^24 tn / det), 0 <= tn <= det, det > 0
//   limit    = ceil((quotient + 1) length / 2^24) - 1 = floor(((quotient + 1) length - 1) / 2^24),
// the largest whole distance n along the dominant axis with floor(2^24 n / length) <= quotient.
// The product quotient * length grows along with the quotient's bits (Horner's scheme).
module gridrt_quotient #(
    parameter int unsigned B = 17,
    localparam int unsigned MAG_W = 3 * B + 2
) (
    input  logic                        clk_i,
    input  logic                        rst_ni,
    input  logic                        start_i,   // only while not busy
    input  logic [MAG_W-1:0]            tn_i,
    input  logic [MAG_W-1:0]            det_i,
    input  logic [B-1:0]                length_i,  // |d| along the dominant axis, >= 1
    output logic                        busy_o,
    output logic [gridrt_pkg::Q_W-1:0]  quotient_o,  // these two hold from the end to the next start
    output logic [gridrt_pkg::DIST_W-1:0] limit_o
);
  localparam int unsigned STEPS = gridrt_pkg::KEY_BITS / 2;
  localparam int unsigned ACC_W = gridrt_pkg::KEY_BITS + B;

  logic [3:0] left;  // steps to go
  logic [MAG_W:0] rest;  // signed
  logic [MAG_W-1:0] det;
  logic [gridrt_pkg::Q_W-1:0] quotient;
  logic [B-1:0] length;
  logic [ACC_W-1:0] product;  // (quotient + 1) length - 1, but the length alone at first

  // The first bit (2^24) is set for tn = det alone, which the steps leave as it is: all their bits are
  // ones then, of which the quotient takes none.
  logic whole, stays_whole;
  assign whole = tn_i == det_i;

  // Two steps that do not restore: a negative rest is followed by a sum.
  logic [MAG_W:0] first, last;
  logic no_bit_1, no_bit_2;
  gridrt_add_sub #(
      .WIDTH(MAG_W + 1)
  ) i_first (
      .sub_i(!rest[MAG_W]),
      .a_i  ({rest[MAG_W-1:0], 1'b0}),
      .b_i  ({1'b0, det}),
      .sum_o(first)
  );
  gridrt_add_sub #(
      .WIDTH(MAG_W + 1)
  ) i_last (
      .sub_i(!first[MAG_W]),
      .a_i  ({first[MAG_W-1:0], 1'b0}),
      .b_i  ({1'b0, det}),
      .sum_o(last)
  );
  assign no_bit_1 = first[MAG_W];
  assign no_bit_2 = last[MAG_W];

  // The product is 4 times what it was, with 3 for the 1 that it lacks, less the length for each unit
  // that the two bits are short of 3. In the first step it lacks nothing yet, and the 1 is taken away;
  // for tn = det it never is, which leaves as much above 2^24 as 2^24 + 1 lengths do. It follows the
  // bits by a clock; the limit does not wait for the register.
  logic [B+1:0] multiple;
  logic lacks, product_below, follows, was_bit_1, was_bit_2;
  logic [ACC_W-1:0] next_product;
  assign {next_product, product_below} = {product[ACC_W-3:0], {3{lacks}}} - {(ACC_W)'(multiple), 1'b1};
  gridrt_add_gated #(  // as a module of its own it does not become one slow sum of three
      .WIDTH(B + 2)
  ) i_multiple (
      .a_valid_i(!was_bit_1),
      .a_i({1'b0, length, 1'b0}),
      .b_valid_i(!was_bit_2),
      .b_i({2'b00, length}),
      .sum_o(multiple)
  );

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      left <= '0;
      follows <= 1'b0;
    end else begin
      follows <= left != '0;
      if (start_i) left <= 4'(STEPS);
      else if (left != '0) left <= left - 1'b1;
    end
  end

  always_ff @(posedge clk_i) begin
    if (start_i) begin
      det <= det_i;
      length <= length_i;
      stays_whole <= whole;
      rest <= {1'b0, tn_i};
      quotient <= {{(gridrt_pkg::Q_W - 1) {1'b0}}, whole};
      product <= ACC_W'(length_i);
      lacks <= whole;
    end else if (left != '0) begin
      rest <= last;
      was_bit_1 <= !no_bit_1;
      was_bit_2 <= !no_bit_2;
      quotient <= {quotient[gridrt_pkg::Q_W-3:0], !no_bit_1 && !stays_whole, !no_bit_2 && !stays_whole};
    end
    if (follows && !start_i) begin
      product <= next_product;
      lacks <= 1'b1;
    end
  end

  logic unused;
  assign unused = product_below;

  assign busy_o = left != '0;
  assign quotient_o = quotient;
  assign limit_o = gridrt_pkg::DIST_W'((follows ? next_product : product) >> gridrt_pkg::KEY_BITS);

`ifdef GRIDRT_ASSERT
  always_ff @(posedge clk_i) begin
    if (rst_ni && start_i) begin
      assert (!busy_o);
      assert (tn_i <= det_i);
      assert (det_i != '0);
      assert (length_i != '0);
    end
  end
`endif
endmodule
