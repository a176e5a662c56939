"""The simulated board from outside: the same bytes as software, clocks, waves, a ray's life."""
import unittest

from programs import BIN, ProgramTest, main

SMALL = ("--size", "80x60")
LARGE = "builtin:teapot?tessellation=20"  # 25,440 triangles: chunks


class SimulatedBoard(ProgramTest):
    def compare(self, scene, *words, device="sim"):
        """Renders with seq and on the device; returns the device's statistics."""
        for name, chosen in (("a", "seq"), ("b", device)):
            self.host(scene, *words, "--device", chosen, "-o", name + ".png", "--hits",
                      name + ".npy", "--stats", name + ".json")
        self.assertEqual(self.read("a.npy"), self.read("b.npy"))
        self.assertEqual(self.read("a.png"), self.read("b.png"))
        return self.statistics("b.json")

    def test_built_in_scenes_are_the_same_bytes_and_cost_clocks(self):
        for scene in ("builtin:demo", "builtin:teapot", "builtin:room", "builtin:sheet"):
            with self.subTest(scene=scene):
                stats = self.compare(scene, *SMALL)
                self.assertEqual((stats["device"], stats["layout"]), ("sim", "compact"))
                self.assertGreater(stats["cycles"], 0)
                self.assertGreater(stats["cycles_per_ray"], 0)
                self.assertEqual(stats["frames_retried"], 0)

    def test_a_scene_in_chunks(self):
        stats = self.compare(LARGE, "--size", "40x30")
        self.assertGreater(stats["chunks"], 1)

    def test_the_small_board(self):
        self.compare("builtin:teapot", *SMALL, "--bits", "12", "--pes", "2", device="sim:b12x2")

    def test_the_life_of_a_ray_ends_with_the_answer(self):
        self.host("builtin:teapot", *SMALL, "--device", "sim", "--hits", "a.npy")
        lives = {}
        for device in ("seq-board", "sim"):  # cut for the same memories
            told = self.host("builtin:teapot", *SMALL, "--device", device, "--explain", "40,30")
            lives[device] = told.stdout.splitlines()
        self.assertEqual(lives["sim"][-1], lives["seq-board"][-1])  # the same commit, key included
        kinds = {line.split()[0] for line in lives["sim"]}
        self.assertLessEqual({"step", "voxel", "test", "feedback", "interrupt", "commit"}, kinds)
        met = {line for line in lives["seq-board"] if line.startswith("voxel") and "PE" in line}
        seen = {line for line in lives["sim"] if line.startswith("voxel")}
        self.assertLessEqual(met, seen)  # the board runs ahead, so it may have seen more

    def test_a_board_that_starts_from_its_flash_needs_no_upload(self):
        scene = ("builtin:cube", "--size", "40x30")
        self.image(scene[0], "--firmware", "cube.flash")
        self.host(*scene, "--device", "sim", "--flash", "cube.flash", "--hits", "a.npy",
                  "--stats", "a.json")
        self.host(*scene, "--device", "sim", "--hits", "b.npy", "--stats", "b.json")
        self.assertEqual(self.read("a.npy"), self.read("b.npy"))
        self.assertEqual(self.statistics("a.json")["uploads"], 0)
        self.assertEqual(self.statistics("b.json")["uploads"], 1)
        self.assertLess(self.statistics("a.json")["bytes_out"],
                        self.statistics("b.json")["bytes_out"] - 1000)
        # Another scene than the one in flash is sent.
        self.host("builtin:cube?size=1,2,3", "--size", "8x6", "--device", "sim", "--flash", "cube.flash",
                  "--stats", "c.json", "-o", "c.png")
        self.assertEqual(self.statistics("c.json")["uploads"], 1)

    def test_flash_images_that_cannot_be_are_refused(self):
        self.image("builtin:cube", "--layout", "wide", "-o", "wide.grt")
        self.image("wide.grt", "--firmware", "f.bin", code=5)
        self.image(LARGE, "--firmware", "f.bin", code=5)
        self.image("--firmware", "f.bin", code=2)
        self.assertEqual(self.entries(), ["wide.grt"])
        self.host("builtin:cube", "--device", "sim", "--flash", "none", "--stats", "s.json", code=4)
        self.host("builtin:cube", "--device", "seq", "--flash", "wide.grt", "--stats", "s.json",
                  code=2)

    def test_waves(self):
        self.host("builtin:cube", "--size", "4x3", "--device", "sim", "--trace", "w.fst")
        self.assertGreater(len(self.read("w.fst")), 10000)
        done = self.host("builtin:cube", "--device", "sim", "--trace", "none/w.fst", "--stats",
                         "s.json", code=4)
        self.assertIn("none/w.fst", done.stderr)

    def test_unknown_boards_and_schedules_are_refused(self):
        for words in (["--device", "sim:b99"], ["--device", "sim", "--schedule", "pes"]):
            self.host("builtin:cube", *words, "--stats", "s.json", code=2)
        self.assertEqual(self.entries(), [])


if __name__ == "__main__":
    main()
