// Cuts the stream to the host into transfers: the last byte before a pause is marked, so that the
// packet that it ends is short, or is followed by an empty one. A host that waits for more than has
// come would wait for ever otherwise.
module gridrt_usb_tail #(
    parameter int unsigned PAUSE = 256  // clocks without a byte
) (
    input  logic       clk_i,
    input  logic       rst_ni,
    input  logic       in_valid_i,
    output logic       in_ready_o,
    input  logic [7:0] in_data_i,
    output logic       out_valid_o,
    input  logic       out_ready_i,
    output logic [7:0] out_data_o,
    output logic       out_last_o
);
  localparam int unsigned PAUSE_W = $clog2(PAUSE + 1);

  logic held, over;
  logic [7:0] data;
  logic [PAUSE_W-1:0] pause;

  // A byte is held back until the next one has come, or is not going to.
  assign over = pause == PAUSE_W'(PAUSE);
  assign out_valid_o = held && (in_valid_i || over);
  assign out_data_o = data;
  assign out_last_o = over;
  assign in_ready_o = !held || (out_valid_o && out_ready_i);
  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      held  <= 1'b0;
      pause <= '0;
    end else begin
      if (in_ready_o) held <= in_valid_i;
      // Once the pause is over the byte is the last one, even if another comes while it waits.
      if (!held || in_ready_o) pause <= '0;
      else if (!over && !in_valid_i) pause <= pause + 1'b1;
    end
  end
  always_ff @(posedge clk_i) if (in_ready_o) data <= in_data_i;

  if (PAUSE < 2) begin : gen_illegal
    $error("gridrt_usb_tail: PAUSE must be 2 or more");
  end
endmodule
