"""Emits gridrt_protocol_pkg.sv: the same contract for RTL, with the board's (compact) widths.

Packed structs list the last field first, so that bit i of the vector is bit i of the
little-endian byte stream.
"""

import re

from model import Enum, Protocol, Record, SourceError, Struct, Table, snake

# Keywords of IEEE 1800-2017 that could be field names; such a field gets a trailing underscore.
SV_KEYWORDS = frozenset(
    "accept_on alias always and assert assign assume automatic before begin bind bins bit break "
    "buf byte case cell chandle checker class clocking config const constraint context continue "
    "cover cross deassign default defparam design disable dist do edge else end endcase enum event "
    "expect export extends extern final first_match for force foreach forever fork function "
    "generate genvar global highz0 highz1 if iff ifnone illegal_bins implements implies import "
    "include initial inout input inside instance int integer interconnect interface intersect join "
    "large let liblist library local localparam logic longint macromodule matches medium modport "
    "module nand negedge nettype new nexttime nor not null or output package packed parameter "
    "posedge primitive priority program property protected pull0 pull1 pulldown pullup pure rand "
    "randc randcase randsequence real realtime ref reg reject_on release repeat restrict return "
    "scalared sequence shortint shortreal showcancelled signed small soft solve specify specparam "
    "static string strong struct super supply0 supply1 table tagged task this throughout time "
    "timeprecision timeunit tran tri type typedef union unique unsigned until untyped use uwire "
    "var vectored virtual void wait wand weak while wildcard wire with within wor xnor xor".split())

HEADER = """\
// Constants, enums, structs, records and reports of the GridRT protocol.
// Generated from hal/protocol/protocol.toml by hal/protocol/generate.py; change it there.
// Records whose widths an image names have the widths of the compact layout here. Bit i of a
// packed struct is bit i of the little-endian byte stream.
package gridrt_protocol_pkg;

  // A design uses the constants that it needs.
  /* verilator lint_off UNUSEDPARAM */

"""
FOOTER = "\n  /* verilator lint_on UNUSEDPARAM */\nendpackage\n"


def field_name(name: str) -> str:
    return name + "_" if name in SV_KEYWORDS else name


def parameter(name: str, value: int, doc: str = "") -> str:
    comment = f"  // {doc}" if doc else ""
    return f"  localparam int unsigned {name} = 32'd{value};{comment}\n"


def enum(e: Enum) -> str:
    prefix = snake(e.name).upper()
    out = f"  // {e.doc}\n  typedef enum logic [{e.width - 1}:0] {{\n"
    rows = []
    for i, v in enumerate(e.values):
        comma = "," if i + 1 < len(e.values) else ""
        rows.append(f"    {prefix}_{snake(v.name).upper()} = {e.width}'d{v.value}{comma}"
                    f"  // {v.doc}\n")
    return out + "".join(rows) + f"  }} {snake(e.name)}_e;\n\n"


def packed(name: str, doc: str, fields: list[tuple[str, int, int | None, str]],
           padding: int) -> str:
    """`fields`: name, bits of an element, elements or None, meaning; first field at bit 0."""
    out = f"  // {doc}\n  typedef struct packed {{\n"
    if padding > 0:
        out += f"    logic [{padding - 1}:0] padding;  // 0\n"
    for field, bits, count, meaning in reversed(fields):
        dimension = "" if count is None else f" [{count - 1}:0]"
        out += f"    logic{dimension} [{bits - 1}:0] {field_name(field)};  // {meaning}\n"
    return out + f"  }} {name}_t;\n\n"


def offsets(name: str, fields: list[tuple[str, int, int | None, str]]) -> str:
    """Offset and width of every field, for code that takes a stream apart."""
    out = ""
    at = 0
    for field, bits, count, _ in fields:
        out += parameter(f"{name}_{field}_BIT".upper(), at)
        out += parameter(f"{name}_{field}_WIDTH".upper(), bits)
        at += bits * (count or 1)
    return out


def byte_struct(s: Struct) -> str:
    name = snake(s.name)
    out = ""
    if s.report_id is not None:
        out += parameter(f"{name}_ID".upper(), s.report_id)
    out += parameter(f"{name}_BYTES".upper(), s.bytes)
    fields = [(f.name, 8 * f.element_bytes, f.count, f"byte {f.offset}: {f.doc}")
              for f in s.fields]
    return out + offsets(name, fields) + packed(name, s.doc, fields, 0)


def record(protocol: Protocol, r: Record) -> str:
    widths = protocol.layout("Compact").values
    name = snake(r.name)
    fields = [(f.name, widths[f.width] if isinstance(f.width, str) else f.width, f.count, f.doc)
              for f in r.fields]
    bits = sum(width * (count or 1) for _, width, count, _ in fields)
    stride = (bits + 7) // 8
    out = parameter(f"{name}_BITS".upper(), bits) + parameter(f"{name}_BYTES".upper(), stride)
    return out + offsets(name, fields) + packed(name, r.doc, fields, 8 * stride - bits)


def table(t: Table) -> str:
    """One vector: yosys reads no parameters that are arrays."""
    bits = t.width * len(t.values)
    value = sum(v << (t.width * i) for i, v in enumerate(t.values))
    return (f"  // {t.doc}\n  // Entry i is bits [{t.width}*i +: {t.width}].\n"
            f"  localparam logic [{bits - 1}:0] {t.name.upper()} = {bits}'h{value:x};\n\n")


def sv_package(protocol: Protocol) -> str:
    out = [HEADER]
    for c in protocol.constants:
        out.append(parameter(c.name.upper(), c.value, c.doc))
    out.append("\n")
    for key, value in protocol.layout("Compact").values.items():
        out.append(parameter(f"LAYOUT_COMPACT_{key}".upper(), value))
    out.append("\n")
    out += [enum(e) for e in protocol.enums]
    out += [byte_struct(s) for s in protocol.structs]
    out += [record(protocol, r) for r in protocol.records]
    out += [table(t) for t in protocol.tables]
    out += [byte_struct(r) for r in protocol.reports]
    for w in protocol.windows:
        name = f"REGISTERS_{snake(w.name).upper()}"
        out.append(parameter(f"{name}_BASE", w.base, f"byte address; {w.report.doc}"))
        out.append(parameter(f"{name}_WORDS", w.words))
    for p in protocol.peripherals:
        for r in p.registers:
            name = f"{snake(p.name)}_{r.name}".upper()
            out.append(parameter(f"{name}_ADDRESS", r.address, r.doc))
            for f in r.fields:
                out.append(parameter(f"{name}_{f.name}_BIT".upper(), f.bit, f.doc))
    package = "".join(out).rstrip("\n") + "\n" + FOOTER
    check_names(package)
    return package


def check_names(package: str) -> None:
    """All names of the package share one scope; two of the source may meet there."""
    names = re.findall(r"^ +localparam (?:int unsigned|logic \[\d+:0\]) (\w+)|^    ([A-Z]\w*) =|^  } (\w+);", package,
                       re.MULTILINE)
    seen = set()
    for name in ("".join(groups) for groups in names):
        if name in seen:
            raise SourceError(f"SystemVerilog would have two declarations of {name}")
        seen.add(name)
