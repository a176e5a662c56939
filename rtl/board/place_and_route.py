"""nextpnr in two steps: a netlist is placed with several seeds, and the one with the shortest wires is
routed. Of placements that are as fast the longer one may not be routable at all (docs/results/route.txt).
"""
import concurrent.futures
import json
import os
import re

NEXTPNR = "nextpnr-ecp5"
PART = ["--um5g-85k", "--speed", 8, "--package", "CABGA554"]
CLOCK = re.compile(r"Max frequency for clock\s+'[^']*': ([\d.]+) MHz")
WIRES = re.compile(r"wirelen = (\d+)")


def seeds(text):
    """The seeds that an option lists; ValueError if they are no numbers."""
    return [int(word) for word in text.split(",")]


def place(run, root, netlist, arguments, numbers, router):
    """Places a netlist with seeds of these numbers, as many at once as there are cores, and prints what
    comes of each. `run` runs a program with arguments below `root` and writes a log. Returns the seed
    with the shortest wires and the placed netlist, for route()."""
    def one(seed):
        placed = netlist.with_name(f"{netlist.stem}_placed_{seed}.json")
        log = placed.with_suffix(".log")
        run(NEXTPNR, [*PART, *arguments, "--timing-allow-fail", "--seed", seed, "--router", router,
                      "--no-route", "--json", netlist, "--write", placed], log)
        text = (root / log).read_text(encoding="utf-8")
        return int(WIRES.findall(text)[-1]), seed, placed, min(map(float, CLOCK.findall(text)))

    with concurrent.futures.ThreadPoolExecutor(os.cpu_count() or 1) as pool:
        found = sorted(pool.map(one, numbers))
    for length, seed, _, megahertz in found:
        print(f"placed with seed {seed}: wires of {length}, {megahertz:.1f} MHz before routing", flush=True)
    return found[0][1:3]


def route(run, root, placed, arguments, stem):
    """Routes a placed netlist, with the router and for the frequency that place() was given: nextpnr
    keeps them in the netlist. Returns its report; writes STEM.sdf (delays) and STEM.log."""
    report = stem.with_suffix(".report.json")
    run(NEXTPNR, [*PART, *arguments, "--timing-allow-fail", "--threads", os.cpu_count() or 1, "--no-pack",
                  "--no-place", "--json", placed, "--tmg-ripup", "--report", report, "--sdf",
                  stem.with_suffix(".sdf")], stem.with_suffix(".log"))
    return json.loads((root / report).read_text(encoding="utf-8"))


def from_slices(delays):
    """Nanoseconds of the longest wire out of an adder of the sysDSP: nextpnr has no delays of it, so
    its paths are left out of the clock that it reports."""
    longest = 0
    with open(delays, encoding="utf-8") as lines:
        for line in lines:
            found = re.match(r"\s*\(INTERCONNECT \S*adder/R\d+ \S+ \((\d+):", line)
            if found:
                longest = max(longest, int(found[1]))
    return longest / 1000


def most_from_slices(megahertz):
    """Nanoseconds that such a wire may take: half a clock, the rest is for the registers at its ends."""
    return 500 / megahertz
