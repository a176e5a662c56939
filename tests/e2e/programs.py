"""What the command-line tests share: running the programs in a folder of their own."""
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

BIN = pathlib.Path(os.environ.get("GRIDRT_BIN", "build/bin")).resolve()
ROOT = pathlib.Path(__file__).resolve().parents[2]

# Two triangles of a quad at z = 0 and a degenerate one.
QUAD_OBJ = """v -1 -1 0
v 1 -1 0
v 1 1 0
v -1 1 0
f 1 2 3 4
f 1 1 2
"""


# What gridrt-host says where nobody has chosen the device.
CHOICE = re.compile(r"\ADevice \w+: .*\.\n")


class ProgramTest(unittest.TestCase):
    """A test case with an empty folder, in which the programs run."""

    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="gridrt-e2e-"))
        self.addCleanup(shutil.rmtree, self.folder)

    def run_program(self, name, *words, **options):
        """The finished process; standard output and error are text unless `text` says otherwise."""
        options.setdefault("text", True)
        options.setdefault("timeout", 240)
        return subprocess.run([BIN / name, *map(str, words)], cwd=self.folder, check=False,
                              capture_output=True, **options)

    def host(self, *words, code=0, **options):
        """Runs gridrt-host, expects the exit code and, on success, no words on standard error
        besides the choice of a device."""
        done = self.run_program("gridrt-host", *words, **options)
        if options.get("text", True):
            done.stderr = CHOICE.sub("", done.stderr)
        self.assertEqual(done.returncode, code, done.stderr)
        if code == 0:
            self.assertEqual(done.stderr, "")
        else:
            self.assertTrue(done.stderr.startswith("gridrt-host: "), done.stderr)
        return done

    def image(self, *words, code=0, **options):
        """The same for gridrt-image."""
        done = self.run_program("gridrt-image", *words, **options)
        self.assertEqual(done.returncode, code, done.stderr)
        if code:
            self.assertTrue(done.stderr.startswith("gridrt-image: "), done.stderr)
        return done

    def write(self, name, content):
        path = self.folder / name
        if isinstance(content, bytes):
            path.write_bytes(content)
        else:
            path.write_text(content, encoding="utf-8")
        return path

    def read(self, name):
        return (self.folder / name).read_bytes()

    def statistics(self, name):
        return json.loads(self.read(name))

    def entries(self):
        return sorted(path.name for path in self.folder.iterdir())


def main():
    """Runs the tests of the calling script."""
    if not (BIN / "gridrt-host").exists():
        sys.exit(f"no programs in {BIN}; set GRIDRT_BIN")
    unittest.main()
