"""Emits the USB device's numbers and descriptors: C++, SystemVerilog, Python, documentation."""

from document import table
from model import Protocol, camel
from usb import descriptors

NOTE = "Generated from hal/protocol/protocol.toml by hal/protocol/generate.py; change it there."


def rows_of(data: bytes, indent: str) -> str:
    return "".join(indent + " ".join(f"0x{b:02x}," for b in data[i:i + 16]) + "\n"
                   for i in range(0, len(data), 16))


def usb_header(protocol: Protocol) -> str:
    """Needs no more than <stdint.h>, so that freestanding firmware can include it."""
    out = ["// Numbers and descriptors of the GridRT USB device.\n", f"// {NOTE}\n",
           "#pragma once\n\n#include <stdint.h>\n\nnamespace gridrt::usb {\n\n"]
    for n in protocol.usb.numbers:
        out.append(f"inline constexpr uint16_t k{camel(n.name)} = {n.value:#x};  ///< {n.doc}\n")
    out.append(f"\n/// Interface of the bulk pipes in Windows' registry.\n"
               f'inline constexpr char kInterfaceGuid[] = "{protocol.usb.texts["interface_guid"]}";\n')
    for d in descriptors(protocol):
        out.append(f"\n/// {d.doc}\n"
                   f"inline constexpr uint8_t k{camel(d.name)}Descriptor[{len(d.data)}] = {{\n"
                   f"{rows_of(d.data, '    ')}}};\n")
    return "".join(out) + "\n}  // namespace gridrt::usb\n"


def usb_package(protocol: Protocol) -> str:
    out = ["// Numbers of the GridRT USB device.\n", f"// {NOTE}\n", "package gridrt_usb_pkg;\n\n",
           "  // A design uses the constants that it needs.\n",
           "  /* verilator lint_off UNUSEDPARAM */\n\n"]
    for n in protocol.usb.numbers:
        out.append(f"  localparam int unsigned USB_{n.name.upper()} = 32'd{n.value};  // {n.doc}\n")
    return "".join(out) + "\n  /* verilator lint_on UNUSEDPARAM */\nendpackage\n"


def usb_module(protocol: Protocol) -> str:
    out = [f'"""Numbers and descriptors of the GridRT USB device.\n\n{NOTE}\n"""\n\n']
    for n in protocol.usb.numbers:
        out.append(f"{n.name.upper()} = {n.value:#x}  # {n.doc}\n")
    for name, value in protocol.usb.texts.items():
        out.append(f"{name.upper()}_TEXT = {value!r}\n")
    for d in descriptors(protocol):
        out.append(f"\n# {d.doc}\n{d.name.upper()}_DESCRIPTOR = bytes([\n"
                   f"{rows_of(d.data, '    ')}])\n")
    return "".join(out)


def udev_rule(protocol: Protocol) -> str:
    """Lets whoever sits at the computer use the board (systemd's uaccess, which needs a number
    below 73)."""
    ids = [f'ATTR{{s}}{{{name}}}=="{protocol.usb[key]:04x}"'
           for name, key in (("idVendor", "vendor_id"), ("idProduct", "product_id"))]
    node, parent = (", ".join(i.replace("{s}", s) for i in ids) for s in ("", "S"))
    return (f"# The GridRT board: its bulk pipes, and its reports.\n# {NOTE}\n"
            f'SUBSYSTEM=="usb", ENV{{DEVTYPE}}=="usb_device", {node}, TAG+="uaccess"\n'
            f'SUBSYSTEM=="hidraw", KERNEL=="hidraw*", {parent}, TAG+="uaccess"\n')


def usb_document(protocol: Protocol) -> str:
    numbers = [[f"`{n.name}`", f"{n.value:#x}", n.doc] for n in protocol.usb.numbers]
    kinds = [[r.report_id, r.name, ", ".join(r.report_kinds)] for r in protocol.reports]
    sizes = [[f"`{d.name}`", len(d.data), d.doc] for d in descriptors(protocol)]
    return ("\n## USB\n\n" + table(["name", "value", "meaning"], numbers) +
            "How each report travels:\n\n" + table(["id", "report", "kinds"], kinds) +
            "Descriptors:\n\n" + table(["name", "bytes", "where it is asked for"], sizes)
            ).rstrip("\n") + "\n"
