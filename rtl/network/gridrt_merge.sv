// Several streams into one, in turn.
module gridrt_merge #(
    parameter int unsigned N = 2,
    parameter int unsigned WIDTH = 8
) (
    input  logic                    clk_i,
    input  logic                    rst_ni,
    input  logic [N-1:0]            in_valid_i,
    output logic [N-1:0]            in_ready_o,
    input  logic [N-1:0][WIDTH-1:0] in_data_i,
    output logic                    out_valid_o,
    input  logic                    out_ready_i,
    output logic [WIDTH-1:0]        out_data_o
);
  if (N == 1) begin : gen_wire
    logic unused;
    assign unused = clk_i && rst_ni;
    assign out_valid_o = in_valid_i[0];
    assign out_data_o = in_data_i[0];
    assign in_ready_o[0] = out_ready_i;
  end else begin : gen_choice
    logic [N-1:0] grant;

    gridrt_arbiter #(
        .N(N)
    ) u_arbiter (
        .clk_i,
        .rst_ni,
        .request_i(in_valid_i),
        .take_i(out_valid_o && out_ready_i),
        .grant_o(grant)
    );

    assign out_valid_o = in_valid_i != '0;
    assign in_ready_o  = out_ready_i ? grant : '0;
    always_comb begin
      out_data_o = '0;
      for (int unsigned i = 0; i < N; i++) begin
        if (grant[i]) out_data_o = out_data_o | in_data_i[i];
      end
    end
  end
endmodule
