// From tasks to references: reads eight references a clock, leaves out those that share no cell of
// the voxel with the ray, and gives the rest one a clock, `last` on the last one of its task. The next
// task follows without a gap. A task in which nothing passes ends with a pulse of `none` and takes no
// clock from the others. A task whose ray has been hit before the task's slab is given up.
// Within a task the order of references is of no account.
module gridrt_fetch #(
    parameter int unsigned REFS = 8192,
    parameter bit MASK = 1'b1,
    parameter bit CANCEL = 1'b1,
    parameter int unsigned ROWS = 16
) (
    input  logic                          clk_i,
    input  logic                          rst_ni,
    input  gridrt_pkg::interrupt_t        interrupt_i,
    // Loading: reference records (triangle, then quarters).
    input  logic                          write_i,
    input  logic [gridrt_pkg::REF_W-1:0]  write_index_i,
    input  logic [gridrt_pkg::TRI_W+9:0]  write_data_i,
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
    output logic [3:0]                    masked_o,  // references left out, a pulse for counters
    output logic                          aborted_o,  // a task is given up because of a hit
    output logic                          working_o   // a task is being read
);
  localparam int unsigned BANKS = 4;
  localparam int unsigned DEPTH = REFS / BANKS;
  localparam int unsigned ADDRESS_W = $clog2(DEPTH);
  localparam int unsigned WAY = 2 * BANKS;  // references a clock
  localparam int unsigned REF_BITS = gridrt_pkg::TRI_W + 10;
  localparam int unsigned LOW_BITS = 18;  // of these, in memories of their own
  localparam int unsigned CELLS_W = gridrt_pkg::CELLS_W;
  localparam int unsigned TRI_W = gridrt_pkg::TRI_W;
  localparam int unsigned SLOT_W = gridrt_pkg::SLOT_W;
  localparam int unsigned ROW_W = WAY * TRI_W + WAY + SLOT_W + 1;
  localparam int unsigned INDEX_W = $clog2(ROWS);

  if (ROWS < 7 || (1 << INDEX_W) != ROWS) begin : gen_illegal
    $error("gridrt_fetch: ROWS must be a power of two, 8 at least");
  end
  if (REFS < 8 || REFS % BANKS != 0) begin : gen_illegal_memory
    $error("gridrt_fetch: REFS must be a multiple of 4, 8 at least");
  end

  // The task that is being read.
  logic busy, cancelled;
  logic [SLOT_W-1:0] slot;
  logic [gridrt_pkg::REF_W-1:0] at;
  logic [gridrt_pkg::LIST_W-1:0] left;
  logic [CELLS_W-1:0] cells;
  logic [gridrt_pkg::DIST_W-1:0] enter;

  // The sender has compared the task with the ray's limit as it was before the clock in which the
  // task comes, so only interrupts from then on matter. Limits never rise.
  gridrt_pkg::interrupt_t interrupt;
  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) interrupt <= '0;
    else interrupt <= interrupt_i;
  end
  logic late;
  assign late = interrupt.valid && interrupt.slot == slot && enter > interrupt.limit;

  // Rows in the queue and on their way to it never exceed its size.
  logic [INDEX_W:0] rows;
  logic [2:0] on_the_way;
  logic go, ends;
  assign on_the_way = 3'(valid_1) + 3'(valid_2) + 3'(valid_3) + 3'(valid_4);
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
    cancelled <= CANCEL && (cancelled || late) && !(task_valid_i && task_ready_o);
    if (task_valid_i && task_ready_o) begin
      slot <= task_i.slot;
      at <= task_i.first;
      left <= task_i.count;
      cells <= task_i.cells;
      enter <= task_i.enter;
    end else if (go) begin
      at <= at + 14'(WAY);
      left <= left - 10'(WAY);
    end
  end

  // 1, 2: the memory; 3: quarters, from the dominant axis on; 4: what passes. Reference i lies in bank
  // i % 4, which has two ports: a row is, bank by bank, the first one of the list that is there and the
  // one four places behind.
  logic valid_1, valid_2, valid_3, valid_4;
  logic [WAY-1:0] wanted, wanted_1, wanted_2, wanted_3, pass, pass_4;
  logic end_1, end_2, end_3, end_4;
  logic [SLOT_W-1:0] slot_1, slot_2, slot_3, slot_4;
  logic [CELLS_W-1:0] cells_1, cells_2;
  logic [CELLS_W-3:0] cells_3;
  logic [WAY-1:0][REF_BITS-1:0] found;
  logic [WAY-1:0][TRI_W-1:0] triangle_3, triangle_4;
  logic [WAY-1:0][2:0][3:0] masks, masks_3;  // dominant axis, b, c

  for (genvar h = 0; h < BANKS; h++) begin : gen_bank
    logic write;
    logic [1:0] offset;  // from the list's next reference to the first one in this bank
    logic [ADDRESS_W-1:0] first;
    assign write = write_i && write_index_i[1:0] == 2'(h);
    assign offset = 2'(h) - at[1:0];
    assign first = ADDRESS_W'((at + 14'(BANKS - 1 - h)) >> 2);
    assign wanted[2*h] = !cancelled && left > 10'(offset);
    assign wanted[2*h+1] = !cancelled && left > 10'({1'b1, offset});
    // 18 bits and 4: the shapes that leave the least of a block memory unused.
    gridrt_ram_tdp #(
        .WIDTH(LOW_BITS),
        .DEPTH(DEPTH),
        .OUTPUT_REGISTER(1'b1)
    ) u_references (
        .clk_i,
        .a_write_i(write),
        .a_enable_i(go || write),
        .a_address_i(write ? ADDRESS_W'(write_index_i >> 2) : first),
        .a_data_i(write_data_i[LOW_BITS-1:0]),
        .a_data_o(found[2*h][LOW_BITS-1:0]),
        .b_enable_i(go),
        .b_address_i(first + 1'b1),
        .b_data_o(found[2*h+1][LOW_BITS-1:0])
    );
    gridrt_ram_tdp #(
        .WIDTH(REF_BITS - LOW_BITS),
        .DEPTH(DEPTH),
        .OUTPUT_REGISTER(1'b1)
    ) u_references_high (
        .clk_i,
        .a_write_i(write),
        .a_enable_i(go || write),
        .a_address_i(write ? ADDRESS_W'(write_index_i >> 2) : first),
        .a_data_i(write_data_i[REF_BITS-1:LOW_BITS]),
        .a_data_o(found[2*h][REF_BITS-1:LOW_BITS]),
        .b_enable_i(go),
        .b_address_i(first + 1'b1),
        .b_data_o(found[2*h+1][REF_BITS-1:LOW_BITS])
    );
  end

  logic [WAY-1:0] match;
  logic [WAY-1:0][2:0][3:0] touched;  // z, y, x
  for (genvar i = 0; i < WAY; i++) begin : gen_match
    gridrt_quarters u_quarters (
        .code_i(found[i][TRI_W+:10]),
        .masks_o(touched[i])
    );
    gridrt_match u_match (
        .masks_i(masks_3[i]),
        .cells_i(cells_3),
        .match_o(match[i])
    );
  end

  logic [3:0] masked;
  always_comb begin
    for (int unsigned i = 0; i < WAY; i++) begin
      case (cells_2[CELLS_W-1-:2])
        2'd0: masks[i] = touched[i];
        2'd1: masks[i] = {touched[i][0], touched[i][2], touched[i][1]};
        default: masks[i] = {touched[i][1], touched[i][0], touched[i][2]};
      endcase
    end
  end
  always_comb begin
    masked = '0;
    for (int unsigned i = 0; i < WAY; i++) begin
      pass[i] = wanted_3[i] && (!MASK || match[i]);
      if (valid_3 && wanted_3[i] && !pass[i]) masked = masked + 4'd1;
    end
  end

  // A row with nothing in it is left out, unless it ends a task of which other rows are there.
  logic begun;  // a row of the present task has been kept
  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      valid_1 <= 1'b0;
      valid_2 <= 1'b0;
      valid_3 <= 1'b0;
      valid_4 <= 1'b0;
      begun   <= 1'b0;
      none_o  <= '0;
      masked_o <= '0;
    end else begin
      masked_o <= masked;
      valid_1 <= go;
      valid_2 <= valid_1;
      valid_3 <= valid_2;
      valid_4 <= valid_3 && ((end_3 && begun) || pass != '0);
      if (valid_3) begun <= !end_3 && (begun || pass != '0);
      none_o.valid <= valid_3 && end_3 && !begun && pass == '0;
      none_o.slot  <= slot_3;
    end
  end
  always_ff @(posedge clk_i) begin
    if (gridrt_pkg::FREE_RUNNING || go) begin
      wanted_1 <= wanted;
      end_1 <= ends;
      slot_1 <= slot;
      cells_1 <= cells;
    end
    if (gridrt_pkg::FREE_RUNNING || valid_1) begin
      wanted_2 <= wanted_1;
      end_2 <= end_1;
      slot_2 <= slot_1;
      cells_2 <= cells_1;
    end
    if (gridrt_pkg::FREE_RUNNING || valid_2) begin
      wanted_3 <= wanted_2;
      end_3 <= end_2;
      slot_3 <= slot_2;
      cells_3 <= cells_2[CELLS_W-3:0];
      masks_3 <= masks;
      for (int unsigned i = 0; i < WAY; i++) triangle_3[i] <= found[i][TRI_W-1:0];
    end
    if (gridrt_pkg::FREE_RUNNING || valid_3) begin
      pass_4 <= pass;
      end_4 <= end_3;
      slot_4 <= slot_3;
      triangle_4 <= triangle_3;
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

  assign row_data = {slot_4, triangle_4, pass_4, end_4};
  gridrt_lutram #(
      .WIDTH(ROW_W),
      .DEPTH(ROWS)
  ) u_now (
      .clk_i,
      .write_i(valid_4),
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
      .write_i(valid_4),
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
      if (valid_4) tail <= tail + 1'b1;
      head <= head + INDEX_W'(pop);
      rows <= rows + (INDEX_W + 1)'(valid_4) - (INDEX_W + 1)'(pop);
      if (taken) gone <= tail_now ? '0 : gone | chosen;
    end
  end

  logic unused;
  assign unused = &{1'b0, write_index_i};

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
      assert (!(valid_4 && rows == (INDEX_W + 1)'(ROWS)));
      assert (!(offered && now_pass == '0));
      if (task_valid_i && task_ready_o) assert (task_i.count != '0);
    end
  end
`endif
endmodule
