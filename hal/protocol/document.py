"""Emits protocol.md: byte and bit tables for people."""

from model import Protocol, Record, Struct

INTRODUCTION = """\
# GridRT protocol

Generated from `hal/protocol/protocol.toml`; change it there. All integers are little endian.
Bit 0 is the least significant bit of byte 0; bit 8 that of byte 1.

"""


def table(head: list[str], rows: list[list[object]]) -> str:
    lines = [" | ".join(head), " | ".join("---" for _ in head)]
    lines += [" | ".join(str(cell) for cell in row) for row in rows]
    return "\n".join(f"| {line} |" for line in lines) + "\n\n"


def byte_table(s: Struct, shift: int = 0) -> str:
    rows = []
    for f in s.fields:
        start = f.offset + shift
        last = start + f.bytes - 1
        kind = f.type if f.count is None else f"{f.type}[{f.count}]"
        rows.append([start if start == last else f"{start}-{last}", kind, f"`{f.name}`", f.doc])
    return table(["byte", "type", "field", "meaning"], rows)


def bit_table(r: Record) -> str:
    rows = []
    at: int | None = 0
    for f in r.fields:
        fixed = isinstance(f.width, int)
        width = f.width if fixed else f"`{f.width}`"
        if f.count is not None:
            width = f"{f.count} x {width}"
        place = "next"
        if at is not None and fixed:
            end = at + f.width * f.elements
            place = str(at) if end == at + 1 else f"{at}-{end - 1}"
            at = end
        else:
            place = f"from {at}" if at is not None else "next"
            at = None
        rows.append([place, width, f"`{f.name}`", f.doc])
    return table(["bit", "width", "field", "meaning"], rows)


def record_size(protocol: Protocol, r: Record) -> str:
    if r.bytes is not None:
        return f"{r.bytes} bytes."
    parts = []
    for layout in protocol.layouts:
        bits = sum((layout.values[f.width] if isinstance(f.width, str) else f.width) * f.elements
                   for f in r.fields)
        parts.append(f"{layout.name} {bits} bits in {(bits + 7) // 8} bytes")
    return "; ".join(parts) + "."


def document(protocol: Protocol) -> str:
    out = [INTRODUCTION, "## Constants\n\n"]
    out.append(table(["name", "value", "meaning"],
                     [[f"`{c.name}`", f"{c.value} ({c.value:#x})", c.doc]
                      for c in protocol.constants]))
    out.append("## Enumerations\n\n")
    for e in protocol.enums:
        out.append(f"### {e.name}\n\n{e.doc} {e.width} bits.\n\n")
        out.append(table(["value", "name", "meaning"],
                         [[v.value, f"`{v.name}`", v.doc] for v in e.values]))
    out.append("## Structs\n\n")
    for s in protocol.structs:
        out.append(f"### {s.name}\n\n{s.doc} {s.bytes} bytes.\n\n{byte_table(s)}")
    out.append("## Bit records\n\nFields are packed from bit 0 up and padded with zeros to whole "
               "bytes. A width in code type is a field of `ImageHeader`.\n\n")
    for r in protocol.records:
        out.append(f"### {r.name}\n\n{r.doc} {record_size(protocol, r)}\n\n{bit_table(r)}")
    out.append("## Tables\n\n")
    for t in protocol.tables:
        out.append(f"### {t.name}\n\n{t.doc} {t.width} bits each.\n\n")
        out.append(table(["index", "values from there on"],
                         [[i, ", ".join(f"{v:#x}" for v in t.values[i:i + 8])]
                          for i in range(0, len(t.values), 8)]))
    out.append("## Layouts\n\n")
    keys = list(protocol.layouts[0].values)
    out.append(table(["", *[layout.name for layout in protocol.layouts]],
                     [[f"`{key}`", *[layout.values[key] for layout in protocol.layouts]]
                      for key in keys]))
    out.append("## HID reports\n\nByte 0 is the report id; bytes after the body are 0.\n\n")
    for r in protocol.reports:
        out.append(f"### {r.name} (id {r.report_id})\n\n{r.doc}\n\n{byte_table(r, 1)}")
    out.append("## Registers\n\nOf a board's shell: 32-bit words at byte addresses. A window holds the "
               "body of the report\nof its name. Reading the low word of a 64-bit value keeps the "
               "high word for the next read.\n\n")
    access = {(True, False): "read", (False, True): "write", (True, True): "read and write"}
    out.append(table(["address", "words", "window", "access"],
                     [[f"{w.base:#05x}", w.words, w.name, access[w.readable, w.writable]]
                      for w in protocol.windows]))
    out.append("## Other registers of the soft core\n\n")
    for p in protocol.peripherals:
        out.append(f"### {p.name}\n\n{p.doc}\n\n")
        rows = []
        for r in p.registers:
            rows.append([f"{r.address:#05x}", f"`{r.name}`", r.words,
                         access[r.readable, r.writable], r.doc])
            rows += [["", f"`{r.name}.{f.name}`",
                      f"bit {f.bit}" if f.width == 1 else f"bits {f.bit}-{f.bit + f.width - 1}",
                      "", f.doc] for f in r.fields]
        out.append(table(["address", "register", "words", "access", "meaning"], rows))
    return "".join(out).rstrip("\n") + "\n"
