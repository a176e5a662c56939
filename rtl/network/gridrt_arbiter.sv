// Chooses one of several requests in turn (round robin). A choice that is not taken stays, so that
// a stream chosen by it keeps its data while it waits.
module gridrt_arbiter #(
    parameter int unsigned N = 2
) (
    input  logic         clk_i,
    input  logic         rst_ni,
    input  logic [N-1:0] request_i,  // stays up until taken
    input  logic         take_i,  // the choice of this clock is taken
    output logic [N-1:0] grant_o  // one bit, or none where nothing is requested
);
  logic [N-1:0] after, held, upper, from, choice;  // after: requests behind the last one taken

  assign upper   = request_i & after;
  assign from    = (upper != '0) ? upper : request_i;
  assign choice  = from & (~from + N'(1));
  assign grant_o = (held != '0) ? held : choice;

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      after <= '0;
      held  <= '0;
    end else begin
      held <= take_i ? '0 : grant_o;
      if (take_i && grant_o != '0) after <= ~(grant_o | (grant_o - N'(1)));
    end
  end

`ifdef GRIDRT_ASSERT
  always_ff @(posedge clk_i) begin
    if (rst_ni) begin
      assert ((grant_o & ~request_i) == '0);
      assert ((grant_o & (grant_o - N'(1))) == '0);
      assert ((grant_o == '0) == (request_i == '0));
    end
  end
`endif
endmodule
