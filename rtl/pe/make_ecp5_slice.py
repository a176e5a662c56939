#!/usr/bin/env python3
"""Writes gridrt_ecp5_slice.sv: gridrt_product_pair from the cells of an ECP5, a port a bit.

  rtl/pe/make_ecp5_slice.py FILE

One slice of the sysDSP: two MULT18X18D, whose products enter an ALU54B. What OP0 to OP10 select and
what the multiplexers before the adder are is in Lattice's simulation library (module ALU54A) and in
its technical note FPGA-TN-02205, "ECP5 sysDSP usage guide". nextpnr asks that A and B of the ALU
come from ROA and ROB of its multipliers, and routes a chain from R of a slice to CIN of the next.
"""
import pathlib
import sys

ADD, SUBTRACT = 0b0100, 0b0101  # OP10..7: A + B + C, A - B + C
CHAIN, NO_C = 0b010, 0b000  # OP6..4: C is CIN, or 0
B_HIGH, B = 0b00, 0b01  # OP3..2: B is 2^18 MB, or MB
A = 0b01  # OP1..0: A is MA


def bits(port, wire, count, first=0):
    """Connections of the ports port0 ... to the bits of a vector."""
    lines, line = [], ""
    for i in range(count):
        word = f".{port}{i}({wire}[{first + i}]), "
        if len(line) + len(word) > 92:
            lines.append(line.rstrip())
            line = ""
        line += word
    return "\n      ".join([*lines, line.rstrip(" ,")])


def multiplier(name, at, low_signed):
    """One MULT18X18D: factors and product end at registers. SOURCEA and SOURCEB choose the factors that
    come from the fabric; nextpnr ties neither."""
    return f"""  MULT18X18D #(
      .REG_INPUTA_CLK("CLK0"), .REG_INPUTB_CLK("CLK0"), .REG_PIPELINE_CLK("CLK0"),
      .SOURCEB_MODE("B_SHIFT"), .RESETMODE("SYNC")
  ) {name} (
      .CLK0(clk_i), .CE0(1'b1), .RST0(1'b0), .SIGNEDA(1'b1), .SIGNEDB({low_signed}),
      .SOURCEA(1'b0), .SOURCEB(1'b0),
      {bits("A", f"a{at}_i", 18)},
      {bits("B", f"b{at}_i", 18)},
      {bits("ROA", f"factors{at}", 18)},
      {bits("ROB", f"factors{at}", 18, 18)},
      {bits("P", f"product{at}", 36)},
      .SIGNEDP(is_signed[{at}])
  );
"""


def adder(subtract, chain):
    """The ALU54B of one kind of slice."""
    op = ((SUBTRACT if subtract else ADD) << 7 | (CHAIN if chain else NO_C) << 4
          | (B if subtract else B_HIGH) << 2 | A)
    cin = bits("CIN", "sum_i", 54) + ",\n      " if chain else ""
    op_bits = ", ".join(f".OP{i}(1'b{op >> i & 1})" for i in range(11))
    return f"""    ALU54B #(
        .REG_OUTPUT0_CLK("CLK0"), .REG_OUTPUT1_CLK("CLK0"), .RESETMODE("SYNC")
    ) adder (
      .CLK0(clk_i), .CE0(1'b1), .RST0(1'b0), .SIGNEDIA(is_signed[0]), .SIGNEDIB(is_signed[1]),
      {op_bits},
      {bits("A", "factors0", 36)},
      {bits("B", "factors1", 36)},
      {bits("MA", "product0", 36)},
      {bits("MB", "product1", 36)},
      {cin}{bits("R", "sum_o", 54)}
    );"""


def main():
    pathlib.Path(sys.argv[1]).write_text(f"""// Made by rtl/pe/make_ecp5_slice.py.
/* verilator lint_off PINMISSING */
/* verilator lint_off UNUSED */
module gridrt_ecp5_slice #(
    parameter bit SUBTRACT = 1'b0,
    parameter bit CHAIN = 1'b0
) (
    input  logic        clk_i,
    input  logic [17:0] a0_i, b0_i, a1_i, b1_i,
    input  logic [53:0] sum_i,
    output logic [53:0] sum_o
);
  logic [35:0] factors0, factors1, product0, product1;
  logic [1:0] is_signed;
{multiplier("low", 0, "SUBTRACT")}
{multiplier("high", 1, "1'b1")}
  if (SUBTRACT) begin : gen_subtract
{adder(True, False)}
  end else if (CHAIN) begin : gen_chain
{adder(False, True)}
  end else begin : gen_add
{adder(False, False)}
  end
endmodule
""", encoding="utf-8")


if __name__ == "__main__":
    main()
