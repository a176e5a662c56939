#!/usr/bin/env python3
"""Where the multipliers and memories of the PEs are on an LFE5UM5G-85F, and where nothing is.

  rtl/board/floorplan.py NETLIST    # yosys' netlist (JSON), which gets an attribute BEL for each

Left alone, nextpnr spreads the slices of a PE over the chip, and two fifths of all wires lead there
(docs/results/route.txt). A chain of slices needs neighbours, besides. Each PE gets a strip of three
blocks of its sysDSP rows, 27 columns wide:

  row 10   det det det tn tn tn    row 22, 46   vertices, ids
  row 34     q   q   q  r  r  r
  row 58     u   u   u  v  v  v    row 70, 82   references, indices

so that a minor's 36 wires reach both of its products without leaving their columns.
Columns 58 to 65 and what is left of the memories' rows are for ray setup and traversal.

The placer packs logic until no LUT of a tile is free, and then wires are scarce there. So that a design
of several PEs is spread more evenly, some rows hold LUTs that nothing is connected to.
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
# Rows without logic, the columns of logic, and the LUTs of a tile.
FREE_ROWS = (28, 38, 42, 50, 54, 62, 66, 74, 78)
FEW_FREE_ROWS = FREE_ROWS[::2]  # of a design that needs the room
COLUMNS = range(2, 125)
LUTS = [f"SLICE{s}.K{k}" for s in "ABCD" for k in (0, 1)]
UNUSED = "floorplan_unused_"  # the first letters of their cells' names
# Of nextpnr's router2, which has no options for them: costs of wires that several nets want grow more
# slowly than they do else, and nets look for a way farther around.
ROUTER = {"histCongWeight": "0.5", "currCongWeightMult": "0.5", "biasCostFactor": "0.0",
          "bbMargin/x": "16", "bbMargin/y": "16"}


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


def keep_free(cells, rows):
    """Puts LUTs without wires into rows."""
    for row in rows:
        for column in COLUMNS:
            for lut in LUTS:
                cells[f"{UNUSED}X{column}_Y{row}_{lut}"] = {
                    "type": "LUT4", "parameters": {"INIT": "0" * 16}, "port_directions": {},
                    "connections": {}, "attributes": {"BEL": f"X{column}/Y{row}/{lut}"}}


def fix(path, free_rows=FREE_ROWS):
    """Writes all of it into a netlist; ends the program if that has no PE. A single PE needs no rows
    without logic."""
    netlist = json.loads(path.read_text(encoding="utf-8"))
    top = max(netlist["modules"].values(), key=lambda m: len(m["cells"]))
    if not place(top["cells"]):
        sys.exit(f"floorplan: {path} has no slice of a PE")
    if any("gen_pe[1]" in name for name in top["cells"]):
        keep_free(top["cells"], free_rows)
        top["settings"] = top.get("settings", {}) | {f"router2/{k}": v for k, v in ROUTER.items()}
    path.write_text(json.dumps(netlist), encoding="utf-8")


if __name__ == "__main__":
    fix(pathlib.Path(sys.argv[1]))
