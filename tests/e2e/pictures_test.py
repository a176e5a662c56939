"""Pictures and hits: the same bytes however they are made, and the counts that --stats tells."""
import struct
import unittest

import numpy as np
from programs import QUAD_OBJ, ROOT, ProgramTest, main

SMALL = ("--size", "64x48")
NAMES = {"device", "lattice_bits", "grid", "triangles", "degenerate", "pes", "rays", "steps", "tests",
         "masked", "interrupts", "feedback_waits", "cycles", "cycles_per_ray", "bytes_out",
         "bytes_in", "frames_retried", "flagged", "retraced", "disagreements_bound", "seconds"}
PHASES = {"load", "build", "upload", "trace", "shade", "write", "total"}


def read_pfm(data):
    """(height, width, 3) float32, row 0 on top."""
    magic, size, scale, rows = data.split(b"\n", 3)
    assert magic == b"PF" and float(scale) == -1.0
    width, height = map(int, size.split())
    return np.frombuffer(rows, "<f4").reshape(height, width, 3)[::-1]


class SameAnswer(ProgramTest):
    SCENE = ("builtin:demo?tessellation=3&subdivisions=1", *SMALL, "--samples", "2", "--depth", "3")

    def test_nothing_but_the_scene_decides(self):
        self.host(*self.SCENE, "--device", "seq", "-o", "a.pfm", "--hits", "a.npy")
        for change in (["--device", "omp"], ["--pes", "1"], ["--pes", "2"], ["--pes", "8"],
                       ["--batch", "1"], ["--batch", "7"], ["--batch", "100000"],
                       ["--threads", "1"], ["--threads", "5"], ["--grid", "1x1x1"],
                       ["--grid", "9x5x7"], ["--mapping", "voxel"], ["--mapping", "contiguous"],
                       ["--layout", "compact"]):
            with self.subTest(change=change):
                self.host(*self.SCENE, *change, "-o", "b.pfm", "--hits", "b.npy")
                self.assertEqual(self.read("a.npy"), self.read("b.npy"))
                self.assertEqual(self.read("a.pfm"), self.read("b.pfm"))

    def test_bits_change_the_lattice_and_so_the_answer(self):
        self.host(*self.SCENE, "--hits", "a.npy")
        self.host(*self.SCENE, "--hits", "b.npy", "--bits", "9")
        self.assertNotEqual(self.read("a.npy"), self.read("b.npy"))

    def test_an_image_file_stands_for_its_scene(self):
        scene = self.SCENE[0]
        self.host(*self.SCENE, "-o", "a.pfm", "--hits", "a.npy", "--lattice", "a.npz")
        for cut in ([], ["--pes", "1", "--grid", "8x3x8"], ["--layout", "compact"]):
            with self.subTest(cut=cut):
                self.image(scene, "-o", "s.grt", *cut)
                self.image("--verify", "s.grt")
                self.host("s.grt", *self.SCENE[1:], "-o", "b.pfm", "--hits", "b.npy",
                          "--lattice", "b.npz")
                for ending in ("pfm", "npy", "npz"):
                    self.assertEqual(self.read("a." + ending), self.read("b." + ending))

    def test_hits_without_a_picture_are_those_of_the_picture(self):
        self.host(*self.SCENE, "-o", "a.png", "--hits", "a.npy")
        self.host(*self.SCENE, "--hits", "b.npy", "--stats", "b.json")
        self.assertEqual(self.read("a.npy"), self.read("b.npy"))
        rays = self.statistics("b.json")["rays"]
        self.assertEqual(rays["total"], rays["primary"])


class Statistics(ProgramTest):
    def test_all_names_are_there(self):
        self.host("builtin:demo", *SMALL, "--stats", "s.json", "--pes", "2", "--bits", "15")
        stats = self.statistics("s.json")
        self.assertLessEqual(NAMES, stats.keys())
        self.assertEqual(stats["seconds"].keys(), PHASES)
        self.assertEqual(stats["pes"], 2)
        self.assertEqual(stats["lattice_bits"], 15)
        self.assertEqual(stats["device"], "omp")
        self.assertEqual(stats["rays"]["primary"], 64 * 48)
        for kind in ("shadow", "mirror", "refraction"):
            self.assertGreater(stats["rays"][kind], 0)
        self.assertGreater(stats["tests"], 0)
        self.assertLessEqual(sum(stats["seconds"][p] for p in PHASES - {"total"}),
                             stats["seconds"]["total"] * 1.01)

    def test_a_scene_pays_only_for_what_it_has(self):
        self.host("builtin:teapot?lights=0", *SMALL, "--stats", "s.json")
        rays = self.statistics("s.json")["rays"]
        self.assertEqual([rays[k] for k in ("shadow", "mirror", "refraction")], [0, 0, 0])
        self.host("builtin:teapot", *SMALL, "--stats", "s.json")
        rays = self.statistics("s.json")["rays"]
        self.assertGreater(rays["shadow"], 0)
        self.assertEqual([rays[k] for k in ("mirror", "refraction")], [0, 0])
        self.host("builtin:demo", *SMALL, "--depth", "0", "--stats", "s.json")
        rays = self.statistics("s.json")["rays"]
        self.assertEqual([rays[k] for k in ("mirror", "refraction")], [0, 0])

    def test_degenerate_triangles_are_counted(self):
        self.write("q.obj", QUAD_OBJ)
        self.host("q.obj", *SMALL, "--stats", "s.json", "--hits", "h.npy")
        stats = self.statistics("s.json")
        self.assertEqual((stats["triangles"], stats["degenerate"]), (3, 1))
        self.assertEqual(set(np.load(self.folder / "h.npy")["id"]), {-1, 0, 1})


class Pictures(ProgramTest):
    def test_formats_hold_the_same_picture(self):
        for ending in ("pfm", "png", "exr"):
            self.host("builtin:demo", *SMALL, "-o", "a." + ending)
        linear = read_pfm(self.read("a.pfm"))
        self.assertEqual(linear.shape, (48, 64, 3))
        png = self.read("a.png")
        self.assertEqual(png[:8], b"\x89PNG\r\n\x1a\n")
        self.assertEqual(struct.unpack(">II", png[16:24]), (64, 48))
        self.assertEqual(self.read("a.exr")[:4], b"\x76\x2f\x31\x01")

    def test_row_zero_is_on_top_and_column_zero_on_the_left(self):
        # A triangle in the upper left quarter only.
        self.write("t.obj", "v -1 0.1 0\nv -0.1 0.1 0\nv -0.5 1 0\nf 1 2 3\n")
        view = ("--eye", "0,0,4", "--look", "0,0,0", "--up", "0,1,0", "--fov", "40")
        self.host("t.obj", *SMALL, *view, "-o", "a.pfm", "--hits", "h.npy")
        hit = np.load(self.folder / "h.npy")["id"].reshape(48, 64) >= 0
        self.assertTrue(hit[:24, :32].any())
        self.assertFalse(hit[24:, :].any() or hit[:, 32:].any())
        lit = read_pfm(self.read("a.pfm"))[..., 0] > 0
        self.assertTrue((lit == hit).all())

    def test_default_camera_shows_all(self):
        self.host(ROOT.parent / "shared/scenes/suzanne.obj" if
                  (ROOT.parent / "shared/scenes/suzanne.obj").exists() else "builtin:teapot",
                  *SMALL, "--hits", "h.npy")
        hit = np.load(self.folder / "h.npy")["id"].reshape(48, 64) >= 0
        self.assertGreater(hit.mean(), 0.1)
        self.assertFalse(hit[0].any() or hit[-1].any() or hit[:, 0].any() or hit[:, -1].any())

    def test_samples_are_adjacent(self):
        self.host("builtin:teapot", "--size", "8x6", "--samples", "4", "--lattice", "l.npz")
        rays = np.load(self.folder / "l.npz")["rays"]
        self.assertEqual(rays.shape, (8 * 6 * 4, 8))
        mean = rays[:, 3:6].reshape(6, 8, 4, 3).mean(axis=2)
        self.host("builtin:teapot", "--size", "8x6", "--lattice", "l.npz")
        centre = np.load(self.folder / "l.npz")["rays"][:, 3:6].reshape(6, 8, 3)
        self.assertLess(np.abs(mean - centre).max(), 0.01)

    def test_empty_scenes_have_a_picture(self):
        self.host("builtin:empty", "--size", "4x4", "-o", "a.pfm", "--hits", "h.npy",
                  "--stats", "s.json", "--lattice", "l.npz")
        self.assertTrue((np.load(self.folder / "h.npy")["id"] == -1).all())
        self.assertEqual(np.load(self.folder / "l.npz")["q"].shape, (0, 3, 3))


class Explain(ProgramTest):
    def test_a_life_ends_with_the_answer(self):
        self.host("builtin:teapot", *SMALL, "--hits", "h.npy")
        hits = np.load(self.folder / "h.npy")["id"].reshape(48, 64)
        y, x = map(int, np.argwhere(hits >= 0)[20])
        told = self.host("builtin:teapot", *SMALL, "--explain", f"{x},{y}").stdout.splitlines()
        self.assertEqual(told[0], f"pixel {x},{y}")
        self.assertTrue(told[-1].startswith(f"commit      triangle {hits[y, x]},"), told[-1])
        self.assertTrue(any(line.startswith("voxel ") for line in told))
        self.assertTrue(any("hit, key" in line for line in told))
        self.assertEqual(self.entries(), ["h.npy"])


if __name__ == "__main__":
    main()
