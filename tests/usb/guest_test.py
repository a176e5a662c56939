"""gridrt-host on a board that a real kernel has enumerated: the same bytes as without it."""
import json
import pathlib
import subprocess
import tempfile
import unittest

from guest import BIN, Guest

SIZE = "64x48"
SCRIPT = f"""
ok() {{ "$@" || echo "FAILED: $*"; }}
for i in $(seq 50); do [ -e /dev/hidraw0 ] && break; sleep 0.1; done
ok gridrt-host --list-devices
ok gridrt-host /teapot.grt --size {SIZE} --device usb:virtual-1 --hits usb.npy -o usb.png --stats usb.json
ok gridrt-host /teapot.grt --size {SIZE} -o auto.png
gridrt-host /teapot.grt --size {SIZE} --device usb:other -o other.png; echo "code $?"
"""


class Renders(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        scratch = tempfile.TemporaryDirectory()
        cls.addClassCleanup(scratch.cleanup)
        cls.path = pathlib.Path(scratch.name)
        cls.program("gridrt-image", "builtin:teapot?tessellation=6", "--layout", "compact", "-o",
                    "teapot.grt")
        cls.program("gridrt-host", "teapot.grt", "--size", SIZE, "--device", "seq", "--hits",
                    "seq.npy", "-o", "seq.png")
        with Guest(["gridrt-host"], {"teapot.grt": cls.read("teapot.grt")}) as guest:
            board = guest.start_board("--core", "seq")
            cls.console, cls.files = guest.run(SCRIPT, [board], timeout=400)
        print(cls.console)

    @classmethod
    def program(cls, name, *words):
        subprocess.run([BIN / name, *words], cwd=cls.path, check=True, timeout=120)

    @classmethod
    def read(cls, name):
        return (cls.path / name).read_bytes()

    def test_every_step_works(self):
        self.assertNotIn("FAILED", self.console)
        self.assertIn("usb:virtual-1 at 1-1: ready", self.console)

    def test_hits_and_picture_are_the_bytes_of_seq(self):
        self.assertEqual(self.files["usb.npy"], self.read("seq.npy"))
        self.assertEqual(self.files["usb.png"], self.read("seq.png"))

    def test_rays_went_through_the_board(self):
        stats = json.loads(self.files["usb.json"])
        self.assertEqual((stats["device"], stats["layout"]), ("usb:virtual-1", "compact"))
        self.assertGreater(stats["bytes_out"], 16 * 1000)
        self.assertGreater(stats["steps"], 1000)
        self.assertEqual(stats["frames_retried"], 0)

    def test_auto_takes_the_board(self):
        self.assertIn("Device usb: a GridRT board is plugged in.", self.console)
        self.assertEqual(self.files["auto.png"], self.read("seq.png"))

    def test_another_serial_is_refused(self):
        self.assertIn("no GridRT board with serial 'other' is plugged in", self.console)
        self.assertIn("code 6", self.console)


if __name__ == "__main__":
    unittest.main()
