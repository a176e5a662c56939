#!/usr/bin/env python3
"""Writes MULT18X18D.sv and ALU54B.sv: what those cells of an ECP5 do, as far as gridrt_ecp5_slice asks.

  tests/rtl/ecp5/make_dsp.py FOLDER

After Lattice's description of the cells (FPGA-TN-02205, "ECP5 sysDSP usage guide", and its simulation
library): parameters that are not known here are refused at elaboration, operations in the simulation.
A chain goes from R of a slice to CIN of the next one.
"""
import pathlib
import sys


def ports(kind, *names):
    """Declarations: (port, bits) or a name of one bit."""
    words = []
    for name in names:
        port, count = name if isinstance(name, tuple) else (name, 0)
        words += [f"{kind} {port}{i}" for i in range(count)] if count else [f"{kind} {port}"]
    return ",\n    ".join(words)


def vector(port, count, first=0):
    """The bits of a port as one value."""
    return "{" + ", ".join(f"{port}{i}" for i in reversed(range(first, first + count))) + "}"


MULT18X18D = f"""// Made by tests/rtl/ecp5/make_dsp.py.
/* verilator lint_off UNUSED */
/* verilator lint_off DECLFILENAME */
module MULT18X18D #(
    parameter REG_INPUTA_CLK = "NONE",
    parameter REG_INPUTB_CLK = "NONE",
    parameter REG_PIPELINE_CLK = "NONE",
    parameter REG_OUTPUT_CLK = "NONE",
    parameter SOURCEB_MODE = "B_SHIFT",
    parameter RESETMODE = "SYNC"
) (
    {ports("input", "CLK0", "CE0", "RST0", "SIGNEDA", "SIGNEDB", "SOURCEA", "SOURCEB",
           ("A", 18), ("B", 18))},
    {ports("output", ("ROA", 18), ("ROB", 18), ("P", 36), "SIGNEDP")}
);
  if (REG_INPUTA_CLK != "CLK0" || REG_INPUTB_CLK != "CLK0" || REG_PIPELINE_CLK != "CLK0" ||
      REG_OUTPUT_CLK != "NONE" || SOURCEB_MODE != "B_SHIFT" || RESETMODE != "SYNC") begin : gen_unknown
    $error("MULT18X18D: only registers at the factors and in the pipeline are known here");
  end
  logic [17:0] a, b;
  logic signed_a, signed_b, is_signed;
  logic [35:0] product;
  always_ff @(posedge CLK0) begin
    if (RST0) begin
      a <= '0;
      b <= '0;
      product <= '0;
    end else if (CE0) begin
      // Else the factors are those of the neighbour, which is not modelled.
      a <= SOURCEA ? 18'h2A5A5 : {vector("A", 18)};
      b <= SOURCEB ? 18'h2A5A5 : {vector("B", 18)};
      product <= 36'($signed({{SIGNEDA && a[17], a}}) * $signed({{SIGNEDB && b[17], b}}));
    end
  end
  assign {vector("ROA", 18)} = a;
  assign {vector("ROB", 18)} = b;
  assign {vector("P", 36)} = product;
  assign SIGNEDP = SIGNEDA | SIGNEDB;
endmodule
"""

ALU54B = f"""// Made by tests/rtl/ecp5/make_dsp.py.
/* verilator lint_off UNUSED */
/* verilator lint_off DECLFILENAME */
module ALU54B #(
    parameter REG_OUTPUT0_CLK = "NONE",
    parameter REG_OUTPUT1_CLK = "NONE",
    parameter RESETMODE = "SYNC"
) (
    {ports("input", "CLK0", "CE0", "RST0", "SIGNEDIA", "SIGNEDIB", ("OP", 11), ("A", 36), ("B", 36))},
    {ports("input", ("MA", 36), ("MB", 36), ("CIN", 54))},
    {ports("output", ("R", 54))}
);
  if (REG_OUTPUT0_CLK != "CLK0" || REG_OUTPUT1_CLK != "CLK0" || RESETMODE != "SYNC") begin : gen_unknown
    $error("ALU54B: only a register at the sum is known here");
  end
  logic [35:0] ma, mb;
  logic [53:0] a, b, c, sum, r;
  assign ma = {vector("MA", 36)};
  assign mb = {vector("MB", 36)};
  always_comb begin
    case ({{OP1, OP0}})
      2'b01: a = {{{{18{{SIGNEDIA && ma[35]}}}}, ma}};
      2'b11: a = '0;
      default: a = 'x;
    endcase
    case ({{OP3, OP2}})
      2'b00: b = {{mb, 18'd0}};
      2'b01: b = {{{{18{{SIGNEDIB && mb[35]}}}}, mb}};
      2'b11: b = '0;
      default: b = 'x;
    endcase
    case ({{OP6, OP5, OP4}})
      3'b000: c = '0;
      3'b010: c = {vector("CIN", 54)};
      default: c = 'x;
    endcase
    case ({{OP10, OP9, OP8, OP7}})
      4'b0100: sum = a + b + c;
      4'b0101: sum = a - b + c;
      4'b0110: sum = a + b - c;
      4'b0111: sum = a - b - c;
      default: sum = 'x;
    endcase
  end
  always_ff @(posedge CLK0) begin
    if (RST0) r <= '0;
    else if (CE0) r <= sum;
  end
  assign {vector("R", 54)} = r;
endmodule
"""


def main():
    folder = pathlib.Path(sys.argv[1])
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "MULT18X18D.sv").write_text(MULT18X18D, encoding="utf-8")
    (folder / "ALU54B.sv").write_text(ALU54B, encoding="utf-8")


if __name__ == "__main__":
    main()
