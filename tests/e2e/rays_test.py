"""--rays and --hits: files as NumPy writes and reads them, answers worked out by hand, --lattice."""
import io
import os
import subprocess
import threading
import unittest

import numpy as np
from programs import QUAD_OBJ, ROOT, ProgramTest, main

HIT = np.dtype([("id", "<i4"), ("t", "<f8"), ("u", "<f8"), ("v", "<f8")])


class GivenRays(ProgramTest):
    def setUp(self):
        super().setUp()
        self.write("q.obj", QUAD_OBJ)

    def trace(self, rays, *words, code=0, version=(1, 0)):
        with open(self.folder / "in.npy", "wb") as file:
            np.lib.format.write_array(file, rays, version=version)
        done = self.host("q.obj", "--rays", "in.npy", "--hits", "out.npy", *words, code=code)
        return np.load(self.folder / "out.npy") if code == 0 else done.stderr

    def test_answers_by_hand(self):
        rays = np.array([[0.5, -0.5, 2, 0, 0, -1],    # from above: triangle 0 (1 2 3)
                         [-0.5, 0.5, -4, 0, 0, 2],    # from below: triangle 1 (1 3 4), t = 2
                         [0, 0, 1, 0, 0, -0.5],       # on the shared edge: the lower id
                         [5, 5, 1, 0, 0, -1],         # beside
                         [0.5, -0.5, 2, 0, 0, 1],     # pointing away
                         [-3, 0, 0, 1, 0, 0]], float)  # in the plane: no hit
        hits = self.trace(rays)
        self.assertEqual(hits.dtype, HIT)
        self.assertEqual(list(hits["id"]), [0, 1, 0, -1, -1, -1])
        np.testing.assert_allclose(hits["t"][:3], [2, 2, 2], atol=1e-4)
        self.assertTrue(np.isinf(hits["t"][3:]).all())
        self.assertTrue((hits["u"][3:] == 0).all() and (hits["v"][3:] == 0).all())
        # (0.5, -0.5) = (-1, -1) + u (2, 0) + v (2, 2): v = 0.25, u = 0.5.
        np.testing.assert_allclose([hits["u"][0], hits["v"][0]], [0.5, 0.25], atol=1e-4)

    def test_tmin_and_tmax_cut_the_ray(self):
        ray = [0.5, -0.5, 2, 0, 0, -1]
        hits = self.trace(np.array([ray + [0, 1.9], ray + [2.1, 9], ray + [1.9, 2.1],
                                    ray + [0, np.inf]]))
        self.assertEqual(list(hits["id"]), [-1, -1, 0, 0])
        np.testing.assert_allclose(hits["t"][2:], 2, atol=1e-4)

    def test_any_hit(self):
        hits = self.trace(np.array([[-0.5, 0.5, 2, 0, 0, -1], [5, 5, 1, 0, 0, -1]], float), "--any-hit")
        self.assertEqual(list(hits["id"]), [0, -1])
        for name in ("t", "u", "v"):
            self.assertTrue(np.isnan(hits[name]).all())

    def test_format_versions_and_no_rays(self):
        ray = np.array([[0.5, -0.5, 2, 0, 0, -1]])
        for version in ((1, 0), (2, 0), (3, 0)):
            self.assertEqual(list(self.trace(ray, version=version)["id"]), [0])
        self.assertEqual(self.trace(np.zeros((0, 8))).shape, (0,))

    def test_the_order_is_that_of_the_rays(self):
        rng = np.random.default_rng(1)
        rays = np.concatenate([rng.uniform(-2, 2, (5000, 2)), np.full((5000, 1), 3.0),
                               np.tile([0.0, 0, -1], (5000, 1))], axis=1)
        inside = (np.abs(rays[:, :2]) < 0.999).all(axis=1)
        outside = (np.abs(rays[:, :2]) > 1.001).any(axis=1)
        hits = self.trace(rays, "--batch", "33", "--stats", "s.json")
        self.assertTrue((hits["id"][inside] >= 0).all())
        self.assertTrue((hits["id"][outside] == -1).all())
        self.assertEqual(self.statistics("s.json")["rays"]["primary"], 5000)

    def test_refusals_say_what_to_do(self):
        ray = np.array([[0.5, -0.5, 2, 0, 0, -1]])
        for rays, words in ((ray.astype("<f4"), "astype"), (ray.astype(">f8"), "astype"),
                            (ray[:, :5], "tmin"), (ray[0], "tmin"),
                            (np.asfortranarray(np.repeat(ray, 3, 0)), "ascontiguousarray"),
                            (ray * np.nan, "row 0"), (np.vstack([ray, 0 * ray]), "row 1")):
            with self.subTest(words=words, rays=rays.dtype):
                message = self.trace(rays, code=3)
                self.assertIn("in.npy", message)
                self.assertIn(words, message)
                self.assertNotIn("out.npy", self.entries())

    def test_rays_may_come_through_a_pipe(self):
        os.mkfifo(self.folder / "pipe.npy")
        content = io.BytesIO()
        np.save(content, np.array([[0.5, -0.5, 2, 0, 0, -1]]))

        def feed():
            (self.folder / "pipe.npy").write_bytes(content.getvalue())

        feeder = threading.Thread(target=feed)
        feeder.start()
        self.host("q.obj", "--rays", "pipe.npy", "--hits", "out.npy")
        feeder.join()
        self.assertEqual(list(np.load(self.folder / "out.npy")["id"]), [0])


class LatticeFile(ProgramTest):
    def test_arrays_have_their_types_and_meaning(self):
        self.write("q.obj", QUAD_OBJ)
        np.save(self.folder / "in.npy", np.array([[0.5, -0.5, 2, 0, 0, -1], [5, 5, 1, 0, 0, -1]], float))
        self.host("q.obj", "--rays", "in.npy", "--hits", "out.npy", "--lattice", "l.npz", "--bits", "8")
        data = np.load(self.folder / "l.npz")
        shapes = {name: (data[name].dtype.str, data[name].shape) for name in data.files}
        self.assertEqual(shapes, {"q": ("<i4", (3, 3, 3)), "s": ("<i4", (3,)), "lo": ("<f4", (3,)),
                                  "P0": ("<i4", (2, 3)), "P1": ("<i4", (2, 3)),
                                  "bits": ("<i4", ()), "box": ("<i4", (3,)),
                                  "rays": ("<f8", (2, 8)), "vertices": ("<f4", (3, 3, 3))})
        # (2 2^s <= 2^8 - 5 = 251): s = 6, so -1 becomes 2 and 1 becomes 130.
        self.assertEqual(list(data["s"]), [6, 6, 6])
        self.assertEqual(data["q"][0].tolist(), [[2, 2, 2], [130, 2, 2], [130, 130, 2]])
        self.assertEqual(data["q"][2].tolist(), [[2, 2, 2], [2, 2, 2], [130, 2, 2]])
        self.assertEqual(list(data["box"]), [132, 132, 4])
        self.assertEqual(data["P0"].tolist(), [[98, 34, 4], [-1, -1, -1]])
        self.assertEqual(data["P1"].tolist(), [[98, 34, 0], [-1, -1, -1]])
        self.assertEqual(data["rays"][0].tolist(), [0.5, -0.5, 2, 0, 0, -1, 0, np.inf])

    def test_the_checker_proves_the_answers(self):
        for words in (["builtin:teapot", "--size", "40x30"],
                      ["builtin:sheet?triangles=128", "--size", "40x30", "--bits", "24"],
                      ["builtin:demo", "--size", "20x15", "--any-hit"]):
            with self.subTest(words=words):
                self.host(*words, "--hits", "h.npy", "--lattice", "l.npz")
                audit = [ROOT / "tools/audit", "h.npy", "--lattice", "l.npz", "--sample", "300"]
                done = subprocess.run(audit + ["--any-hit"] * ("--any-hit" in words), cwd=self.folder,
                                      capture_output=True, text=True, check=False)
                self.assertEqual(done.returncode, 0, done.stdout + done.stderr)

    def test_the_same_run_writes_the_same_bytes(self):
        for name in ("a.npz", "b.npz"):
            self.host("builtin:teapot", "--size", "8x6", "--lattice", name)
        self.assertEqual(self.read("a.npz"), self.read("b.npz"))


if __name__ == "__main__":
    main()
