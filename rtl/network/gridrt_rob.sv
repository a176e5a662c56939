// Puts answers into the order of the rays: a ray reserves an entry when it gets its slot, its
// answer is written there once, and entries leave in order.
module gridrt_rob #(
    parameter int unsigned ROB = 128,  // entries, a power of two
    localparam int unsigned ENTRY_W = $clog2(ROB)
) (
    input  logic                        clk_i,
    input  logic                        rst_ni,
    output logic                        room_o,  // entry_o can be reserved
    output logic [ENTRY_W-1:0]          entry_o,
    input  logic                        reserve_i,  // only while room_o
    input  logic                        write_i,
    input  logic [ENTRY_W-1:0]          write_entry_i,
    input  logic                        write_hit_i,
    input  logic [gridrt_pkg::ID_W-1:0] write_id_i,
    output logic                        hit_valid_o,
    input  logic                        hit_ready_i,
    output logic                        hit_o,
    output logic [gridrt_pkg::ID_W-1:0] id_o
);
  localparam int unsigned ID_W = gridrt_pkg::ID_W;

  if (ROB < 2 || (1 << ENTRY_W) != ROB) begin : gen_illegal
    $error("gridrt_rob: ROB must be a power of two");
  end

  logic [ROB-1:0] answered;
  logic [ENTRY_W-1:0] head;
  logic [ENTRY_W:0] reserved;
  logic [ENTRY_W-1:0] tail;
  logic [ID_W:0] head_data;
  logic leave;

  gridrt_lutram #(
      .WIDTH(ID_W + 1),
      .DEPTH(ROB)
  ) u_answers (
      .clk_i,
      .write_i,
      .write_address_i(write_entry_i),
      .write_data_i({write_hit_i, write_id_i}),
      .read_address_i(head),
      .read_data_o(head_data)
  );

  assign room_o = reserved != (ENTRY_W + 1)'(ROB);
  assign entry_o = tail;
  assign leave = answered[head] && (!hit_valid_o || hit_ready_i);

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      answered <= '0;
      head <= '0;
      tail <= '0;
      reserved <= '0;
      hit_valid_o <= 1'b0;
      hit_o <= 1'b0;
      id_o <= '0;
    end else begin
      if (write_i) answered[write_entry_i] <= 1'b1;
      if (reserve_i) tail <= tail + 1'b1;
      if (reserve_i && !leave) reserved <= reserved + 1'b1;
      if (leave && !reserve_i) reserved <= reserved - 1'b1;
      if (hit_ready_i) hit_valid_o <= 1'b0;
      if (leave) begin
        answered[head] <= 1'b0;
        head <= head + 1'b1;
        hit_valid_o <= 1'b1;
        {hit_o, id_o} <= head_data;
      end
    end
  end

`ifdef GRIDRT_ASSERT
  logic [ENTRY_W-1:0] age;
  assign age = write_entry_i - head;
  always_ff @(posedge clk_i) begin
    if (rst_ni) begin
      assert (reserved <= (ENTRY_W + 1)'(ROB));
      assert (!(reserve_i && !room_o));
      // A ray commits once, into an entry that it holds.
      assert (!(write_i && answered[write_entry_i]));
      assert (!(write_i && {1'b0, age} >= reserved));
    end
  end
`endif
endmodule
