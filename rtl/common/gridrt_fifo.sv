// First in, first out; the head is visible while out_valid_o is high (distributed memory). Takes
// and gives one element a clock.
module gridrt_fifo #(
    parameter int unsigned WIDTH = 8,
    parameter int unsigned DEPTH = 4,  // >= 1
    localparam int unsigned COUNT_W = $clog2(DEPTH + 1)
) (
    input  logic               clk_i,
    input  logic               rst_ni,
    input  logic               in_valid_i,
    output logic               in_ready_o,
    input  logic [  WIDTH-1:0] in_data_i,
    output logic               out_valid_o,
    input  logic               out_ready_i,
    output logic [  WIDTH-1:0] out_data_o,
    output logic [COUNT_W-1:0] count_o
);
  localparam int unsigned INDEX_W = (DEPTH > 1) ? $clog2(DEPTH) : 1;
  localparam logic [INDEX_W-1:0] LAST = INDEX_W'(DEPTH - 1);

  if (WIDTH < 1 || DEPTH < 1) begin : gen_illegal
    $error("gridrt_fifo: WIDTH and DEPTH must be positive");
  end

  logic [WIDTH-1:0] memory[DEPTH];
  logic [INDEX_W-1:0] head, tail;
  logic [COUNT_W-1:0] count;
  logic push, pop;

  assign in_ready_o = count != COUNT_W'(DEPTH);
  assign out_valid_o = count != '0;
  assign out_data_o = memory[head];
  assign count_o = count;
  assign push = in_valid_i && in_ready_o;
  assign pop = out_valid_o && out_ready_i;

  always_ff @(posedge clk_i) begin
    if (push) memory[tail] <= in_data_i;
  end

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      head  <= '0;
      tail  <= '0;
      count <= '0;
    end else begin
      if (push) tail <= (tail == LAST) ? '0 : tail + 1'b1;
      if (pop) head <= (head == LAST) ? '0 : head + 1'b1;
      if (push && !pop) count <= count + 1'b1;
      if (pop && !push) count <= count - 1'b1;
    end
  end

`ifdef GRIDRT_ASSERT
  always_ff @(posedge clk_i) begin
    if (rst_ni) begin
      assert (count <= COUNT_W'(DEPTH));
    end
  end
`endif
endmodule
