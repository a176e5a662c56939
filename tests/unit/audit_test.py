#!/usr/bin/python3
"""tools/audit accepts hand-worked answers and refuses every way of being wrong."""
import os
import subprocess
import sys
import tempfile
import unittest

import numpy as np

AUDIT = os.path.join(os.path.dirname(__file__), "..", "..", "tools", "audit")
HIT = np.dtype([("id", "<i4"), ("t", "<f8"), ("u", "<f8"), ("v", "<f8")])
INF = float("inf")
NAN = float("nan")


def example():
    """A square of two triangles twice, at 6 bits: 59 steps at the most, so 8 scene units take s = 2
    (32 steps), the flat axis as well; the box is [0, 36]^2 x [0, 4]."""
    square = [[[0, 0, 0], [8, 0, 0], [0, 8, 0]], [[8, 0, 0], [8, 8, 0], [0, 8, 0]]]
    vertices = np.array(square + square, dtype=np.float32)
    data = {
        "vertices": vertices,
        "q": (vertices * 4 + 2).astype(np.int32),
        "s": np.array([2, 2, 2], dtype=np.int32),
        "lo": np.zeros(3, dtype=np.float32),
        "box": np.array([36, 36, 4], dtype=np.int32),
        "bits": np.int32(6),
        "rays": np.array([
            [2, 1, 3, 0, 0, -1, 0, INF],    # triangle 0, at t = 3
            [4, 4, 3, 0, 0, -1, 0, INF],    # the edge between 0 and 1
            [7, 7, 3, 0, 0, -0.5, 0, INF],  # triangle 1
            [7, 7, 3, 0, 0, 1, 0, INF],     # away
            [2, 1, 3, 0, 0, -1, 0, 2.75],   # ends in the box, before the square
        ]),
        "P0": np.array([[10, 6, 4], [18, 18, 4], [30, 30, 4], [-1, -1, -1], [10, 6, 4]], np.int32),
        "P1": np.array([[10, 6, 0], [18, 18, 0], [30, 30, 0], [-1, -1, -1], [10, 6, 3]], np.int32),
    }
    hits = np.array([(0, 3, .25, .125), (0, 3, .5, .5), (1, 6, .75, .125), (-1, INF, 0, 0),
                     (-1, INF, 0, 0)], dtype=HIT)
    return data, hits


class Audit(unittest.TestCase):
    def run_audit(self, data, hits, *options):
        with tempfile.TemporaryDirectory() as folder:
            np.savez(os.path.join(folder, "l.npz"), **data)
            np.save(os.path.join(folder, "h.npy"), hits)
            done = subprocess.run(
                [sys.executable, AUDIT, os.path.join(folder, "h.npy"), "--lattice",
                 os.path.join(folder, "l.npz"), *options],
                capture_output=True, text=True, check=False)
            return done.returncode, done.stdout + done.stderr

    def expect(self, code, text, data, hits, *options):
        got, output = self.run_audit(data, hits, *options)
        self.assertEqual(got, code, output)
        self.assertIn(text, output)
        self.assertNotIn("Traceback", output)

    def test_right_answers(self):
        data, hits = example()
        # Triangle 1 is (8,0), (8,8), (0,8): (7,7) = (8,0) + u (0,8) + v (-8,8), u = 3/4, v = 1/8.
        self.expect(0, "5 of 5 proved", data, hits)
        self.expect(0, "2 of 5 proved", data, hits, "--sample", "2")

    def test_any_hit(self):
        data, hits = example()
        hits["id"] = [0, 0, 0, -1, -1]
        for name in "tuv":
            hits[name] = NAN
        self.expect(0, "hit or miss", data, hits, "--any-hit")
        hits["id"][3] = 0
        self.expect(1, "ray 3", data, hits, "--any-hit")
        hits["id"][3] = -1
        hits["t"][0] = 3
        self.expect(1, "ray 0", data, hits, "--any-hit")

    def test_wrong_answers(self):
        for ray, field, value in ((0, "id", 2), (0, "id", -1), (1, "id", 1), (3, "id", 0),
                                  (0, "t", 3 + 1e-11), (0, "u", .25 + 1e-12), (0, "v", .25),
                                  (2, "t", NAN), (2, "t", INF), (4, "t", 3.0), (3, "u", 1.0)):
            data, hits = example()
            hits[field][ray] = value
            self.expect(1, f"DIFFERENCE: ray {ray}", data, hits)

    def test_wrong_lattice(self):
        for name, place, value, text in (
                ("q", (1, 1, 0), 33, "triangle 1, vertex 1, axis 0"), ("s", 1, 1, "axis 1"),
                ("lo", 2, 1e-20, "axis 2"), ("box", 0, 35, "axis 0"),
                ("P0", (0, 0), 11, "ray 0"), ("P1", (4, 2), 2, "ray 4"), ("P0", (3, 1), 0, "ray 3")):
            data, hits = example()
            data[name][place] = value
            self.expect(1, text, data, hits)

    def test_exact_at_24_bits(self):
        data, hits = example()
        data["bits"] = np.int32(24)
        shift = 20
        data["s"][:] = shift
        data["q"] = (data["vertices"] * 2.0**shift + 2).astype(np.int32)
        data["box"] = np.array([2**23 + 4, 2**23 + 4, 4], dtype=np.int32)
        for name in ("P0", "P1"):
            data[name][:, :2] = data["rays"][:, :2] * 2.0**shift + 2
            data[name][3] = -1
        hits[4] = (-1, INF, 0, 0)
        data["rays"][4, 7] = 3 - 2.0**-shift
        self.expect(0, "5 of 5", data, hits)
        hits["id"][1] = 1
        self.expect(1, "ray 1", data, hits)

    def test_unusable_files(self):
        data, hits = example()
        self.expect(2, "5 rays", data, hits[:4])
        self.expect(2, "structured", data, np.zeros(5))
        for name in list(data):
            short = {k: v for k, v in data.items() if k != name}
            self.expect(2, f"'{name}' is missing", short, hits)
        data["rays"][2, 0] = NAN
        self.expect(2, "ray 2", data, hits)
        data, hits = example()
        data["q"] = data["q"][:, :2]
        self.expect(2, "'q' has shape", data, hits)
        with tempfile.TemporaryDirectory() as folder:
            junk = os.path.join(folder, "junk")
            with open(junk, "wb") as file:
                file.write(b"junk")
            done = subprocess.run([sys.executable, AUDIT, junk, "--lattice", junk],
                                  capture_output=True, text=True, check=False)
            self.assertEqual(done.returncode, 2)
            self.assertIn("junk", done.stderr)
            self.assertNotIn("Traceback", done.stderr)


if __name__ == "__main__":
    unittest.main()
