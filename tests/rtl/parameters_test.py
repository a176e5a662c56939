#!/usr/bin/env python3
"""Illegal parameters of the hardware are refused at elaboration, by a message that names them.

Each case sets one parameter of a module to a value that it cannot have; legal neighbours of them
must pass, so that a module that refuses everything fails.
"""
import argparse
import concurrent.futures
import os
import pathlib
import subprocess
import sys

# Module, parameters, a word of the message; None: legal.
CASES = [
    ("gridrt_engine", {"B": 18}, "B must be"),
    ("gridrt_engine", {"B": 3}, "B must be"),
    ("gridrt_engine", {"PES": 3}, "PES must be"),
    ("gridrt_engine", {"PES": 8}, "PES must be"),
    ("gridrt_engine", {"TUS": 5, "SLOTS": 60}, "TUS must be"),
    ("gridrt_engine", {"TUS": 4, "SLOTS": 50}, "SLOTS must be"),
    ("gridrt_engine", {"TUS": 3, "SLOTS": 64}, "SLOTS must be"),
    ("gridrt_engine", {"SLOTS": 66}, "SLOTS must be"),
    ("gridrt_engine", {"SLOTS": 0}, "SLOTS must be"),
    ("gridrt_engine", {"ROB": 100}, "ROB must be"),
    ("gridrt_engine", {"QUEUE": 0}, "QUEUE"),
    ("gridrt_engine", {"AHEAD": 3}, "AHEAD must be"),
    ("gridrt_engine", {"BLOCKS": 4097}, "BLOCKS must be"),
    ("gridrt_engine", {"CELLS": 8193}, "CELLS must be"),
    ("gridrt_engine", {"REFS": 16385}, "memory is larger"),
    ("gridrt_engine", {"TRIS": 4097}, "memory is larger"),
    ("gridrt_engine", {"VERTS": 4097}, "memory is larger"),
    ("gridrt_fifo", {"DEPTH": 0}, "DEPTH"),
    ("gridrt_shell", {"B": 18}, "B must be"),
    ("gridrt_shell", {"BLOCKS": 4097}, "memory is larger"),
    ("gridrt_shell", {"MAX_PAYLOAD": 16386}, "MAX_PAYLOAD must be"),
    ("gridrt_shell", {"LOG_WORDS": 500}, "WORDS must be"),
    ("gridrt_expand", {"DEPTH": 4}, "DEPTH below"),
    ("gridrt_traverse", {"QUEUE": 65}, "QUEUE must be"),
    ("gridrt_watch", {"HANG_CLOCKS": 1000}, "HANG_CLOCKS must be"),
    ("gridrt_watch", {"ALIVE_CLOCKS": 1048576}, "ALIVE_CLOCKS at least"),
    ("gridrt_cpu_ram", {"WORDS": 5000}, "WORDS must be"),
    ("gridrt_usb_tail", {"PAUSE": 1}, "PAUSE must be"),
    ("gridrt_watch", {"HANG_CLOCKS": 1024, "ALIVE_CLOCKS": 2048}, None),
    ("gridrt_engine", {}, None),
    ("gridrt_engine", {"B": 4}, None),
    ("gridrt_engine", {"B": 14, "PES": 1}, None),
    ("gridrt_engine", {"B": 12, "PES": 2, "TUS": 1, "SLOTS": 16, "QUEUE": 4, "ROB": 16}, None),
    ("gridrt_engine", {"TUS": 4, "SLOTS": 64}, None),
    ("gridrt_engine", {"TUS": 3, "SLOTS": 63}, None),
    ("gridrt_shell", {"B": 12, "PES": 2, "MAX_PAYLOAD": 4194304, "LOG_WORDS": 64}, None),
    ("gridrt_shell", {"PES": 1, "BLOCKS": 64, "CELLS": 100, "REFS": 200, "TRIS": 50}, None),
    ("gridrt_engine", {"AHEAD": 16}, None),
    ("gridrt_engine", {"AHEAD": 1, "CANCEL": 0, "MASK": 0, "FEEDBACK": 0}, None),
]

# What is not the matter of a case that is refused is small, so that it is elaborated sooner.
SMALL = {"gridrt_engine": {"PES": 1, "TUS": 1, "SLOTS": 16}}


def elaborate(options, module, parameters, message):
    """(exit code, what Verilator said)"""
    if message is not None:
        parameters = SMALL.get(module, {}) | parameters
    files = sorted(options.folder.rglob("*.sv"))
    packages = sorted((f for f in files if f.stem.endswith("_pkg")),
                      key=lambda f: f.stem != "gridrt_pkg")  # the others use it
    folders = [word for folder in sorted({f.parent for f in files}) for word in ("-y", str(folder))]
    top = next(f for f in files if f.stem == module)
    done = subprocess.run(
        [options.verilator, "--lint-only", "-Wall", "--no-timing", "--top-module", module,
         *(f"-G{name}={value}" for name, value in parameters.items()), *folders,
         str(options.protocol), *map(str, packages), str(top)],
        capture_output=True, text=True, check=False)
    return done.returncode, done.stdout + done.stderr


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("--verilator", default="verilator")
    parser.add_argument("--protocol", type=pathlib.Path, required=True, help="generated package")
    parser.add_argument("folder", type=pathlib.Path)
    options = parser.parse_args()
    problems = 0
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        results = pool.map(lambda case: elaborate(options, *case), CASES)
        for (module, parameters, message), (code, said) in zip(CASES, results):
            if message is None and (code or said.strip()):
                problems += 1
                print(f"{module} {parameters}: legal, but:\n{said}")
            if message is not None and (code == 0 or message not in said):
                problems += 1
                print(f"{module} {parameters}: not refused with \"{message}\":\n{said}")
    print(f"parameters: {len(CASES)} cases, {problems} problem{'s' * (problems != 1)}")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
