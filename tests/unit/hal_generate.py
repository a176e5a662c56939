"""The protocol generator: same output each time, and a clear refusal of every mistake."""

import copy
import subprocess
import sys
import tempfile
import tomllib
import unittest
from pathlib import Path

PROTOCOL = Path(__file__).resolve().parents[2] / "hal" / "protocol"
sys.path.insert(0, str(PROTOCOL))

import source  # noqa: E402
import systemverilog  # noqa: E402
from model import SourceError  # noqa: E402

SOURCE = PROTOCOL / "protocol.toml"
NAMES = ("gridrt_protocol.hpp", "gridrt_firmware_protocol.hpp", "gridrt_protocol_pkg.sv", "protocol.md", "gridrt_usb.hpp",
         "gridrt_usb_pkg.sv", "gridrt_usb.py")


def run(toml: Path, folder: Path) -> subprocess.CompletedProcess:
    return subprocess.run([sys.executable, "-B", str(PROTOCOL / "generate.py"), str(toml),
                           str(folder)], capture_output=True, text=True, check=False)


class Output(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.path = Path(self.folder.name)

    def tearDown(self):
        self.folder.cleanup()

    def test_two_runs_give_the_same_bytes(self):
        for name in ("a", "b"):
            self.assertEqual(run(SOURCE, self.path / name).returncode, 0)
        for name in NAMES:
            first = (self.path / "a" / name).read_bytes()
            self.assertEqual(first, (self.path / "b" / name).read_bytes())
            self.assertGreater(len(first), 1000)
            self.assertNotIn(str(self.path).encode(), first)

    def test_a_mistake_names_file_and_place_and_writes_nothing(self):
        broken = self.path / "broken.toml"
        text = SOURCE.read_text(encoding="utf-8")
        broken.write_text(text.replace("size = 20", "size = 24", 1), encoding="utf-8")
        done = run(broken, self.path / "out")
        self.assertEqual(done.returncode, 1)
        self.assertIn("broken.toml: structs.FrameHeader: size is 24, but its fields take 20",
                      done.stderr)
        self.assertFalse((self.path / "out").exists())

    def test_text_that_is_no_toml(self):
        broken = self.path / "broken.toml"
        broken.write_text("[protocol\n", encoding="utf-8")
        done = run(broken, self.path / "out")
        self.assertEqual(done.returncode, 1)
        self.assertIn("broken.toml", done.stderr)

    def test_missing_file_and_arguments(self):
        self.assertEqual(run(self.path / "none.toml", self.path).returncode, 1)
        done = subprocess.run([sys.executable, "-B", str(PROTOCOL / "generate.py")],
                              capture_output=True, check=False)
        self.assertEqual(done.returncode, 2)

    def test_rtl_and_documentation_agree_with_the_source(self):
        self.assertEqual(run(SOURCE, self.path).returncode, 0)
        package = (self.path / "gridrt_protocol_pkg.sv").read_text(encoding="utf-8")
        for line in ("localparam int unsigned FRAME_MAGIC = 32'd826692167;",
                     "localparam int unsigned RAY_COMPACT_P1_BIT = 32'd51;",
                     "localparam int unsigned RAY_COMPACT_IGNORE_BIT = 32'd102;",
                     "localparam int unsigned IMAGE_HEADER_MARGIN_BIT = 32'd704;",
                     "localparam int unsigned VERTEX_RECORD_BITS = 32'd54;",
                     "FRAME_TYPE_TRACE = 8'd3",
                     "localparam int unsigned REGISTERS_COUNTERS_BASE = 32'd256;",
                     "localparam int unsigned REGISTERS_COUNTERS_WORDS = 32'd14;",
                     "} ray_compact_t;",
                     "logic [7:0] type_;"):
            self.assertIn(line, package)
        tables = (self.path / "protocol.md").read_text(encoding="utf-8")
        for line in ("| 88-91 | u32 | `margin` |", "| 51-101 | 3 x 17 | `p1` |",
                     "| from 26 | `base_bits` | `base` |", "### StatusReport (id 3)",
                     "| 0x100 | 14 | Counters | read |", "| 0x404 | `answer` | 1 | write |"):
            self.assertIn(line, tables)
        firmware = (self.path / "gridrt_firmware_protocol.hpp").read_text(encoding="utf-8")
        for line in ("inline constexpr uint32_t kAnswerTagBit = 0x18U;",
                     "inline constexpr uint32_t kErrorDetailAt = 0x4U;",
                     "    {0x100, 14, 4, true, false},  // Counters"):
            self.assertIn(line, firmware)


def mutated(change):
    with open(SOURCE, "rb") as file:
        tables = tomllib.load(file)
    tables = copy.deepcopy(tables)
    change(tables)
    return tables


def field(tables, group, name, index):
    return tables[group][name]["fields"][index]


MISTAKES = {
    "a table is missing": (lambda t: t.pop("layouts"), "'layouts' is missing"),
    "a table is unknown": (lambda t: t.update(extra={}), "unknown key 'extra'"),
    "a constant is too wide":
        (lambda t: t["protocol"]["max_payload"].update(value=2**32), "protocol.max_payload"),
    "a constant is no integer":
        (lambda t: t["protocol"]["version"].update(value="1"), "must be an integer"),
    "a constant has no text": (lambda t: t["protocol"]["version"].pop("doc"), "'doc' is missing"),
    "report_bytes is missing": (lambda t: t["protocol"].pop("report_bytes"), "report_bytes"),
    "an enum's width is odd":
        (lambda t: t["enums"]["Layout"].update(width=12), "must be 8, 16 or 32"),
    "an enum value appears twice":
        (lambda t: t["enums"]["Layout"]["values"][2].update(value=1), "value 1 appears twice"),
    "an enum name appears twice":
        (lambda t: t["enums"]["Layout"]["values"][2].update(name="None"), "name None appears"),
    "an enum value is too wide":
        (lambda t: t["enums"]["FrameType"]["values"][0].update(value=256), "outside [0, 255]"),
    "an enum name is not CamelCase":
        (lambda t: t["enums"]["Layout"]["values"][1].update(name="compact"), "not a CamelCase"),
    "an enum has no values": (lambda t: t["enums"]["Layout"].update(values=[]), "needs values"),
    "a byte type is unknown":
        (lambda t: field(t, "structs", "TraceHead", 0).update(type="u24"), "unknown type 'u24'"),
    "an array is empty":
        (lambda t: field(t, "structs", "ImageHeader", 10).update(type="f32[0]"), "outside [1"),
    "a field is not aligned":
        (lambda t: t["structs"]["ErrorBody"]["fields"].pop(0), "not aligned to its 4 bytes"),
    "a struct's size is wrong":
        (lambda t: t["structs"]["TraceHead"].update(size=12), "its fields take 8 bytes"),
    "a struct is no whole words":
        (lambda t: (t["structs"]["ErrorBody"].update(size=2),
                    t["structs"]["ErrorBody"]["fields"].pop(2),
                    t["structs"]["ErrorBody"]["fields"].pop(1)), "not a multiple of 4"),
    "a field appears twice":
        (lambda t: field(t, "structs", "TraceHead", 1).update(name="count"), "field count appears"),
    "two peripherals meet":
        (lambda t: t["peripherals"]["Feed"].update(base=0x400), "base 1024 appears twice"),
    "a peripheral is not aligned":
        (lambda t: t["peripherals"]["Feed"].update(base=0x4C4), "not a multiple of 64"),
    "a peripheral is too large":
        (lambda t: t["peripherals"]["MailboxBody"]["registers"].append(
            {"name": "more", "access": "read", "doc": "too much"}), "more than 64 bytes"),
    "a register's fields overlap":
        (lambda t: t["peripherals"]["Feed"]["registers"][0]["fields"][1].update(bit=0),
         "0 is outside [1, 31]"),
    "a register appears twice":
        (lambda t: t["peripherals"]["Feed"]["registers"][1].update(name="source"),
         "register source appears twice"),
    "a field is a keyword":
        (lambda t: field(t, "structs", "TraceHead", 1).update(name="union"), "keyword of C++"),
    "a field's name is not lower case":
        (lambda t: field(t, "structs", "TraceHead", 1).update(name="Tag"), "lower_case"),
    "a field's text breaks the line":
        (lambda t: field(t, "structs", "TraceHead", 1).update(doc="a\nb"), "no line break"),
    "a record's bits do not fill its bytes":
        (lambda t: field(t, "records", "RayCompact", 4).update(width=6), "take 129 bits"),
    "a record's bytes are no words":
        (lambda t: (t["records"]["HitCompact"].update(bytes=5),
                    field(t, "records", "HitCompact", 3).update(width=18)), "4 or a multiple of 8"),
    "a width is zero":
        (lambda t: field(t, "records", "HitWide", 3).update(width=0), "outside [1, 32]"),
    "a width is too large":
        (lambda t: field(t, "records", "HitWide", 0).update(width=33), "outside [1, 32]"),
    "a width is no header field":
        (lambda t: field(t, "records", "CellRecord", 0).update(width="bits_of"), "no u8 field"),
    "a width is a header field of another type":
        (lambda t: field(t, "records", "CellRecord", 0).update(width="margin"), "no u8 field"),
    "a fixed record has a header width":
        (lambda t: field(t, "records", "HitWide", 0).update(width="id_bits"),
         "every width must be a number"),
    "a free record has no header width":
        (lambda t: t["records"]["HitWide"].pop("bytes"), "must end in Record"),
    "a free record is too long":
        (lambda t: field(t, "records", "TriangleRecord", 0).update(count=4), "more than 128"),
    "a layout is missing": (lambda t: t["layouts"].pop("Wide"), "layouts: must be"),
    "a layout lacks a width":
        (lambda t: t["layouts"]["Wide"].pop("id_bits"), "'id_bits' is missing"),
    "a layout's width is too large":
        (lambda t: t["layouts"]["Wide"].update(id_bits=33), "outside [1, 32]"),
    "a memory is out of an index's reach":
        (lambda t: t["layouts"]["Compact"].update(max_triangles=4097), "out of reach"),
    "a report is too long":
        (lambda t: field(t, "reports", "Identity", 2).update(type="u8[64]"), "do not fit a report"),
    "a report id appears twice":
        (lambda t: t["reports"]["Status"].update(id=2), "id 2 appears twice"),
    "a report id is zero": (lambda t: t["reports"]["Status"].update(id=0), "outside [1, 255]"),
    "a window has no report":
        (lambda t: t["registers"].update(Extra={"base": 0, "access": "read"}), "no report of this"),
    "a window starts between places":
        (lambda t: t["registers"]["Status"].update(base=0x44), "is not a multiple of 64"),
    "two windows start at one place":
        (lambda t: t["registers"]["Status"].update(base=0x40), "base 64 appears twice"),
    "a window is no whole words":
        (lambda t: field(t, "reports", "Status", 4).update(type="u8[3]"), "not whole words of 4"),
    "a window's access is unknown":
        (lambda t: t["registers"]["Status"].update(access="never"), "must be one of: read"),
    "a type appears twice":
        (lambda t: t["structs"].update(RayWide=t["structs"]["TraceHead"]), "type RayWide appears"),
}


class Mistakes(unittest.TestCase):
    def test_the_source_itself_is_good(self):
        source.build(mutated(lambda t: None))

    def test_every_mistake_is_refused(self):
        for name, (change, message) in MISTAKES.items():
            with self.subTest(name):
                tables = mutated(change)
                with self.assertRaises(SourceError) as caught:
                    source.build(tables)
                self.assertIn(message, str(caught.exception))

    def test_names_that_meet_in_rtl_are_refused(self):
        protocol = source.build(mutated(lambda t: t["protocol"].update(
            layout_compact_id_bits={"value": 1, "doc": "meets a layout's width"})))
        with self.assertRaises(SourceError) as caught:
            systemverilog.sv_package(protocol)
        self.assertIn("two declarations of LAYOUT_COMPACT_ID_BITS", str(caught.exception))


if __name__ == "__main__":
    unittest.main()
