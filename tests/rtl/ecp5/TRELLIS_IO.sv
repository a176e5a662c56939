// A pin of the ECP5, for the linter.
module TRELLIS_IO #(
    parameter DIR = "BIDIR"
) (
    input  logic I,
    input  logic T,
    output logic O,
    inout  wire  B
);
  assign B = T ? 1'bz : I;
  assign O = B;
  if (DIR != "BIDIR") begin : gen_illegal
    $error("TRELLIS_IO: only BIDIR is known here");
  end
endmodule
