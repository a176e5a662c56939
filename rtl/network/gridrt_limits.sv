// The limits of the rays in flight, as one block keeps them for itself. A ray starts without a
// limit (all ones); each interrupt lowers it.
module gridrt_limits #(
    parameter int unsigned SLOTS = 48
) (
    input  logic                                     clk_i,
    input  logic                                     rst_ni,
    input  gridrt_pkg::slot_event_t                  alloc_i,
    input  gridrt_pkg::interrupt_t                   interrupt_i,
    input  logic                   [gridrt_pkg::SLOT_W-1:0] slot_i,
    output logic                   [gridrt_pkg::DIST_W-1:0] limit_o
);
  localparam int unsigned INDEX_W = (SLOTS > 1) ? $clog2(SLOTS) : 1;

  logic [SLOTS-1:0] has;
  logic [gridrt_pkg::DIST_W-1:0] kept;

  gridrt_lutram #(
      .WIDTH(gridrt_pkg::DIST_W),
      .DEPTH(SLOTS)
  ) u_limits (
      .clk_i,
      .write_i(interrupt_i.valid),
      .write_address_i(INDEX_W'(interrupt_i.slot)),
      .write_data_i(interrupt_i.limit),
      .read_address_i(INDEX_W'(slot_i)),
      .read_data_o(kept)
  );

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      has <= '0;
    end else begin
      if (alloc_i.valid) has[INDEX_W'(alloc_i.slot)] <= 1'b0;
      if (interrupt_i.valid) has[INDEX_W'(interrupt_i.slot)] <= 1'b1;
    end
  end
  assign limit_o = has[INDEX_W'(slot_i)] ? kept : '1;

  logic unused;  // with few slots
  assign unused = (^alloc_i.slot) ^ (^interrupt_i.slot) ^ (^slot_i);
endmodule
