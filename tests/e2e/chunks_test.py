"""A device that holds less than a scene: chunks, and the layout that it speaks."""
import unittest

from programs import ProgramTest, main

LARGE = "builtin:teapot?tessellation=20"  # 25,440 triangles; the board holds 16,384
SMALL = ("--size", "160x120")


class BoardsLimits(ProgramTest):
    def test_a_large_scene_gives_the_same_hits_and_the_same_picture(self):
        for device in ("seq", "seq-board"):
            self.host(LARGE, *SMALL, "--device", device, "-o", device + ".png", "--hits",
                      device + ".npy", "--stats", device + ".json")
        self.assertEqual(self.read("seq.npy"), self.read("seq-board.npy"))
        self.assertEqual(self.read("seq.png"), self.read("seq-board.png"))
        whole, cut = (self.statistics(name + ".json") for name in ("seq", "seq-board"))
        self.assertEqual((whole["layout"], whole["chunks"], whole["uploads"]), ("wide", 1, 1))
        self.assertEqual(cut["layout"], "compact")
        self.assertGreater(cut["chunks"], 1)
        self.assertGreaterEqual(cut["uploads"], cut["chunks"])
        self.assertEqual(whole["rays"], cut["rays"])
        self.assertGreater(cut["seconds"]["upload"], 0)
        self.assertGreater(cut["seconds"]["trace"], 0)

    def test_a_picture_of_the_default_size_loads_each_chunk_once(self):
        self.host(LARGE, "--device", "seq-board", "--hits", "a.npy", "--stats", "a.json")
        stats = self.statistics("a.json")
        self.assertLessEqual(stats["uploads"], stats["chunks"])

    def test_a_scene_that_fits_is_one_image(self):
        self.host("builtin:teapot", *SMALL, "--device", "seq-board", "--stats", "a.json")
        stats = self.statistics("a.json")
        self.assertEqual((stats["layout"], stats["chunks"], stats["uploads"]), ("compact", 1, 1))

    def test_explain_tells_each_chunk(self):
        done = self.host(LARGE, *SMALL, "--device", "seq-board", "--explain", "80,60")
        self.assertIn("chunk 2 of ", done.stdout)

    def test_an_image_of_the_wrong_layout_is_refused(self):
        self.image("builtin:cube", "-o", "wide.grt")
        done = self.host("wide.grt", "--device", "seq-board", "--stats", "a.json", code=5)
        self.assertIn("wide layout", done.stderr)
        self.assertIn("--layout compact", done.stderr)
        self.image("builtin:cube", "-o", "compact.grt", "--layout", "compact")
        self.host("compact.grt", "--device", "seq-board", "--stats", "a.json")
        self.assertEqual(self.statistics("a.json")["layout"], "compact")

    def test_what_the_board_cannot_do_is_refused_with_advice(self):
        for words, advice in ((["--bits", "20"], "--bits"), (["--pes", "8"], "--pes"),
                              (["--layout", "wide"], "--layout compact"),
                              (["--grid", "90x90x90"], "--grid")):
            done = self.host(LARGE, "--device", "seq-board", "--stats", "a.json", *words, code=5)
            self.assertIn(advice, done.stderr)
        self.assertEqual(self.entries(), [])


if __name__ == "__main__":
    main()
