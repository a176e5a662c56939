// A sum or a difference in one carry chain. A module of its own since yosys makes one chain of this
// only with "alumacc; share -aggressive" (tools/synth), and two with a multiplexer otherwise.
module gridrt_add_sub #(
    parameter int unsigned WIDTH = 18
) (
    input  logic             sub_i,
    input  logic [WIDTH-1:0] a_i,
    input  logic [WIDTH-1:0] b_i,
    output logic [WIDTH-1:0] sum_o   // modulo 2^WIDTH
);
  assign sum_o = sub_i ? a_i - b_i : a_i + b_i;
endmodule
