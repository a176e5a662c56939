"""When outputs change, from the delays that nextpnr --sdf writes: it reports the latest one only.

Delays are those from a register's clock, or from an input's buffer, to an output's buffer, in ns. Clock
tree and buffers are not in them.
"""
import re

BOTH = r"\(\d+:\d+:(\d+)\) \(\d+:\d+:(\d+)\)"  # the slowest of rising and of falling
WIRE = re.compile(r"\s*\(INTERCONNECT (\S+) (\S+) " + BOTH)
CELL = re.compile(r'\s*\(INSTANCE (\S*)\)')
PATH = re.compile(r"\s*\(IOPATH (\S+) (\S+) " + BOTH)
BUFFER = re.compile(r"\S*(?:tr_io|u_pin)/O")  # of an input
CLOCKS = {"CLK", "CLKA", "CLKB", "CLK0", "WCK"}


def read(sdf):
    """({input of a cell: (what drives it, ns)}, {output of a cell: [(input of the cell, ns)]})"""
    drivers, paths, cell = {}, {}, ""
    with open(sdf, encoding="utf-8") as lines:
        for line in lines:
            if found := WIRE.match(line):
                source, sink, *slow = found.groups()
                drivers[sink] = source, max(map(int, slow)) / 1000
            elif found := PATH.match(line):
                begin, end, *slow = found.groups()
                paths.setdefault(f"{cell}/{end}", []).append((f"{cell}/{begin}", max(map(int, slow)) / 1000))
            elif found := CELL.match(line):
                cell = found[1]
    return drivers, paths


def latest(drivers, paths, sink, known):
    """{where it begins: ns} of the slowest ways to a cell's input: "clock", or an input's buffer."""
    if sink in known:
        return known[sink]
    known[sink] = {}  # of a loop, which there is none of
    source, wire = drivers.get(sink, ("", 0.0))
    ways = {}
    for begin, delay in paths.get(source, []):
        before = {"clock": 0.0} if begin.rsplit("/", 1)[1] in CLOCKS else latest(drivers, paths, begin, known)
        for where, at in before.items():
            ways[where] = max(ways.get(where, 0.0), at + delay + wire)
    if source not in paths and BUFFER.fullmatch(source):
        ways[source.rsplit("/", 1)[0]] = wire
    known[sink] = ways
    return ways


def outputs(sdf, wanted):
    """{output's buffer and its input: {where it begins: ns}} for those whose names match `wanted`."""
    drivers, paths = read(sdf)
    known = {}
    return {sink: latest(drivers, paths, sink, known) for sink in sorted(drivers) if wanted.fullmatch(sink)}
