// The event log: what the engine's tap tells of a ray's life, as words of 32 bits, oldest first.
// Events of one source are in order; of events in the same clock, and while words wait for their
// turn, what usually comes first in a ray's life is written first. Meant for a single ray in
// flight: with more, events are lost (overflow_o). Bits 31 to 28 of a word say what it is:
//
//   1  step       27:20 blocks moved ahead  19:12 voxels that become tasks  11:0 block
//   2  task       25:16 references  15:2 first reference  1:0 PE; a word 3 follows
//   3  (task)     25:8 entry, lattice steps along the dominant axis  7:0 octants
//   4  test       14 hit  13:2 triangle's index in the PE's memory  1:0 PE
//   5  drop       2 cancelled by an earlier hit (0: all references masked or without a hit)  1:0 PE
//   6  drop       a voxel is cancelled before it becomes a task
//   7  hit        24:0 quotient; a word 8 follows
//   8  (hit)      19:0 local id
//   9  interrupt  17:0 limit, lattice steps along the dominant axis
//  10  commit     20 hit  19:0 local id
module gridrt_log #(
    parameter int unsigned WORDS = 512,  // a power of two
    localparam int unsigned INDEX_W = $clog2(WORDS)
) (
    input  logic                           clk_i,
    input  logic                           rst_ni,
    input  logic                           begin_i,  // empty the log and record
    input  logic                           stop_i,  // record no more
    output logic                           on_o,
    input  gridrt_pkg::tap_t               tap_i,
    output logic             [INDEX_W:0]   count_o,
    output logic                           overflow_o,  // events were lost since begin_i
    output logic             [31:0]        word_o,  // the oldest, two clocks after the last take_i
    input  logic                           take_i
);
  localparam int unsigned SOURCES = 14;
  localparam int unsigned TASK = 1;
  localparam int unsigned HIT = 11;

  if (WORDS < 16 || (1 << INDEX_W) != WORDS) begin : gen_illegal
    $error("gridrt_log: WORDS must be a power of two, 16 or more");
  end

  logic on;
  logic [SOURCES-1:0] event_valid, missed, valid, taken;
  logic [SOURCES-1:0][31:0] words;
  logic [31:0] task_more, hit_more;

  // Each source has a queue of its own, as several may speak in one clock.
  always_comb begin
    event_valid = {
      tap_i.commit_valid, tap_i.interrupt_valid, tap_i.hit_valid, tap_i.drop_valid,
      tap_i.test_valid, tap_i.expand_drop, tap_i.task_valid, tap_i.step_valid
    };
    if (!on) event_valid = '0;
  end

  gridrt_log_queue #(
      .WIDTH(28)
  ) u_step (
      .clk_i,
      .rst_ni,
      .push_i(event_valid[0]),
      .data_i({tap_i.step_jump, tap_i.step_cand, tap_i.step_block}),
      .lost_o(missed[0]),
      .valid_o(valid[0]),
      .data_o(words[0][27:0]),
      .take_i(taken[0])
  );
  assign words[0][31:28] = 4'd1;

  gridrt_log_queue #(
      .WIDTH(52)
  ) u_task (
      .clk_i,
      .rst_ni,
      .push_i(event_valid[TASK]),
      .data_i({tap_i.task_enter, tap_i.task_octants,
                  tap_i.task_count, tap_i.task_first, tap_i.task_pe}),
      .lost_o(missed[TASK]),
      .valid_o(valid[TASK]),
      .data_o({task_more[25:0], words[TASK][25:0]}),
      .take_i(taken[TASK])
  );
  assign words[TASK][31:26] = {4'd2, 2'd0};
  assign task_more[31:26] = {4'd3, 2'd0};

  // How often does what is without data.
  logic [3:0] expand_drops;
  assign missed[2] = event_valid[2] && expand_drops == '1;
  assign valid[2] = expand_drops != '0;
  assign words[2] = {4'd6, 28'd0};
  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) expand_drops <= '0;
    else expand_drops <= expand_drops + 4'(event_valid[2] && !missed[2]) - 4'(taken[2]);
  end

  for (genvar p = 0; p < 4; p++) begin : gen_pe
    gridrt_log_queue #(
        .WIDTH(13),
        .DEPTH(32)
    ) u_test (
        .clk_i,
        .rst_ni,
        .push_i(event_valid[3+p]),
        .data_i({tap_i.test_hit[p], tap_i.test_triangle[p]}),
        .lost_o(missed[3+p]),
        .valid_o(valid[3+p]),
        .data_o(words[3+p][14:2]),
        .take_i(taken[3+p])
    );
    assign words[3+p][31:15] = {4'd4, 13'd0};
    assign words[3+p][1:0] = 2'(p);
    gridrt_log_queue #(
        .WIDTH(1)
    ) u_drop (
        .clk_i,
        .rst_ni,
        .push_i(event_valid[7+p]),
        .data_i(tap_i.drop_cancelled[p]),
        .lost_o(missed[7+p]),
        .valid_o(valid[7+p]),
        .data_o(words[7+p][2]),
        .take_i(taken[7+p])
    );
    assign words[7+p][31:3] = {4'd5, 25'd0};
    assign words[7+p][1:0] = 2'(p);
  end

  gridrt_log_queue #(
      .WIDTH(45)
  ) u_hit (
      .clk_i,
      .rst_ni,
      .push_i(event_valid[HIT]),
      .data_i({tap_i.hit_id, tap_i.hit_quotient}),
      .lost_o(missed[HIT]),
      .valid_o(valid[HIT]),
      .data_o({hit_more[19:0], words[HIT][24:0]}),
      .take_i(taken[HIT])
  );
  assign words[HIT][31:25] = {4'd7, 3'd0};
  assign hit_more[31:20] = {4'd8, 8'd0};

  gridrt_log_queue #(
      .WIDTH(18)
  ) u_interrupt (
      .clk_i,
      .rst_ni,
      .push_i(event_valid[12]),
      .data_i(tap_i.interrupt_limit),
      .lost_o(missed[12]),
      .valid_o(valid[12]),
      .data_o(words[12][17:0]),
      .take_i(taken[12])
  );
  assign words[12][31:18] = {4'd9, 10'd0};

  gridrt_log_queue #(
      .WIDTH(21)
  ) u_commit (
      .clk_i,
      .rst_ni,
      .push_i(event_valid[13]),
      .data_i({tap_i.commit_hit, tap_i.commit_id}),
      .lost_o(missed[13]),
      .valid_o(valid[13]),
      .data_o(words[13][20:0]),
      .take_i(taken[13])
  );
  assign words[13][31:21] = {4'd10, 7'd0};

  // A word a clock, the lowest source first.
  logic more;  // the second word of the task or hit that was chosen
  logic more_hit, write, full, lost;
  logic [SOURCES-1:0] chosen;
  logic [31:0] word;
  assign chosen = valid & (~valid + 1'b1);
  always_comb begin
    taken = chosen;
    taken[TASK] = 1'b0;
    taken[HIT] = 1'b0;
    word = '0;
    for (int unsigned i = 0; i < SOURCES; i++) begin
      if (chosen[i]) word = words[i];
    end
    if (more) begin
      taken = '0;
      taken[TASK] = !more_hit;
      taken[HIT] = more_hit;
      word = more_hit ? hit_more : task_more;
    end
  end
  assign write = (more || valid != '0) && !full;
  assign lost = ((more || valid != '0) && full) || missed != '0;

  logic [INDEX_W-1:0] head, tail;
  logic [INDEX_W:0] count;
  assign full = count == (INDEX_W + 1)'(WORDS);
  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      on <= 1'b0;
      overflow_o <= 1'b0;
      more <= 1'b0;
      head <= '0;
      tail <= '0;
      count <= '0;
    end else begin
      more <= !more && (chosen[TASK] || chosen[HIT]);
      if (begin_i) begin
        on <= 1'b1;
        overflow_o <= 1'b0;
        head <= '0;
        tail <= '0;
        count <= '0;
      end else begin
        if (stop_i) on <= 1'b0;
        if (lost) overflow_o <= 1'b1;
        if (write) tail <= tail + 1'b1;
        if (take_i) head <= head + 1'b1;
        count <= count + (INDEX_W + 1)'(write) - (INDEX_W + 1)'(take_i);
      end
    end
  end
  always_ff @(posedge clk_i) more_hit <= chosen[HIT];

  // One block memory: a port to write, one to read.
  (* no_rw_check *)
  logic [31:0] memory[WORDS];
  always_ff @(posedge clk_i) if (write) memory[tail] <= word;
  always_ff @(posedge clk_i) word_o <= memory[head];

  assign on_o = on;
  assign count_o = count;

`ifdef GRIDRT_ASSERT
  always_ff @(posedge clk_i) begin
    if (rst_ni) begin
      assert (!(take_i && count == '0));
    end
  end
`endif
endmodule
