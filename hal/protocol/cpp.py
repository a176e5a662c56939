"""Emits gridrt_protocol.hpp."""

from cpp_records import codec, fixed_record
from cpp_support import FOOTER, HEADER, SUPPORT
from model import ByteField, Enum, Layout, Protocol, Struct, Table, camel, snake

CPP_TYPES = {
    "u8": "std::uint8_t", "u16": "std::uint16_t", "u32": "std::uint32_t", "u64": "std::uint64_t",
    "i8": "std::int8_t", "i16": "std::int16_t", "i32": "std::int32_t", "i64": "std::int64_t",
    "f32": "float",
}


def constants(protocol: Protocol) -> str:
    lines = [f"inline constexpr std::uint32_t k{camel(c.name)} = {c.value:#x}U;  ///< {c.doc}"
             for c in protocol.constants]
    return "\n".join(lines) + "\n\n"


def enum(e: Enum) -> str:
    lines = [f"/// {e.doc}", f"enum class {e.name} : std::uint{e.width}_t {{"]
    lines += [f"  k{v.name} = {v.value},  ///< {v.doc}" for v in e.values]
    lines += ["};", "",
              f"/// The name in the source, or an empty text for an unknown value.",
              f"constexpr std::string_view name({e.name} value) {{",
              "  switch (value) {"]
    for v in e.values:
        lines += [f"    case {e.name}::k{v.name}:", f'      return "{v.name}";']
    lines += ["  }", "  return {};", "}", "",
              "/// True for a value that the source lists.",
              f"constexpr bool is_known({e.name} value) {{ return !name(value).empty(); }}", "", ""]
    return "\n".join(lines)


def member(f: ByteField) -> str:
    kind = CPP_TYPES[f.type]
    if f.count is not None:
        kind = f"std::array<{kind}, {f.count}>"
    return f"  {kind} {f.name}{{}};  ///< byte {f.offset}: {f.doc}"


def store_one(f: ByteField, value: str, offset: int) -> str:
    bits = 8 * f.element_bytes
    if f.type == "f32":
        value = f"__builtin_bit_cast(std::uint32_t, {value})"
    elif f.type[0] == "i":
        value = f"static_cast<std::uint{bits}_t>({value})"
    return f"  detail::put{bits}(out.data() + {offset}, {value});"


def load_one(f: ByteField, offset: int) -> str:
    bits = 8 * f.element_bytes
    value = f"detail::get{bits}(in.data() + {offset})"
    if f.type == "f32":
        return f"__builtin_bit_cast(float, {value})"
    if f.type[0] == "i":
        return f"static_cast<{CPP_TYPES[f.type]}>({value})"
    return value


def elements(f: ByteField):
    """(subscript, offset) of each element of the field."""
    if f.count is None:
        yield "", f.offset
        return
    for i in range(f.count):
        yield f"[{i}]", f.offset + i * f.element_bytes


def byte_struct(s: Struct) -> str:
    lines = [f"/// {s.doc}", f"struct {s.name} {{"]
    if s.report_id is not None:
        lines.append(f"  static constexpr std::uint8_t kId = {s.report_id};  ///< HID report id")
    lines.append(f"  static constexpr std::size_t kBytes = {s.bytes};")
    lines += [member(f) for f in s.fields]
    lines += [f"  friend bool operator==(const {s.name}&, const {s.name}&) = default;", "};", ""]
    lines.append(f"constexpr void store(const {s.name}& value, "
                 f"std::span<std::byte, {s.name}::kBytes> out) {{")
    for f in s.fields:
        lines += [store_one(f, f"value.{f.name}{sub}", at) for sub, at in elements(f)]
    lines += ["}", "",
              f"constexpr void load(std::span<const std::byte, {s.name}::kBytes> in, "
              f"{s.name}& value) {{"]
    for f in s.fields:
        lines += [f"  value.{f.name}{sub} = {load_one(f, at)};" for sub, at in elements(f)]
    lines += ["}", "",
              f"constexpr {s.name} load_{snake(s.name)}("
              f"std::span<const std::byte, {s.name}::kBytes> in) {{",
              f"  {s.name} value;", "  load(in, value);", "  return value;", "}", "", ""]
    return "\n".join(lines)


def layout_limits(layouts: tuple[Layout, ...]) -> str:
    keys = list(layouts[0].values)
    lines = ["/// Field widths (bits) and memory sizes (entries) of a layout.",
             "struct LayoutLimits {"]
    lines += [f"  std::uint32_t {key} = 0;" for key in keys]
    lines += ["  friend bool operator==(const LayoutLimits&, const LayoutLimits&) = default;",
              "};", ""]
    for layout in layouts:
        lines.append(f"inline constexpr LayoutLimits k{layout.name}Limits{{")
        lines += [f"    .{key} = {layout.values[key]}U," for key in keys]
        lines += ["};", ""]
    lines += ["/// The limits of a layout; all zero for kNone and unknown values.",
              "constexpr LayoutLimits layout_limits(Layout layout) {", "  switch (layout) {"]
    for layout in layouts:
        lines += [f"    case Layout::k{layout.name}:", f"      return k{layout.name}Limits;"]
    lines += ["    case Layout::kNone:", "      break;", "  }", "  return {};", "}", "", ""]
    return "\n".join(lines)


def table(t: Table) -> str:
    rows = [", ".join(f"{v:#x}" for v in t.values[i:i + 8]) for i in range(0, len(t.values), 8)]
    return (f"/// {t.doc}\ninline constexpr std::array<std::uint{t.width}_t, {len(t.values)}> "
            f"k{camel(t.name)}{{\n    " + ",\n    ".join(rows) + "};\n\n")


def windows(protocol: Protocol) -> str:
    lines = ["/// Registers of a board's shell that hold the body of a report: 32-bit words from a",
             "/// byte address on.",
             "struct RegisterWindow {", "  std::uint32_t base = 0;", "  std::uint32_t words = 0;",
             "  std::uint8_t report = 0;  ///< id", "  bool readable = false;",
             "  bool writable = false;", "};", ""]
    names = []
    for w in protocol.windows:
        flags = ", ".join("true" if flag else "false" for flag in (w.readable, w.writable))
        names.append(f"k{w.name}Window")
        lines.append(f"inline constexpr RegisterWindow {names[-1]}{{{w.base:#x}U, {w.words}U, "
                     f"{w.report.report_id}, {flags}}};")
    lines += [f"inline constexpr std::array<RegisterWindow, {len(names)}> kRegisterWindows{{"]
    lines += [f"    {name}," for name in names] + ["};", "", ""]
    return "\n".join(lines)


def cpp_header(protocol: Protocol) -> str:
    parts = [HEADER, constants(protocol)]
    parts += [enum(e) for e in protocol.enums]
    parts.append(SUPPORT)
    parts += [byte_struct(s) for s in protocol.structs]
    parts += [fixed_record(r) for r in protocol.records if r.bytes is not None]
    parts += [codec(r) for r in protocol.records if r.bytes is None]
    parts += [table(t) for t in protocol.tables]
    parts.append(layout_limits(protocol.layouts))
    parts += [byte_struct(r) for r in protocol.reports]
    parts.append(windows(protocol))
    return "".join(parts) + FOOTER
