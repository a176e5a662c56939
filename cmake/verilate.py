#!/usr/bin/env python3
"""Turns RTL into C++ for cmake/GridrtVerilator.cmake.

Runs Verilator on one top module and gathers what it wrote into two files whose names are known in
advance: PREFIX__fast.cpp and PREFIX__slow.cpp (constructors and waves' set-up, run once). Writes a
dependency file too, so that the model is made again if one of the files read has changed.
"""
import argparse
import pathlib
import re
import shutil
import subprocess
import sys


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("--verilator", required=True)
    parser.add_argument("--prefix", required=True, help="name of the C++ class")
    parser.add_argument("--folder", required=True, type=pathlib.Path, help="where to write")
    parser.add_argument("--depfile", required=True, type=pathlib.Path)
    parser.add_argument("arguments", nargs=argparse.REMAINDER, help="after --: for Verilator")
    options = parser.parse_args()
    arguments = options.arguments[1:]  # without the "--"

    model = options.folder / "model"
    shutil.rmtree(model, ignore_errors=True)  # no file of an older model may be gathered
    model.mkdir(parents=True)
    run = subprocess.run([options.verilator, "--cc", "--prefix", options.prefix, "--Mdir",
                          str(model), *arguments], check=False)
    if run.returncode:
        return run.returncode

    sources = sorted(f for f in model.glob("*.cpp"))
    for kind, chosen in (("slow", [f for f in sources if "__Slow" in f.stem or "Syms" in f.stem]),
                         ("fast", [f for f in sources
                                   if "__Slow" not in f.stem and "Syms" not in f.stem])):
        gathered = options.folder / f"{options.prefix}__{kind}.cpp"
        gathered.write_text("".join(f'#include "{f.name}"\n' for f in chosen), encoding="utf-8")

    words = (model / f"{options.prefix}__ver.d").read_text(encoding="utf-8")
    read = re.sub(r"\\\n", " ", words).split(":", 1)[1].split()
    output = options.folder / f"{options.prefix}__fast.cpp"
    options.depfile.write_text(f"{output}: {' '.join(sorted(set(read)))}\n", encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
