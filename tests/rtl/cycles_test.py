#!/usr/bin/env python3
"""Clocks of a ray do not get worse unnoticed: few rays on two meshes, all views together.

The limits are those of tools/board-cycles --check, which looks at every view with all rays.
"""
import collections
import json
import subprocess
import sys

SCENES = ("builtin:teapot?tessellation=11", "builtin:sphere?kind=uv&segments=80")
LIMITS = {"primary": 3.25, "shadow": 5.5, "mirror": 5.5}
PES = 4
LEAST_PACE = 0.9  # tests a clock of a PE that has work


def main():
    program = sys.argv[1]
    failed = False
    for scene in SCENES:
        run = subprocess.run([program, scene, "--rays", "1000"], check=False,
                             stdout=subprocess.PIPE, text=True)
        waves = [json.loads(line) for line in run.stdout.splitlines()]
        if run.returncode or len(waves) < 13:
            print(f"{scene}: exit code {run.returncode}, {len(waves)} waves")
            failed = True
        clocks, rays = collections.Counter(), collections.Counter()
        tests, work = collections.Counter(), collections.Counter()
        for wave in waves:
            kind = wave["wave"].split()[0]
            clocks[kind] += wave["clocks"]
            rays[kind] += wave["rays"]
            for pe, counts in enumerate(wave["pes"]):
                tests[kind, pe] += counts["tests"]
                work[kind, pe] += counts["work"]
            if wave["wrong"]:
                print(f"{scene}, {wave['wave']}: {wave['wrong']} wrong answers")
                failed = True
        for kind, limit in LIMITS.items():
            figure = clocks[kind] / max(1, rays[kind])
            print(f"{scene}: {figure:.2f} clocks a {kind} ray, at most {limit}")
            paces = [tests[key] / work[key] for key in tests if key[0] == kind and work[key]]
            pace = min(paces, default=0.0)
            print(f"{scene}: {pace:.3f} tests a clock with work, at least {LEAST_PACE}")
            failed = failed or figure > limit or len(paces) < PES or pace < LEAST_PACE
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
