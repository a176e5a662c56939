// Where the rays of a traversal unit are, between two ways through its clocks. What a ray keeps is
// written once, when it starts, so that it need not be carried to the last clock.
module gridrt_march_states #(
    parameter int unsigned COUNT = 16,  // rays
    localparam int unsigned INDEX_W = (COUNT > 1) ? $clog2(COUNT) : 1,
    localparam int unsigned BLOCK_W = gridrt_state_pkg::BLOCK_W
) (
    input  logic                     clk_i,
    input  logic [INDEX_W-1:0]       s1_slot_i,
    input  logic                     s1_starts_i,   // its state is that of s1_start_i
    input  gridrt_state_pkg::start_t s1_start_i,
    output gridrt_state_pkg::start_t s1_state_o,
    output logic [1:0]               s1_sub_o,      // neighbour of its block that is looked at
    output logic [BLOCK_W-1:0]       s1_look_o,     // address of that
    input  logic                     s10_writes_i,
    input  logic [INDEX_W-1:0]       s10_slot_i,
    input  gridrt_state_pkg::start_t s10_state_i,
    input  logic [1:0]               s10_sub_i,
    input  logic [BLOCK_W-1:0]       s10_look_i
);
  localparam int unsigned KEPT_W = gridrt_state_pkg::KEPT_W;
  localparam int unsigned MOVED_W = gridrt_state_pkg::START_W - KEPT_W;

  gridrt_state_pkg::start_t stored;
  logic [KEPT_W-1:0] kept;
  logic [MOVED_W-1:0] moved, moved_read;
  logic [1:0] stored_sub;
  logic [BLOCK_W-1:0] stored_look;
  assign kept = {s1_start_i.axis, s1_start_i.neg, s1_start_i.last, s1_start_i.slope};
  assign moved = {
    s10_state_i.block, s10_state_i.slabs, s10_state_i.first, s10_state_i.enter, s10_state_i.quarter,
    s10_state_i.low, s10_state_i.rest, s10_state_i.limit
  };

  gridrt_lutram #(
      .WIDTH(KEPT_W),
      .DEPTH(COUNT)
  ) i_kept (
      .clk_i,
      .write_i(s1_starts_i),
      .write_address_i(s1_slot_i),
      .write_data_i(kept),
      .read_address_i(s1_slot_i),
      .read_data_o({stored.axis, stored.neg, stored.last, stored.slope})
  );
  gridrt_lutram #(
      .WIDTH(MOVED_W + 2 + BLOCK_W),
      .DEPTH(COUNT)
  ) i_moved (
      .clk_i,
      .write_i(s10_writes_i),
      .write_address_i(s10_slot_i),
      .write_data_i({moved, s10_sub_i, s10_look_i}),
      .read_address_i(s1_slot_i),
      .read_data_o({moved_read, stored_sub, stored_look})
  );
  assign {stored.block, stored.slabs, stored.first, stored.enter, stored.quarter, stored.low, stored.rest,
          stored.limit} = moved_read;
  assign s1_state_o = s1_starts_i ? s1_start_i : stored;
  assign s1_sub_o = s1_starts_i ? 2'd0 : stored_sub;
  assign s1_look_o = s1_starts_i ? s1_start_i.block : stored_look;

  // What is kept does not change on the way.
  logic unused;
  assign unused = &{1'b0, s10_state_i.axis, s10_state_i.neg, s10_state_i.last, s10_state_i.slope};
endmodule
