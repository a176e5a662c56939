"""tools/demo from any folder: a picture and statistics where it says, errors passed through."""
import json
import pathlib
import re
import subprocess
import tempfile
import unittest

DEMO = pathlib.Path(__file__).resolve().parents[2] / "tools" / "demo"
EXAMPLE = DEMO.parents[1] / "examples" / "scenes" / "table.toml"
TRIANGLE = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"


def run(folder, *arguments):
    return subprocess.run([DEMO, *arguments], cwd=folder, capture_output=True, text=True,
                          check=False)


class Demo(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.folder = pathlib.Path(scratch.name)

    def check_outputs(self, done, name):
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        picture = pathlib.Path(re.search(r"^Picture: +(.*)$", done.stdout, re.M)[1])
        statistics = pathlib.Path(re.search(r"^Statistics: +(.*)$", done.stdout, re.M)[1])
        self.assertEqual(picture.name, name + ".png")
        self.assertEqual(picture.read_bytes()[:8], b"\x89PNG\r\n\x1a\n")
        return json.loads(statistics.read_text(encoding="utf-8"))

    def test_renders_the_built_in_scene(self):
        done = run(self.folder)
        statistics = self.check_outputs(done, "demo")
        for kind in ("primary", "shadow", "mirror", "refraction"):
            self.assertGreater(statistics["rays"][kind], 0, kind)
        self.assertRegex(done.stdout, r"the same bytes on the simulated board.*\d clocks, \d")

    def test_renders_a_file_named_from_where_the_caller_stands(self):
        (self.folder / "one triangle.obj").write_text(TRIANGLE, encoding="utf-8")
        statistics = self.check_outputs(run(self.folder, "one triangle.obj"), "one_triangle")
        self.assertEqual(statistics["triangles"], 1)

    def test_renders_the_example_scene(self):
        statistics = self.check_outputs(run(EXAMPLE.parent, EXAMPLE.name), "table")
        for kind in ("primary", "shadow", "mirror", "refraction"):
            self.assertGreater(statistics["rays"][kind], 0, kind)

    def test_passes_errors_through(self):
        missing = run(self.folder, "missing.obj")
        self.assertEqual(missing.returncode, 4, missing.stderr)
        self.assertIn("missing.obj", missing.stderr)
        (self.folder / "bad.obj").write_text(TRIANGLE + "f 1 2 9\n", encoding="utf-8")
        bad = run(self.folder, "bad.obj")
        self.assertEqual(bad.returncode, 3, bad.stderr)
        self.assertRegex(bad.stderr, r"bad\.obj:5")
        self.assertEqual(run(self.folder, "builtin:nothing").returncode, 2)
        self.assertEqual(run(self.folder, "--nonsense").returncode, 2)
        self.assertEqual(run(self.folder, "a", "b").returncode, 2)


if __name__ == "__main__":
    unittest.main()
