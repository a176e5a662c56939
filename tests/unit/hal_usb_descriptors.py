"""The USB descriptors, read back by the rules of USB 2.0, HID 1.11 and Microsoft OS 2.0."""

import copy
import importlib.util
import struct
import subprocess
import sys
import tempfile
import tomllib
import unittest
from pathlib import Path

PROTOCOL = Path(__file__).resolve().parents[2] / "hal" / "protocol"
sys.path.insert(0, str(PROTOCOL))

import source  # noqa: E402
from model import SourceError  # noqa: E402

with open(PROTOCOL / "protocol.toml", "rb") as file:
    TABLES = tomllib.load(file)


def generated():
    """The Python module that LUNA's side reads, with the udev rule as RULE."""
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([sys.executable, "-B", str(PROTOCOL / "generate.py"),
                        str(PROTOCOL / "protocol.toml"), folder], check=True)
        spec = importlib.util.spec_from_file_location("gridrt_usb", Path(folder) / "gridrt_usb.py")
        module = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(module)
        module.RULE = (Path(folder) / "70-gridrt.rules").read_text(encoding="utf-8")
        return module


USB = generated()


def split(data: bytes):
    """Descriptors one after the other."""
    while data:
        assert 2 <= data[0] <= len(data), data
        yield data[:data[0]]
        data = data[data[0]:]


class Descriptors(unittest.TestCase):
    def test_device(self):
        fields = struct.unpack("<BBHBBBBHHHBBBB", USB.DEVICE_DESCRIPTOR)
        self.assertEqual(fields, (18, 1, 0x0201, 0, 0, 0, 64, 0x1209, 1, 0x0100, 1, 2, 3, 1))

    def test_configurations(self):
        for data, kind, packet, interval in ((USB.CONFIGURATION_HIGH_DESCRIPTOR, 2, 512, 4),
                                             (USB.CONFIGURATION_FULL_DESCRIPTOR, 2, 64, 1),
                                             (USB.OTHER_SPEED_HIGH_DESCRIPTOR, 7, 512, 4),
                                             (USB.OTHER_SPEED_FULL_DESCRIPTOR, 7, 64, 1)):
            parts = list(split(data))
            self.assertEqual([p[1] for p in parts], [kind, 4, 5, 5, 4, 0x21, 5, 5])
            self.assertEqual(struct.unpack_from("<H", parts[0], 2)[0], len(data))
            self.assertEqual(parts[0][4], 2)
            self.assertEqual((parts[1][2], parts[1][5], parts[4][2], parts[4][5]), (0, 0xFF, 1, 3))
            ends = [struct.unpack("<BBHB", p[2:]) for p in parts if p[1] == 5]
            self.assertEqual(ends, [(0x01, 2, packet, 0), (0x81, 2, packet, 0),
                                    (0x82, 3, 64, interval), (0x02, 3, 64, interval)])
            self.assertEqual(parts[5], USB.HID_DESCRIPTOR)
        self.assertEqual(struct.unpack_from("<H", USB.HID_DESCRIPTOR, 7)[0],
                         len(USB.HID_REPORT_DESCRIPTOR))

    def test_every_report_is_in_the_report_descriptor(self):
        """Walks the items, keeping size, count and id, and collects what each main item sends."""
        data, state, found = USB.HID_REPORT_DESCRIPTOR, {}, set()
        at = depth = 0
        while at < len(data):
            size = (0, 1, 2, 4)[data[at] & 3]
            tag, value = data[at] & 0xFC, int.from_bytes(data[at + 1:at + 1 + size], "little")
            at += 1 + size
            state[tag] = value
            depth += {0xA0: 1, 0xC0: -1}.get(tag, 0)
            if tag in (0x80, 0x90, 0xB0):
                self.assertEqual((state[0x74], state[0x94], value), (8, 63, 2))
                self.assertEqual((state[0x14], state[0x24]), (0, 255))
                found.add((state[0x84], {0x80: "input", 0x90: "output", 0xB0: "feature"}[tag]))
        self.assertEqual(depth, 0)
        wanted = {(r["id"], kind) for r in TABLES["reports"].values()
                  for kind in r.get("kinds", ["feature"])}
        self.assertEqual(found, wanted)

    def test_bos_names_the_microsoft_descriptors(self):
        head = struct.unpack_from("<BBHB", USB.BOS_DESCRIPTOR)
        parts = list(split(USB.BOS_DESCRIPTOR[5:]))
        self.assertEqual(head, (5, 15, len(USB.BOS_DESCRIPTOR), len(parts)))
        self.assertEqual(parts[0], bytes([7, 16, 2, 0, 0, 0, 0]))
        self.assertEqual(parts[1][2:20].hex(), "0500df60ddd88945c74c9cd2659d9e648a9f")
        self.assertEqual(struct.unpack("<IHBB", parts[1][20:]),
                         (0x06030000, len(USB.MICROSOFT_DESCRIPTOR), USB.MICROSOFT_REQUEST, 0))

    def test_microsoft_set_nests_and_binds_winusb(self):
        data = USB.MICROSOFT_DESCRIPTOR
        self.assertEqual(struct.unpack_from("<HHIH", data), (10, 0, 0x06030000, len(data)))
        self.assertEqual(struct.unpack_from("<HHBBH", data, 10), (8, 1, 0, 0, len(data) - 10))
        self.assertEqual(struct.unpack_from("<HHBBH", data, 18), (8, 2, 0, 0, len(data) - 18))
        self.assertEqual(data[26:46], struct.pack("<HH", 20, 3) + b"WINUSB" + bytes(10))
        length, kind, multi, name = struct.unpack_from("<HHHH", data, 46)
        self.assertEqual((46 + length, kind, multi), (len(data), 4, 7))
        self.assertEqual(data[54:54 + name].decode("utf-16-le"), "DeviceInterfaceGUIDs\0")
        value = data[54 + name + 2:]
        self.assertEqual(len(value), struct.unpack_from("<H", data, 54 + name)[0])
        self.assertEqual(value.decode("utf-16-le"), USB.INTERFACE_GUID_TEXT + "\0\0")

    def test_the_udev_rule_names_the_device(self):
        lines = [line for line in USB.RULE.splitlines() if not line.startswith("#")]
        self.assertEqual(lines, [
            'SUBSYSTEM=="usb", ENV{DEVTYPE}=="usb_device", ATTR{idVendor}=="1209", '
            'ATTR{idProduct}=="0001", TAG+="uaccess"',
            'SUBSYSTEM=="hidraw", KERNEL=="hidraw*", ATTRS{idVendor}=="1209", '
            'ATTRS{idProduct}=="0001", TAG+="uaccess"'])

    def test_strings(self):
        self.assertEqual(USB.PRODUCT_DESCRIPTOR[:2], bytes([len(USB.PRODUCT_DESCRIPTOR), 3]))
        self.assertEqual(USB.PRODUCT_DESCRIPTOR[2:].decode("utf-16-le"), USB.PRODUCT_TEXT)


def number(name, value):
    return lambda t: t["usb"]["numbers"][name].update(value=value)


MISTAKES = {
    "an IN endpoint has an OUT address": (number("bulk_in", 0x01), "outside [129, 143]"),
    "two endpoints share an address": (number("interrupt_in", 0x81), "endpoint 129 appears twice"),
    "two interfaces share a number": (number("hid_interface", 0), "interface 0 appears twice"),
    "two strings share an index": (number("hid_string", 4), "string index 4 appears twice"),
    "reports do not fit the packet": (number("interrupt_packet", 32), "must be report_bytes"),
    "a packet is too large": (number("bulk_packet_high", 1024), "outside [1, 512]"),
    "a number is missing": (lambda t: t["usb"]["numbers"].pop("bulk_in"), "'bulk_in' is missing"),
    "a text is not ASCII": (lambda t: t["usb"]["texts"].update(product="B\u00f6ard"), "ASCII"),
    "a report's kind is unknown":
        (lambda t: t["reports"]["Status"].update(kinds=["input", "both"]), "not 'both'"),
    "a report's kind appears twice":
        (lambda t: t["reports"]["Status"].update(kinds=["input", "input"]), "appears twice"),
    "a report has no kind": (lambda t: t["reports"]["Status"].update(kinds=[]), "not empty"),
}


class Mistakes(unittest.TestCase):
    def test_every_mistake_is_refused(self):
        for name, (change, message) in MISTAKES.items():
            with self.subTest(name):
                tables = copy.deepcopy(TABLES)
                change(tables)
                with self.assertRaises(SourceError) as caught:
                    source.build(tables)
                self.assertIn(message, str(caught.exception))


if __name__ == "__main__":
    unittest.main()
