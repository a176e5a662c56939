// A place in a stream where simulations with GRIDRT_STALL pause at random; else a pair of wires.
// Behind it the rule of streams is checked: what has been offered stays until it is taken.
module gridrt_stall #(
    parameter int unsigned SEED = 1,
    parameter int unsigned WIDTH = 1,
    parameter bit CHECK = 1'b1  // 0: an interrupt may take an offer back
) (
    input  logic clk_i,
    input  logic rst_ni,
    input  logic in_valid_i,
    output logic in_ready_o,
    output logic out_valid_o,
    input  logic out_ready_i,
    input  logic [WIDTH-1:0] data_i  // what the stream carries past it, for the check
);
`ifdef GRIDRT_STALL
  logic [15:0] random;
  logic pause;

  assign out_valid_o = in_valid_i && !pause;
  assign in_ready_o  = out_ready_i && !pause;

  // Calm and rough times alternate: in rough ones three clocks of four are pauses.
  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      random <= 16'(SEED * 40503) | 16'd1;
      pause  <= 1'b0;
    end else begin
      random <= {random[14:0], random[15] ^ random[13] ^ random[12] ^ random[10]};
      pause  <= !(out_valid_o && !out_ready_i) && random[1:0] != 2'd0 && random[9:8] == 2'd0;
    end
  end
`else
  logic unused;
  assign unused = clk_i && rst_ni && SEED != 0;
  assign out_valid_o = in_valid_i;
  assign in_ready_o = out_ready_i;
`endif
  if (CHECK) begin : gen_check
    gridrt_stream_check #(
        .WIDTH(WIDTH)
    ) u_check (
        .clk_i,
        .rst_ni,
        .valid_i(out_valid_o),
        .ready_i(out_ready_i),
        .data_i
    );
  end else begin : gen_no_check
    logic unused_data;
    assign unused_data = &{1'b0, data_i};
  end
endmodule
