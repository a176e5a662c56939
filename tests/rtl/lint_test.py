#!/usr/bin/env python3
"""Runs "verilator --lint-only -Wall" with every module of a folder as the top.

A module is taken with its default parameters, as it is and with assertions and registers that run
freely, on as many processors as there are. File and module have the same name. At the end the
linter must find two defects that are put in on purpose, so that it cannot be silent for another
reason.
"""
import argparse
import concurrent.futures
import os
import pathlib
import re
import subprocess
import sys
import tempfile

MODULE = re.compile(r"^\s*module\s+(\w+)", re.M)
# See cmake/GridrtVerilator.cmake.
OTHERWISE = ["-DGRIDRT_ASSERT", "-DGRIDRT_FREE_RUNNING", "-Wno-SYNCASYNCNET", "-Wno-CMPCONST"]
DEFECTS = {  # each with the warning that it must raise
    "WIDTH": "module {0} (input logic [3:0] a_i, output logic [2:0] b_o);\n"
             "  assign b_o = a_i;\nendmodule\n",
    "UNUSED": "module {0} (input logic a_i, output logic b_o);\n"
              "  assign b_o = 1'b0;\nendmodule\n",
}


def lint(verilator, flags, top, file):
    """(exit code, what the linter said)"""
    run = subprocess.run([verilator, "--lint-only", "-Wall", "--assert", "--no-timing",
                          "--top-module", top, *flags, str(file)],
                         capture_output=True, text=True, check=False)
    return run.returncode, run.stderr


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("--verilator", default="verilator")
    parser.add_argument("--protocol", type=pathlib.Path, action="append", default=[],
                        help="generated package")
    parser.add_argument("--library", type=pathlib.Path, action="append", default=[],
                        help="folder of somebody else's modules")
    parser.add_argument("folder", type=pathlib.Path)
    options = parser.parse_args()

    files = sorted(options.folder.rglob("*.sv"))
    packages = [f for f in files if f.stem.endswith("_pkg")]
    packages.sort(key=lambda f: f.stem != "gridrt_pkg")  # the others use it
    modules = [f for f in files if f not in packages]
    if not modules:
        sys.exit(f"lint: no module below {options.folder}")
    flags = [word for folder in sorted({f.parent for f in files}) for word in ("-y", str(folder))]
    flags += [word for folder in options.library for word in ("-y", str(folder))]
    flags += [str(f) for f in options.folder.rglob("*.vlt")]
    flags += [str(file) for file in options.protocol]
    flags += [str(f) for f in packages]

    problems = 0
    for file in modules:
        names = MODULE.findall(file.read_text(encoding="utf-8"))
        if names != [file.stem]:
            problems += 1
            print(f"{file}: holds {', '.join(names) or 'no module'}; expected one module "
                  f"named {file.stem}")
    jobs = [(file, more) for file in modules for more in ([], OTHERWISE)]
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        runs = pool.map(lambda job: lint(options.verilator, flags + job[1], job[0].stem, job[0]),
                        jobs)
        for (file, more), (code, said) in zip(jobs, runs):
            if code or said.strip():
                problems += 1
                print(f"{file} {' '.join(more)}\n{said}")
    with tempfile.TemporaryDirectory() as scratch:
        for number, (warning, text) in enumerate(DEFECTS.items()):
            file = pathlib.Path(scratch) / f"defect_{number}.sv"
            file.write_text(text.format(file.stem), encoding="utf-8")
            code, said = lint(options.verilator, flags, file.stem, file)
            if not code or f"%Warning-{warning}" not in said:
                problems += 1
                print(f"the linter is silent about {warning}:\n{text}\n{said}")
    print(f"lint: {len(modules)} modules, {problems} problem{'s' * (problems != 1)}")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
