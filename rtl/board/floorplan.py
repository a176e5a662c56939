#!/usr/bin/env python3
"""Where the multipliers and memories of the PEs are on an LFE5UM5G-85F.

  rtl/board/floorplan.py NETLIST    # yosys' netlist (JSON), which gets an attribute BEL for each

Left alone, nextpnr spreads the slices of a PE over the chip, and two fifths of all wires lead there
(docs/results/route.txt). A chain of slices needs neighbours, besides. Each PE gets a strip of three
blocks of its sysDSP rows, 27 columns wide:

  row 10   det det det tn tn tn    row 22, 46   vertices, ids
  row 34     q   q   q  r  r  r
  row 58     u   u   u  v  v  v    row 70, 82   references, indices

so that a minor's 36 wires reach both of its products without leaving their columns.
Columns 58 to 65 and what is left of the memories' rows are for ray setup and traversal.
"""
import json
import pathlib
import re
import sys

# First column of each block of two slices, by PE; a block has 9 columns and 4 memories beside them.
BLOCKS = ((4, 13, 22), (31, 40, 49), (69, 78, 87), (96, 105, 114))
MEMORY_COLUMNS = (0, 2, 4, 6)  # of a block: EBR0 to EBR3
SLICES = {"det": (10, 0), "tn": (10, 3), "q": (34, 0), "r": (34, 3), "u": (58, 0), "v": (58, 3)}
SLICE = re.compile(r"(?:gen_pe\[(\d)\].*)?u_triangle\.(?:u_(\w+)\.)?gen_axis\[(\d)\]\.u_(\w+)\.u_slice\..*?"
                   r"(low|high|adder)$")
MEMORY = re.compile(r"(?:gen_pe\[(\d)\].*\.)?(u_vertices|u_resolve\.u_ids|u_fetch|u_indices)")
# The kinds of memories in their order, and the rows that they fill.
MEMORIES = ((("u_vertices", "u_resolve.u_ids"), (46, 22)), (("u_fetch", "u_indices"), (82, 70)))


def slice_place(found):
    """BEL of a multiplier or an adder, from what SLICE found in its name."""
    pe, product, axis, minor, part = found.groups()
    row, first = SLICES[product or minor]
    block, half = divmod(first + int(axis), 2)
    at = {"low": 0, "high": 1, "adder": 3}[part] + 4 * half
    kind = "ALU54" if part == "adder" else "MULT18"
    return f"X{BLOCKS[int(pe or 0)][block] + at}/Y{row}/{kind}_{at}"


def memory_places(pe, rows):
    """BELs of the memories in rows of a PE's strip."""
    return [f"X{first + column}/Y{row}/EBR{i}" for row in rows for first in BLOCKS[pe]
            for i, column in enumerate(MEMORY_COLUMNS)]


def place(cells):
    """Gives the PEs' cells their attribute BEL; returns how many."""
    placed, memories = 0, {}
    for name in sorted(cells):
        kind = cells[name]["type"]
        found = {"MULT18X18D": SLICE, "ALU54B": SLICE, "DP16KD": MEMORY}.get(kind)
        found = found and found.search(name)
        if not found:
            continue
        if kind == "DP16KD":
            memories.setdefault((int(found[1] or 0), found[2]), []).append(name)
        else:
            cells[name]["attributes"]["BEL"] = slice_place(found)
            placed += 1
    for pe in range(len(BLOCKS)):
        for kinds, rows in MEMORIES:
            names = [name for kind in kinds for name in memories.get((pe, kind), [])]
            places = memory_places(pe, rows)
            if len(names) > len(places):
                sys.exit(f"floorplan: PE {pe} has {len(names)} memories of {', '.join(kinds)}, room for "
                         f"{len(places)}: give MEMORIES more rows")
            for name, bel in zip(names, places):
                cells[name]["attributes"]["BEL"] = bel
            placed += len(names)
    return placed


def main():
    path = pathlib.Path(sys.argv[1])
    netlist = json.loads(path.read_text(encoding="utf-8"))
    top = max(netlist["modules"].values(), key=lambda m: len(m["cells"]))
    if not place(top["cells"]):
        sys.exit(f"floorplan: {path} has no slice of a PE")
    path.write_text(json.dumps(netlist), encoding="utf-8")


if __name__ == "__main__":
    main()
