"""Schedules of faults between a real kernel and a board, in one boot of the guest: the right answers
after recovery, or one clear error in time. The truth is made outside."""
import os
import pathlib
import subprocess
import tempfile
import unittest

from guest import BIN, Guest

SCHEDULES = int(os.environ.get("GRIDRT_GUEST_SCHEDULES", "50"))
SCRIPT = f"""
for i in $(seq 50); do [ -e /dev/hidraw0 ] && break; sleep 0.1; done
guest_faults run / {SCHEDULES} 2>&1
"""


class Faults(unittest.TestCase):
    def test_every_schedule_is_fine(self):
        with tempfile.TemporaryDirectory() as folder:
            subprocess.run([BIN / "guest_faults", "truth", folder], check=True, timeout=120,
                           env=dict(os.environ, GRIDRT_CONTRACT_RAYS="200"))
            files = {path.name: path.read_bytes() for path in pathlib.Path(folder).iterdir()}
        with Guest(["guest_faults"], files) as guest:
            board = guest.start_board("faults", program="usb_test_board")
            console, _ = guest.run(SCRIPT, [board], timeout=800)
        print(console)
        self.assertIn("guest: test ends with 0", console)
        self.assertRegex(console, r"(?m)^schedules: \d+ right, \d+ with one error, 0 bad$")
        self.assertEqual(console.count("\nschedule "), SCHEDULES)


if __name__ == "__main__":
    unittest.main()
