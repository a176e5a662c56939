// The limits of the rays in flight, as one block keeps them for itself. A ray starts without a
// limit (all ones); each interrupt lowers it. The two never come in one clock (gridrt_feedback).
module gridrt_limits #(
    parameter int unsigned SLOTS = 64
) (
    input  logic                                     clk_i,
    input  logic                                     rst_ni,
    input  gridrt_pkg::slot_event_t                  alloc_i,
    input  gridrt_pkg::interrupt_t                   interrupt_i,
    input  logic                   [gridrt_pkg::SLOT_W-1:0] slot_i,
    output logic                   [gridrt_pkg::DIST_W-1:0] limit_o
);
  localparam int unsigned INDEX_W = (SLOTS > 1) ? $clog2(SLOTS) : 1;

  gridrt_lutram #(
      .WIDTH(gridrt_pkg::DIST_W),
      .DEPTH(SLOTS)
  ) u_limits (
      .clk_i,
      .write_i(interrupt_i.valid || alloc_i.valid),
      .write_address_i(INDEX_W'(interrupt_i.valid ? interrupt_i.slot : alloc_i.slot)),
      .write_data_i(interrupt_i.valid ? interrupt_i.limit : '1),
      .read_address_i(INDEX_W'(slot_i)),
      .read_data_o(limit_o)
  );

  logic unused;
  assign unused = &{1'b0, rst_ni, slot_i, alloc_i, interrupt_i};

`ifdef GRIDRT_ASSERT
  always_ff @(posedge clk_i) begin
    if (rst_ni) assert (!(alloc_i.valid && interrupt_i.valid));
  end
`endif
endmodule
