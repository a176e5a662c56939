// Free ray slots, one list for each traversal unit (slot s belongs to unit s modulo TUS). Units
// take turns; one without a free slot is passed over. After reset the lists fill themselves.
module gridrt_slots #(
    parameter int unsigned SLOTS = 64,
    parameter int unsigned TUS   = 4
) (
    input  logic                          clk_i,
    input  logic                          rst_ni,
    output logic                          valid_o,  // slot_o is free
    output logic [gridrt_pkg::SLOT_W-1:0] slot_o,
    output logic [TUS-1:0]                unit_o,  // its unit, one bit
    input  logic                          take_i,  // only while valid_o
    input  logic                          free_i,
    input  logic [gridrt_pkg::SLOT_W-1:0] free_slot_i
);
  localparam int unsigned SLOT_W = gridrt_pkg::SLOT_W;
  localparam int unsigned COUNT_W = $clog2(SLOTS / TUS + 1);
  localparam int unsigned PLACE_W = (SLOTS / TUS > 1) ? $clog2(SLOTS / TUS) : 1;

  if (SLOTS < 1 || SLOTS > (1 << SLOT_W) || SLOTS % TUS != 0) begin : gen_illegal
    $error("gridrt_slots: SLOTS must be a multiple of TUS and at most 64");
  end

  logic [SLOT_W:0] fill;  // slots that are in a list for the first time
  logic filling, push;
  logic [SLOT_W-1:0] push_slot;
  logic [TUS-1:0] valid, grant, wanted, ready;
  logic [TUS-1:0][SLOT_W-1:0] head;
  logic [TUS-1:0][COUNT_W-1:0] count;

  assign filling = fill != (SLOT_W + 1)'(SLOTS);
  assign push = filling || free_i;
  assign push_slot = filling ? fill[SLOT_W-1:0] : free_slot_i;

  logic [PLACE_W-1:0] unused_place;
  gridrt_slot_unit #(
      .TUS  (TUS),
      .SLOTS(SLOTS)
  ) i_unit (
      .slot_i (push_slot),
      .unit_o (wanted),
      .place_o(unused_place)
  );
  for (genvar t = 0; t < TUS; t++) begin : gen_list
    gridrt_fifo #(
        .WIDTH(SLOT_W),
        .DEPTH(SLOTS / TUS)
    ) u_free (
        .clk_i,
        .rst_ni,
        .in_valid_i(push && wanted[t]),
        .in_ready_o(ready[t]),
        .in_data_i(push_slot),
        .out_valid_o(valid[t]),
        .out_ready_i(take_i && grant[t]),
        .out_data_o(head[t]),
        .count_o(count[t])
    );
  end

  gridrt_arbiter #(
      .N(TUS)
  ) u_turn (
      .clk_i,
      .rst_ni,
      .request_i(valid),
      .take_i,
      .grant_o(grant)
  );

  assign valid_o = valid != '0 && !filling;
  assign unit_o  = grant;
  always_comb begin
    slot_o = '0;
    for (int unsigned t = 0; t < TUS; t++) begin
      if (grant[t]) slot_o = slot_o | head[t];
    end
  end

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) fill <= '0;
    else if (filling) fill <= fill + 1'b1;
  end

  logic unused;
  assign unused = &{1'b0, ready, count};

`ifdef GRIDRT_ASSERT
  always_ff @(posedge clk_i) begin
    if (rst_ni) begin
      assert (!(take_i && !valid_o));
      assert (!(free_i && filling));
      assert (!(push && (wanted & ~ready) != '0));  // no list gets more slots than there are
    end
  end
`endif
endmodule
