#!/usr/bin/env python3
"""What cancelling and feedback are for: engines without them, beside the whole one."""
import pathlib
import subprocess
import sys
import unittest

PROGRAMS = [pathlib.Path(p) for p in sys.argv[1:4]]  # whole, without cancel, without feedback


def measure(program):
    done = subprocess.run([str(program)], capture_output=True, text=True, check=False)
    if done.returncode:
        raise AssertionError(f"{program}: {done.stdout}{done.stderr}")
    words = done.stdout.split()
    return {words[i]: int(words[i + 1]) for i in range(0, len(words), 2)}


class Ablation(unittest.TestCase):
    def test_without_cancel_half_as_many_tests_more_and_the_same_answers(self):
        whole, without = measure(PROGRAMS[0]), measure(PROGRAMS[1])
        self.assertGreaterEqual(whole["triangles"], 10000)
        self.assertEqual(whole["wrong"], 0)
        self.assertEqual(without["wrong"], 0)
        self.assertGreaterEqual(without["tests"], 1.5 * whole["tests"])

    def test_without_feedback_answers_change(self):
        self.assertGreater(measure(PROGRAMS[2])["wrong"], 0)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
