"""Runs the contract, and one program of adversarial cases, on the device mpi under mpirun.

The longer runs are the same by hand: GRIDRT_DEVICES=mpi mpirun -n 4 build/bin/contract, or any
build/bin/adversarial_*; without mpirun each device that a test opens starts a job of its own.
"""
import argparse
import os
import subprocess
import sys

from mpi_support import mpirun
from programs import BIN


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n", maxsplit=1)[0])
    parser.add_argument("ranks", type=int)
    parser.add_argument("--tcp", action="store_true", help="not through shared memory")
    parser.add_argument("--rays", type=int, default=200, help="of the contract (default: 200)")
    options = parser.parse_args()
    environment = dict(os.environ, GRIDRT_DEVICES="mpi", GRIDRT_CONTRACT_RAYS=str(options.rays),
                       GRIDRT_FRACTION="1/64")
    for program in ("contract", "adversarial_degenerate"):
        words = mpirun(options.ranks, options.tcp) + [str(BIN / program), "--gtest_brief=1"]
        done = subprocess.run(words, env=environment, check=False)
        if done.returncode != 0:
            sys.exit(f"{' '.join(words)} ended with {done.returncode}")


if __name__ == "__main__":
    main()
