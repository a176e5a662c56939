// How many tasks of each ray have not answered yet. The counts are kept as bit planes (plane b
// holds bit b of every slot), so that adding and subtracting are a few logic operations on whole
// planes. Ends of tasks count three clocks later: a count may be too high for a moment, never too low.
module gridrt_pending #(
    parameter int unsigned SLOTS = 64,
    parameter int unsigned TUS   = 4,
    parameter int unsigned ENDS  = 6,  // ports that end tasks, at most 6
    parameter int unsigned AHEAD = 2    // 1, 2, 4, 8 or 16
) (
    input  logic clk_i,
    input  logic rst_ni,
    // Tasks that a traversal step makes; a slot belongs to one unit, so ports never meet in a slot.
    input  logic [TUS-1:0]                          inc_valid_i,
    input  logic [TUS-1:0][gridrt_pkg::SLOT_W-1:0]  inc_slot_i,
    input  logic [TUS-1:0][3:0]                     inc_count_i,
    input  logic [ENDS-1:0][gridrt_pkg::SLOT_EVENT_W-1:0] end_i,  // slot_event_t
    output logic [SLOTS-1:0]                        few_o,   // fewer than AHEAD
    output logic [SLOTS-1:0]                        none_o,
    output logic [SLOTS-1:0]                        many_o   // more than one
);
  // At most 2 AHEAD - 1 + 8 even if a step was begun too early.
  localparam int unsigned PLANES = $clog2(2 * AHEAD + 8);
  localparam int unsigned AHEAD_LOG = $clog2(AHEAD);

  if (ENDS < 1 || ENDS > 6) begin : gen_illegal_ends
    $error("gridrt_pending: ENDS must be 1 to 6");
  end
  if (AHEAD < 1 || AHEAD > 16 || (1 << AHEAD_LOG) != AHEAD) begin : gen_illegal_ahead
    $error("gridrt_pending: AHEAD must be 1, 2, 4, 8 or 16");
  end

  logic [PLANES-1:0][SLOTS-1:0] count, count_next;
  logic [3:0][SLOTS-1:0] more;
  logic [2:0][SLOTS-1:0] ended, ended_q;

  // What is added, by slot. Slot s belongs to unit s modulo TUS.
  logic [TUS-1:0][SLOTS-1:0] added;
  for (genvar t = 0; t < TUS; t++) begin : gen_added
    gridrt_onehot #(
        .LINES  (SLOTS),
        .INDEX_W(gridrt_pkg::SLOT_W)
    ) u_slot (
        .valid_i(inc_valid_i[t]),
        .index_i(inc_slot_i[t]),
        .line_o (added[t])
    );
  end
  always_comb begin
    for (int unsigned s = 0; s < SLOTS; s++) begin
      for (int unsigned b = 0; b < 4; b++) more[b][s] = added[s%TUS][s] && inc_count_i[s%TUS][b];
    end
  end

  // What ends comes from far away, so it is in a register first.
  logic [ENDS-1:0][gridrt_pkg::SLOT_EVENT_W-1:0] end_q;
  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) end_q <= '0;
    else end_q <= end_i;
  end

  // How many ports end a task of the slot: ones and twos of three pairs of ports.
  logic [5:0][SLOTS-1:0] one;
  for (genvar e = 0; e < 6; e++) begin : gen_end
    if (e < ENDS) begin : gen_port
      gridrt_pkg::slot_event_t ends;
      assign ends = end_q[e];
      gridrt_onehot #(
          .LINES  (SLOTS),
          .INDEX_W(gridrt_pkg::SLOT_W)
      ) u_slot (
          .valid_i(ends.valid),
          .index_i(ends.slot),
          .line_o (one[e])
      );
    end else begin : gen_none
      assign one[e] = '0;
    end
  end
  logic [2:0][SLOTS-1:0] odd, both;
  logic [SLOTS-1:0] two;
  always_comb begin
    for (int unsigned i = 0; i < 3; i++) begin
      odd[i]  = one[2*i] ^ one[2*i+1];
      both[i] = one[2*i] & one[2*i+1];
    end
    two = (odd[0] & odd[1]) | (odd[0] & odd[2]) | (odd[1] & odd[2]);
    ended[0] = odd[0] ^ odd[1] ^ odd[2];
    ended[1] = both[0] ^ both[1] ^ both[2] ^ two;
    ended[2] = ((both[0] | both[1]) & (both[2] | two)) | (both[0] & both[1]) | (both[2] & two);
  end

  // count + more - ended: carry-save, then a ripple over the planes.
  logic [PLANES-1:0][SLOTS-1:0] minus, plus, half;
  logic [SLOTS-1:0] twice, ripple;
  always_comb begin
    twice  = '1;  // minus x is not x plus one
    ripple = '0;
    for (int unsigned b = 0; b < PLANES; b++) begin
      minus[b] = (b < 3) ? ~ended_q[b%3] : '1;
      plus[b] = (b < 4) ? more[b%4] : '0;
      half[b] = count[b] ^ minus[b] ^ plus[b];
      count_next[b] = half[b] ^ twice ^ ripple;
      ripple = (half[b] & twice) | (ripple & (half[b] | twice));
      twice = (count[b] & minus[b]) | (plus[b] & (count[b] | minus[b]));
    end
  end

  // What the counts will be decides what is told of them, which so comes from registers as well.
  logic [SLOTS-1:0] above, several;
  always_comb begin
    above   = '0;
    several = '0;
    for (int unsigned b = 0; b < PLANES; b++) begin
      if (b + 1 > AHEAD_LOG) above = above | count_next[b];
      if (b >= 1) several = several | count_next[b];
    end
  end

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      count <= '0;
      ended_q <= '0;
      few_o <= '1;
      none_o <= '1;
      many_o <= '0;
    end else begin
      count <= count_next;
      ended_q <= ended;
      few_o <= ~above;
      none_o <= ~(several | count_next[0]);
      many_o <= several;
    end
  end

`ifdef GRIDRT_ASSERT
  // No count wraps: what is subtracted was there, and the sum fits.
  logic [SLOTS-1:0] borrow, overflow;
  always_comb begin
    borrow   = '0;
    overflow = '0;
    for (int unsigned b = 0; b < PLANES; b++) begin
      borrow   = (~count[b] & ~minus[b]) | (borrow & (~count[b] | ~minus[b]));
      overflow = (count[b] & plus[b]) | (overflow & (count[b] | plus[b]));
    end
  end
  always_ff @(posedge clk_i) begin
    if (rst_ni) begin
      assert (borrow == '0);
      assert (overflow == '0);
    end
  end
`endif
endmodule
