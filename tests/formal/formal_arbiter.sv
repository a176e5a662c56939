// Round robin: one grant, to somebody who asks, that stays until it is taken; nobody is passed over
// more than once by each of the others.
module formal_arbiter #(
    parameter int unsigned N = 3
) (
    input logic         clk_i,
    input logic [N-1:0] request_i,
    input logic         take_i
);
  logic rst_n = 1'b0;
  always_ff @(posedge clk_i) rst_n <= 1'b1;

  logic [N-1:0] grant;
  gridrt_arbiter #(
      .N(N)
  ) dut (
      .clk_i,
      .rst_ni(rst_n),
      .request_i,
      .take_i,
      .grant_o(grant)
  );

  logic [N-1:0] asked, kept;  // requests that were not taken; a choice that was not taken
  logic [N-1:0] watched;  // the request that must not be forgotten
  logic [3:0] passed;
  (* anyconst *) logic [2:0] who;
  assign watched = N'(1) << who;

  always_ff @(posedge clk_i) begin
    if (!rst_n) begin
      asked  <= '0;
      kept   <= '0;
      passed <= '0;
    end else begin
      assume (who < 3'(N));
      assume ((asked & ~request_i) == '0);
      asked <= take_i ? request_i & ~grant : request_i;
      kept  <= take_i ? '0 : grant;
      if ((request_i & watched) == '0 || (take_i && (grant & watched) != '0)) passed <= '0;
      else if (take_i) passed <= passed + 4'd1;

      assert ((grant & ~request_i) == '0);
      assert ((grant & (grant - N'(1))) == '0);
      assert ((grant == '0) == (request_i == '0));
      assert (kept == '0 || grant == kept);
      assert (passed < 4'(N));
      cover (passed == 4'(N - 1));
    end
  end
endmodule
