"""The contract of every device, on `usb`, within the guest."""
import re
import unittest

from guest import Guest

SCRIPT = """
export GRIDRT_DEVICES=usb GRIDRT_CONTRACT_RAYS=100
contract --gtest_filter='Devices/*' --gtest_color=no
"""


class Contract(unittest.TestCase):
    def test_the_whole_contract_holds(self):
        with Guest(["contract"]) as guest:
            board = guest.start_board("--core", "seq")
            console, _ = guest.run(SCRIPT, [board], timeout=800)
        print(console)
        self.assertIn("guest: test ends with 0", console)
        ran = re.search(r"(\d+) tests? from 1 test suite ran", console)
        self.assertIsNotNone(ran)
        self.assertGreaterEqual(int(ran[1]), 17)
        self.assertRegex(console, rf"PASSED  \] {ran[1]} tests")
        self.assertNotIn("SKIPPED", console)


if __name__ == "__main__":
    unittest.main()
