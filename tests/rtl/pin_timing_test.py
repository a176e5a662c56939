#!/usr/bin/env python3
"""When outputs change, from a small file of delays (rtl/board/pin_timing.py)."""
import pathlib
import re
import sys
import tempfile
import unittest

sys.dont_write_bytecode = True
sys.path.append(str(pathlib.Path(__file__).resolve().parents[2] / "rtl" / "board"))
import pin_timing  # pylint: disable=wrong-import-position

# q -> f -> out/I beside in/O -> f, and q -> out/T; a constant reaches f, too.
SDF = r"""(DELAYFILE
  (CELL
    (CELLTYPE "top")
    (INSTANCE )
    (DELAY
      (ABSOLUTE
        (INTERCONNECT q/Q f/A (900:1000:1100) (1000:1100:1200))
        (INTERCONNECT in\$tr_io/O f/B (300:300:300) (300:300:500))
        (INTERCONNECT zero/F f/C (9000:9000:9000) (9000:9000:9000))
        (INTERCONNECT f/F out\$tr_io/I (2000:2000:2000) (2000:2000:2000))
        (INTERCONNECT q/Q out\$tr_io/T (40:40:40) (40:40:40))
      )))
  (CELL
    (CELLTYPE "TRELLIS_COMB")
    (INSTANCE f)
    (DELAY
      (ABSOLUTE
        (IOPATH A F (100:100:100) (100:100:200))
        (IOPATH B F (100:100:100) (100:100:300))
        (IOPATH C F (100:100:100) (100:100:300))
      )))
  (CELL
    (CELLTYPE "TRELLIS_FF")
    (INSTANCE q)
    (DELAY
      (ABSOLUTE
        (IOPATH CLK Q (250:250:250) (250:250:300))
      ))))
"""


class PinTiming(unittest.TestCase):
    def test_the_slowest_ways_from_registers_and_from_other_pins(self):
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "delays.sdf"
            path.write_text(SDF, encoding="utf-8")
            found = pin_timing.outputs(path, re.compile(r"out\S*/[IT]"))
        self.assertEqual(sorted(found), [r"out\$tr_io/I", r"out\$tr_io/T"])
        data = found[r"out\$tr_io/I"]
        self.assertEqual(sorted(data), ["clock", r"in\$tr_io"])
        self.assertAlmostEqual(data["clock"], 0.3 + 1.2 + 0.2 + 2.0)
        self.assertAlmostEqual(data[r"in\$tr_io"], 0.5 + 0.3 + 2.0)
        self.assertAlmostEqual(found[r"out\$tr_io/T"]["clock"], 0.3 + 0.04)


if __name__ == "__main__":
    unittest.main()
