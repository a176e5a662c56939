"""The USB device's descriptors as bytes (USB 2.0 chapter 9, HID 1.11, Microsoft OS 2.0)."""

import struct
import uuid
from dataclasses import dataclass

from model import Protocol, Usb

DEVICE, CONFIGURATION, STRING, INTERFACE, ENDPOINT, QUALIFIER, OTHER_SPEED = range(1, 8)
BOS, CAPABILITY, HID, HID_REPORT = 0x0F, 0x10, 0x21, 0x22
BULK, INTERRUPT = 2, 3
MICROSOFT_PLATFORM = uuid.UUID("d8dd60df-4589-4cc7-9cd2-659d9e648a9f")
WINDOWS_8_1 = 0x06030000


@dataclass(frozen=True)
class Descriptor:
    name: str
    data: bytes
    doc: str


def descriptor(kind: int, layout: str, *values: int) -> bytes:
    """bLength, bDescriptorType, then the values in little endian."""
    body = struct.pack("<" + layout, *values)
    return bytes([2 + len(body), kind]) + body


def device(usb: Usb) -> bytes:
    return descriptor(DEVICE, "HBBBBHHHBBBB", usb["usb_release"], 0, 0, 0, usb["control_packet"],
                      usb["vendor_id"], usb["product_id"], usb["device_release"],
                      usb["manufacturer_string"], usb["product_string"], usb["serial_string"], 1)


def qualifier(usb: Usb) -> bytes:
    return descriptor(QUALIFIER, "HBBBBBB", usb["usb_release"], 0, 0, 0, usb["control_packet"], 1, 0)


def item(tag: int, value: int) -> bytes:
    """A short item of a report descriptor; the tag's lowest two bits are the value's size."""
    return bytes([tag | 1, value]) if value < 256 else bytes([tag | 2]) + struct.pack("<H", value)


MAIN_ITEMS = {"input": 0x80, "output": 0x90, "feature": 0xB0}


def hid_report(protocol: Protocol) -> bytes:
    size = next(c.value for c in protocol.constants if c.name == "report_bytes") - 1
    out = item(0x04, 0xFF00) + item(0x08, 1) + item(0xA0, 1)  # vendor page, usage 1, application
    # The largest value, 255, takes two bytes: items are signed.
    out += item(0x14, 0) + bytes([0x26, 0xFF, 0x00]) + item(0x74, 8) + item(0x94, size)
    for report in sorted(protocol.reports, key=lambda r: r.report_id):
        out += item(0x84, report.report_id)
        for kind in report.report_kinds:
            out += item(0x08, report.report_id) + item(MAIN_ITEMS[kind], 0x02)
    return out + b"\xC0"


def interface(number: int, endpoints: int, kind: int, text: int) -> bytes:
    return descriptor(INTERFACE, "BBBBBBB", number, 0, endpoints, kind, 0, 0, text)


def endpoint(address: int, kind: int, packet: int, interval: int) -> bytes:
    return descriptor(ENDPOINT, "BBHB", address, kind, packet, interval)


def configuration(protocol: Protocol, speed: str, kind: int = CONFIGURATION) -> bytes:
    usb = protocol.usb
    packet = usb[f"bulk_packet_{speed}"]
    interval = usb[f"interrupt_interval_{speed}"]
    bulk = interface(usb["bulk_interface"], 2, 0xFF, usb["bulk_string"])
    bulk += endpoint(usb["bulk_out"], BULK, packet, 0) + endpoint(usb["bulk_in"], BULK, packet, 0)
    hid = interface(usb["hid_interface"], 2, 3, usb["hid_string"])
    hid += hid_class(protocol)
    for name in ("interrupt_in", "interrupt_out"):
        hid += endpoint(usb[name], INTERRUPT, usb["interrupt_packet"], interval)
    body = bulk + hid if usb["bulk_interface"] < usb["hid_interface"] else hid + bulk
    head = struct.pack("<BBHBBBBB", 9, kind, 9 + len(body), 2, usb["configuration"], 0, 0x80,
                       usb["max_power"])
    return head + body


def hid_class(protocol: Protocol) -> bytes:
    """The class descriptor that lies within the configuration."""
    return descriptor(HID, "HBBBH", 0x0111, 0, 1, HID_REPORT, len(hid_report(protocol)))


def microsoft(usb: Usb) -> bytes:
    """Binds WinUSB to the bulk interface; HID has a driver of its own."""
    compatible = struct.pack("<HH8s8s", 20, 3, b"WINUSB", b"")
    name = "DeviceInterfaceGUIDs\0".encode("utf-16-le")
    data = (usb.texts["interface_guid"] + "\0\0").encode("utf-16-le")
    registry = struct.pack("<HHHH", 10 + len(name) + len(data), 4, 7, len(name)) + name
    registry += struct.pack("<H", len(data)) + data
    function = struct.pack("<HHBBH", 8, 2, usb["bulk_interface"], 0,
                           8 + len(compatible) + len(registry)) + compatible + registry
    subset = struct.pack("<HHBBH", 8, 1, 0, 0, 8 + len(function)) + function
    return struct.pack("<HHIH", 10, 0, WINDOWS_8_1, 10 + len(subset)) + subset


def bos(usb: Usb) -> bytes:
    no_power_management = descriptor(CAPABILITY, "BI", 2, 0)
    platform = descriptor(CAPABILITY, "BB16sIHBB", 5, 0, MICROSOFT_PLATFORM.bytes_le, WINDOWS_8_1,
                          len(microsoft(usb)), usb["microsoft_request"], 0)
    body = no_power_management + platform
    return struct.pack("<BBHB", 5, BOS, 5 + len(body), 2) + body


def string(text: str) -> bytes:
    data = text.encode("utf-16-le")
    return bytes([2 + len(data), STRING]) + data


def descriptors(protocol: Protocol) -> tuple[Descriptor, ...]:
    usb = protocol.usb
    return (
        Descriptor("device", device(usb), "GET_DESCRIPTOR type 1"),
        Descriptor("configuration_high", configuration(protocol, "high"),
                   "type 2 at high speed, with its interfaces and endpoints"),
        Descriptor("configuration_full", configuration(protocol, "full"), "type 2 at full speed"),
        Descriptor("qualifier", qualifier(usb), "type 6"),
        Descriptor("other_speed_high", configuration(protocol, "high", OTHER_SPEED),
                   "type 7 at full speed"),
        Descriptor("other_speed_full", configuration(protocol, "full", OTHER_SPEED),
                   "type 7 at high speed"),
        Descriptor("hid", hid_class(protocol), "type 0x21, of the HID interface"),
        Descriptor("hid_report", hid_report(protocol), "type 0x22, of the HID interface"),
        Descriptor("bos", bos(usb), "type 15"),
        Descriptor("microsoft", microsoft(usb),
                   "vendor request microsoft_request with wIndex 7, from the device"),
        Descriptor("languages", bytes([4, STRING, 0x09, 0x04]), "type 3, index 0: English"),
        Descriptor("manufacturer", string(usb.texts["manufacturer"]), "type 3"),
        Descriptor("product", string(usb.texts["product"]), "type 3"),
        Descriptor("bulk_name", string(usb.texts["bulk"]), "type 3, of the bulk interface"),
        Descriptor("hid_name", string(usb.texts["hid"]), "type 3, of the HID interface"),
    )
