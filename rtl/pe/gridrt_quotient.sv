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
  localparam int unsigned ACC_W = gridrt_pkg::Q_W + B;

  logic [3:0] left;  // steps to go
  logic [MAG_W-1:0] rest, det;
  logic [gridrt_pkg::Q_W-1:0] quotient;
  logic [B-1:0] length;
  logic [ACC_W-1:0] product;

  // The first bit (2^24) is set for tn = det alone.
  logic whole;
  assign whole = tn_i >= det_i;

  // Two restoring steps.
  logic [MAG_W:0] twice_1, less_1, twice_2, less_2;
  logic [MAG_W-1:0] rest_1, rest_2;
  logic bit_1, bit_2;
  assign twice_1 = {rest, 1'b0};
  assign less_1 = twice_1 - {1'b0, det};
  assign bit_1 = !less_1[MAG_W];
  assign rest_1 = bit_1 ? less_1[MAG_W-1:0] : twice_1[MAG_W-1:0];
  assign twice_2 = {rest_1, 1'b0};
  assign less_2 = twice_2 - {1'b0, det};
  assign bit_2 = !less_2[MAG_W];
  assign rest_2 = bit_2 ? less_2[MAG_W-1:0] : twice_2[MAG_W-1:0];

  // The multiple of the length that the two bits stand for.
  logic [B+1:0] multiple;
  assign multiple = (bit_1 ? {1'b0, length, 1'b0} : '0) + (bit_2 ? {2'b00, length} : '0);

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      left <= '0;
    end else if (start_i) begin
      left <= 4'(STEPS);
    end else if (left != '0) begin
      left <= left - 1'b1;
    end
  end

  always_ff @(posedge clk_i) begin
    if (start_i) begin
      det <= det_i;
      length <= length_i;
      rest <= whole ? tn_i - det_i : tn_i;
      quotient <= {{(gridrt_pkg::Q_W - 1) {1'b0}}, whole};
      product <= whole ? ACC_W'(length_i) : '0;
    end else if (left != '0) begin
      rest <= rest_2;
      quotient <= {quotient[gridrt_pkg::Q_W-3:0], bit_1, bit_2};
      product <= {product[ACC_W-3:0], 2'b00} + ACC_W'(multiple);
    end
  end

  logic [ACC_W:0] next_product;
  assign next_product = {1'b0, product} + (ACC_W + 1)'(length) - 1'b1;

  logic unused;
  assign unused = ^next_product[gridrt_pkg::KEY_BITS-1:0];

  assign busy_o = left != '0;
  assign quotient_o = quotient;
  assign limit_o = gridrt_pkg::DIST_W'(next_product >> gridrt_pkg::KEY_BITS);

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
