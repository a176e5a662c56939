// From tasks to references: reads four references a clock, leaves out those that share no octant of
// the voxel with the ray, and gives the rest one a clock, `last` on the last one of its task. The next
// task follows without a gap. A task in which nothing passes ends with a pulse of `none` and takes no
// clock from the others. A task whose ray has been hit before the task's slab is given up.
// Within a task the order of references is of no account.
module gridrt_fetch #(
    parameter int unsigned REFS = 10240,
    parameter bit MASK = 1'b1,
    parameter bit CANCEL = 1'b1,
    parameter int unsigned ROWS = 8
) (
    input  logic                          clk_i,
    input  logic                          rst_ni,
    input  gridrt_pkg::interrupt_t        interrupt_i,
    // Loading: reference records (triangle, then mask).
    input  logic                          write_i,
    input  logic [gridrt_pkg::REF_W-1:0]  write_index_i,
    input  logic [gridrt_pkg::TRI_W+5:0]  write_data_i,
    input  logic                          task_valid_i,
    output logic                          task_ready_o,
    input  gridrt_pkg::task_t             task_i,
    // A reference to be tested.
    output logic                          valid_o,
    input  logic                          ready_i,
    output logic                          last_o,
    output logic [gridrt_pkg::SLOT_W-1:0] slot_o,
    output logic [gridrt_pkg::TRI_W-1:0]  triangle_o,
    output gridrt_pkg::slot_event_t       none_o,  // a task ends without a reference to be tested
    output logic [2:0]                    masked_o,  // references left out, a pulse for counters
    output logic                          aborted_o,  // a task is given up because of a hit
    output logic                          working_o   // a task is being read
);
  localparam int unsigned HALF = REFS / 2;
  localparam int unsigned ADDRESS_W = $clog2(HALF);
  localparam int unsigned WAY = 4;  // references a clock
  localparam int unsigned REF_BITS = gridrt_pkg::TRI_W + 6;
  localparam int unsigned TRI_W = gridrt_pkg::TRI_W;
  localparam int unsigned SLOT_W = gridrt_pkg::SLOT_W;
  localparam int unsigned ROW_W = WAY * TRI_W + WAY + SLOT_W + 1;
  localparam int unsigned INDEX_W = $clog2(ROWS);

  if (ROWS < 6 || (1 << INDEX_W) != ROWS) begin : gen_illegal
    $error("gridrt_fetch: ROWS must be a power of two, 8 at least");
  end
  if (REFS < 4 || REFS % 2 != 0) begin : gen_illegal_memory
    $error("gridrt_fetch: REFS must be even, 4 at least");
  end

  // The task that is being read.
  logic busy, cancelled;
  logic [SLOT_W-1:0] slot;
  logic [gridrt_pkg::REF_W-1:0] at;
  logic [gridrt_pkg::LIST_W-1:0] left;
  logic [7:0] octants;
  logic [gridrt_pkg::DIST_W-1:0] enter;

  // The sender has compared the task with the ray's limit as it was before the clock in which the
  // task comes, so only interrupts from then on matter. Limits never rise.
  gridrt_pkg::interrupt_t interrupt;
  logic was_cancelled;
  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) interrupt <= '0;
    else interrupt <= interrupt_i;
  end
  assign cancelled = CANCEL && (was_cancelled || (interrupt.valid && interrupt.slot == slot &&
                                                  enter > interrupt.limit));

  // Rows in the queue and on their way to it never exceed its size.
  logic [INDEX_W:0] rows;
  logic [1:0] on_the_way;
  logic go, ends;
  assign on_the_way = 2'(valid_1) + 2'(valid_2) + 2'(valid_3);
  assign go = busy && rows + (INDEX_W + 1)'(on_the_way) < (INDEX_W + 1)'(ROWS);
  assign ends = cancelled || left <= 10'(WAY);
  assign task_ready_o = !busy || (go && ends);
  assign working_o = busy;
  assign aborted_o = go && cancelled;

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      busy <= 1'b0;
    end else if (task_ready_o) begin
      busy <= task_valid_i;
    end
  end
  always_ff @(posedge clk_i) begin
    was_cancelled <= cancelled && !(task_valid_i && task_ready_o);
    if (task_valid_i && task_ready_o) begin
      slot <= task_i.slot;
      at <= task_i.first;
      left <= task_i.count;
      octants <= task_i.octants;
      enter <= task_i.enter;
    end else if (go) begin
      at <= at + 14'(WAY);
      left <= left - 10'(WAY);
    end
  end

  // 1, 2: the memory; 3: what passes. References with even and with odd indices lie in memories of
  // their own, two ports each: rows are {odd second, odd first, even second, even first}.
  logic valid_1, valid_2, valid_3;
  logic [WAY-1:0] wanted, wanted_1, wanted_2, pass, pass_3;
  logic end_1, end_2, end_3;
  logic [SLOT_W-1:0] slot_1, slot_2, slot_3;
  logic [7:0] octants_1, octants_2;
  logic [WAY-1:0][REF_BITS-1:0] found;
  logic [WAY-1:0][TRI_W-1:0] triangle_3;
  logic [gridrt_pkg::REF_W-1:0] even_at, odd_at;
  logic [ADDRESS_W-1:0] even_first, odd_first;
  assign even_at = (at + 14'd1) >> 1;
  assign odd_at = at >> 1;
  assign even_first = ADDRESS_W'(even_at);
  assign odd_first = ADDRESS_W'(odd_at);

  // The list begins with an even or an odd index, and ends after `left`.
  always_comb begin
    wanted = {left > 10'd3, left > 10'd1, left > 10'd2, 1'b1};
    if (at[0]) wanted = {left > 10'd2, 1'b1, left > 10'd3, left > 10'd1};
    if (cancelled) wanted = '0;
  end

  for (genvar h = 0; h < 2; h++) begin : gen_half
    logic write;
    logic [ADDRESS_W-1:0] first;
    assign write = write_i && write_index_i[0] == (h == 1);
    assign first = (h == 1) ? odd_first : even_first;
    gridrt_ram_tdp #(
        .WIDTH(REF_BITS),
        .DEPTH(HALF),
        .BANK((HALF > 2048) ? 2048 : HALF),
        .OUTPUT_REGISTER(1'b1)
    ) u_references (
        .clk_i,
        .a_write_i(write),
        .a_enable_i(go || write),
        .a_address_i(write ? ADDRESS_W'(write_index_i >> 1) : first),
        .a_data_i(write_data_i),
        .a_data_o(found[2*h]),
        .b_enable_i(go),
        .b_address_i(first + 1'b1),
        .b_data_o(found[2*h+1])
    );
  end

  function automatic logic share(input logic [5:0] code, input logic [7:0] set);
    logic [7:0] both;
    both = gridrt_protocol_pkg::OCTANT_SETS[{code, 3'b0}+:8] & set;
    share = !MASK || both != '0;
  endfunction

  always_comb begin
    masked_o = '0;
    for (int unsigned i = 0; i < WAY; i++) begin
      pass[i] = wanted_2[i] && share(found[i][TRI_W+:6], octants_2);
      if (valid_2 && wanted_2[i] && !pass[i]) masked_o = masked_o + 3'd1;
    end
  end

  // A row with nothing in it is left out, unless it ends a task of which other rows are there.
  logic begun;  // a row of the present task has been kept
  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      valid_1 <= 1'b0;
      valid_2 <= 1'b0;
      valid_3 <= 1'b0;
      begun   <= 1'b0;
      none_o  <= '0;
    end else begin
      valid_1 <= go;
      valid_2 <= valid_1;
      valid_3 <= valid_2 && ((end_2 && begun) || pass != '0);
      if (valid_2) begun <= !end_2 && (begun || pass != '0);
      none_o.valid <= valid_2 && end_2 && !begun && pass == '0;
      none_o.slot  <= slot_2;
    end
  end
  always_ff @(posedge clk_i) begin
    if (go) begin
      wanted_1 <= wanted;
      end_1 <= ends;
      slot_1 <= slot;
      octants_1 <= octants;
    end
    if (valid_1) begin
      wanted_2 <= wanted_1;
      end_2 <= end_1;
      slot_2 <= slot_1;
      octants_2 <= octants_1;
    end
    if (valid_2) begin
      pass_3 <= pass;
      end_3  <= end_2;
      slot_3 <= slot_2;
      for (int unsigned i = 0; i < WAY; i++) triangle_3[i] <= found[i][TRI_W-1:0];
    end
  end

  // Rows wait with two of them in sight: the last reference of a row is the last one of its task
  // if the row ends the task or the next one does without a reference.
  logic [ROW_W-1:0] row_data, now_data;
  logic [INDEX_W-1:0] head, tail;
  logic [WAY-1:0] now_pass, remaining, chosen, gone;  // gone: references of the head row that left
  logic [WAY:0] next_row;
  logic [WAY-1:0][TRI_W-1:0] now_triangle;
  logic [SLOT_W-1:0] now_slot;
  logic now_end, next_bare, tail_now, offered, taken;
  logic [1:0] pop;

  assign row_data = {slot_3, triangle_3, pass_3, end_3};
  gridrt_lutram #(
      .WIDTH(ROW_W),
      .DEPTH(ROWS)
  ) u_now (
      .clk_i,
      .write_i(valid_3),
      .write_address_i(tail),
      .write_data_i(row_data),
      .read_address_i(head),
      .read_data_o(now_data)
  );
  gridrt_lutram #(
      .WIDTH(WAY + 1),
      .DEPTH(ROWS)
  ) u_next (
      .clk_i,
      .write_i(valid_3),
      .write_address_i(tail),
      .write_data_i(row_data[WAY:0]),
      .read_address_i(head + 1'b1),
      .read_data_o(next_row)
  );

  assign {now_slot, now_triangle, now_pass, now_end} = now_data;
  assign remaining = now_pass & ~gone;
  assign chosen = remaining & (~remaining + WAY'(1));
  assign tail_now = (remaining & ~chosen) == '0;  // no further reference in this row
  assign next_bare = rows > (INDEX_W + 1)'(1) && next_row == (WAY + 1)'(1);
  // A row's last reference that does not end the task waits until the next row is there.
  assign offered = rows != '0 && (!tail_now || now_end || rows > (INDEX_W + 1)'(1));
  assign valid_o = offered;
  assign last_o = tail_now && (now_end || next_bare);
  assign slot_o = now_slot;
  always_comb begin
    triangle_o = '0;
    for (int unsigned i = 0; i < WAY; i++) begin
      if (chosen[i]) triangle_o = triangle_o | now_triangle[i];
    end
  end
  assign taken = offered && ready_i;
  assign pop = (!taken || !tail_now) ? 2'd0 : ((!now_end && next_bare) ? 2'd2 : 2'd1);

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      head <= '0;
      tail <= '0;
      rows <= '0;
      gone <= '0;
    end else begin
      if (valid_3) tail <= tail + 1'b1;
      head <= head + INDEX_W'(pop);
      rows <= rows + (INDEX_W + 1)'(valid_3) - (INDEX_W + 1)'(pop);
      if (taken) gone <= tail_now ? '0 : gone | chosen;
    end
  end

  logic unused;
  assign unused = &{1'b0, even_at, odd_at, write_index_i};

`ifdef GRIDRT_ASSERT
  logic waited;
  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) waited <= 1'b0;
    else waited <= valid_o && !ready_i;
  end
  always_ff @(posedge clk_i) begin
    if (rst_ni) begin
      assert (rows <= (INDEX_W + 1)'(ROWS));
      assert (!waited || valid_o);
      assert (!(valid_3 && rows == (INDEX_W + 1)'(ROWS)));
      assert (!(offered && now_pass == '0));
      if (task_valid_i && task_ready_o) assert (task_i.count != '0);
    end
  end
`endif
endmodule
