// Delays a word by CLOCKS clocks in which enable_i is high, in distributed memory: for what rides
// along beside a long pipeline.
module gridrt_delay #(
    parameter int unsigned WIDTH  = 8,
    parameter int unsigned CLOCKS = 16  // >= 2
) (
    input  logic             clk_i,
    input  logic             rst_ni,
    input  logic             enable_i,
    input  logic [WIDTH-1:0] data_i,
    output logic [WIDTH-1:0] data_o
);
  // A ring of CLOCKS - 1 words and a register behind it.
  localparam int unsigned DEPTH = CLOCKS - 1;
  localparam int unsigned INDEX_W = (DEPTH > 1) ? $clog2(DEPTH) : 1;

  if (WIDTH < 1 || CLOCKS < 2) begin : gen_illegal
    $error("gridrt_delay: WIDTH must be positive and CLOCKS at least 2");
  end

  logic [INDEX_W-1:0] index;
  logic [WIDTH-1:0] oldest;

  gridrt_lutram #(
      .WIDTH(WIDTH),
      .DEPTH(DEPTH)
  ) i_ring (
      .clk_i,
      .write_i(enable_i),
      .write_address_i(index),
      .write_data_i(data_i),
      .read_address_i(index),
      .read_data_o(oldest)
  );

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) index <= '0;
    else if (enable_i) index <= (index == INDEX_W'(DEPTH - 1)) ? '0 : index + 1'b1;
  end
  always_ff @(posedge clk_i) begin
    if (enable_i) data_o <= oldest;
  end
endmodule
