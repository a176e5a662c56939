"""Emits gridrt_firmware_protocol.hpp: what firmware needs of the contract, without any library."""

from model import Enum, Peripheral, Protocol, Struct, camel

HEADER = """\
// What firmware needs of the GridRT protocol; needs no library but <stdint.h>.
// Generated from hal/protocol/protocol.toml by hal/protocol/generate.py; change it there.
#pragma once

#include <stdint.h>

namespace gridrt::wire {

"""
FOOTER = "}  // namespace gridrt::wire\n"


def value(name: str, number: int, doc: str = "", indent: str = "") -> str:
    comment = f"  ///< {doc}" if doc else ""
    return f"{indent}inline constexpr uint32_t k{camel(name)} = {number:#x}U;{comment}\n"


def enum(e: Enum) -> str:
    rows = "".join(f"  k{v.name} = {v.value},  ///< {v.doc}\n" for v in e.values)
    return f"/// {e.doc}\nenum class {e.name} : uint{e.width}_t {{\n{rows}}};\n\n"


def byte_struct(s: Struct) -> str:
    """Offsets of the fields; for reports the id, too."""
    out = f"/// {s.doc}\nnamespace {s.name} {{\n"
    if s.report_id is not None:
        out += value("id", s.report_id, "report id")
    out += value("bytes", s.bytes)
    for f in s.fields:
        out += value(f"{f.name}_at", f.offset, f.doc)
    return out + f"}}  // namespace {s.name}\n\n"


def windows(protocol: Protocol) -> str:
    out = ("/// Words of the shell that hold the body of a report.\n"
           "struct Window {\n  uint16_t base;\n  uint8_t words;\n  uint8_t report;\n"
           "  bool readable;\n  bool writable;\n};\n"
           "inline constexpr Window kWindows[] = {\n")
    for w in protocol.windows:
        flags = ", ".join("true" if flag else "false" for flag in (w.readable, w.writable))
        out += f"    {{{w.base:#x}, {w.words}, {w.report.report_id}, {flags}}},  // {w.name}\n"
    out += "};\n"
    for w in protocol.windows:
        out += value(f"{w.name}_window", w.base)
    return out + "\n"


def peripheral(p: Peripheral) -> str:
    out = f"/// {p.doc}\nnamespace {p.name} {{\n"
    for r in p.registers:
        out += value(r.name, r.address, r.doc)
        for f in r.fields:
            out += value(f"{r.name}_{f.name}_bit", f.bit, f.doc)
            if f.width > 1:
                out += value(f"{r.name}_{f.name}_mask", (1 << f.width) - 1)
    return out + f"}}  // namespace {p.name}\n\n"


def firmware_header(protocol: Protocol) -> str:
    out = [HEADER]
    out += [value(c.name, c.value, c.doc) for c in protocol.constants]
    out.append("\n")
    out += [enum(e) for e in protocol.enums]
    out += [byte_struct(s) for s in (*protocol.structs, *protocol.reports)]
    out.append(windows(protocol))
    out.append("/// Registers of the soft core's neighbours: byte addresses, and bits within.\n"
               "namespace registers {\n\n")
    out += [peripheral(p) for p in protocol.peripherals]
    out.append("}  // namespace registers\n\n")
    return "".join(out) + FOOTER
