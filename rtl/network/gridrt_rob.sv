// Puts answers into the order of the rays: a ray reserves an entry when it gets its slot, its
// answer is written there once, and entries leave in order. Beside an answer lies the parity of the
// round through the memory in which it was written, so that the head knows an answer of this round
// from one of the round before. After reset the memory is filled first. It is block memory, which
// answers a clock after it is asked: each clock asks for what will be the head in the next one.
module gridrt_rob #(
    parameter int unsigned ROB = 256,  // entries, a power of two
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

  // The upper bit is the parity of the round.
  logic [ENTRY_W:0] head, tail, fill;
  logic [ENTRY_W:0] reserved;
  logic [ID_W+1:0] head_data;
  logic leave, filling, write, write_round, collides, known;
  logic [ENTRY_W-1:0] write_address, head_next;
  assign filling = !fill[ENTRY_W];
  // Entries below the tail's are of its round, the others of the one before.
  assign write_round = (write_entry_i < tail[ENTRY_W-1:0]) ? tail[ENTRY_W] : !tail[ENTRY_W];
  assign write = write_i || filling;
  assign write_address = filling ? fill[ENTRY_W-1:0] : write_entry_i;
  assign head_next = head[ENTRY_W-1:0] + ENTRY_W'(leave);
  // What is read of an entry while it is written is not defined.
  assign collides = write && write_address == head_next;

  (* ram_style = "block", no_rw_check *)
  logic [ID_W+1:0] answers[ROB];
  always_ff @(posedge clk_i) begin
    if (write) answers[write_address] <= {!filling && write_round, write_hit_i, write_id_i};
    head_data <= answers[head_next];
`ifdef GRIDRT_ASSERT
    if (collides) head_data <= ~answers[head_next];
`endif
  end

  assign room_o = reserved != (ENTRY_W + 1)'(ROB) && !filling;
  assign entry_o = tail[ENTRY_W-1:0];
  // Rounds begin with 1: the memory was filled with 0.
  assign leave = known && head_data[ID_W+1] == head[ENTRY_W] && (!hit_valid_o || hit_ready_i);

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      fill <= '0;
      head <= {1'b1, ENTRY_W'(0)};
      tail <= {1'b1, ENTRY_W'(0)};
      reserved <= '0;
      known <= 1'b0;
      hit_valid_o <= 1'b0;
      hit_o <= 1'b0;
      id_o <= '0;
    end else begin
      known <= !collides && !filling;
      if (filling) fill <= fill + 1'b1;
      if (reserve_i) tail <= tail + 1'b1;
      if (reserve_i && !leave) reserved <= reserved + 1'b1;
      if (leave && !reserve_i) reserved <= reserved - 1'b1;
      if (hit_ready_i) hit_valid_o <= 1'b0;
      if (leave) begin
        head <= head + 1'b1;
        hit_valid_o <= 1'b1;
        {hit_o, id_o} <= head_data[ID_W:0];
      end
    end
  end

`ifdef GRIDRT_ASSERT
  logic [ROB-1:0] answered;
  logic [ENTRY_W-1:0] age;
  assign age = write_entry_i - head[ENTRY_W-1:0];
  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      answered <= '0;
    end else begin
      if (write_i) answered[write_entry_i] <= 1'b1;
      if (leave) answered[head[ENTRY_W-1:0]] <= 1'b0;
    end
  end
  always_ff @(posedge clk_i) begin
    if (rst_ni) begin
      assert (reserved <= (ENTRY_W + 1)'(ROB));
      assert (!(reserve_i && !room_o));
      // A ray commits once, into an entry that it holds.
      assert (!(write_i && answered[write_entry_i]));
      assert (!(write_i && {1'b0, age} >= reserved));
      assert (!(leave && !answered[head[ENTRY_W-1:0]]));
    end
  end
`endif
endmodule
