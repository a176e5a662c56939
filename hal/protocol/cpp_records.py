"""Emits the bit records of gridrt_protocol.hpp."""

from model import BitField, Record, snake


def member(f: BitField) -> str:
    kind = "bool" if f.width == 1 else "std::uint32_t"
    if f.count is not None:
        kind = f"std::array<{kind}, {f.count}>"
    width = f"{f.width} bits" if isinstance(f.width, str) or f.width > 1 else "1 bit"
    if isinstance(f.width, str):
        width = f"ImageHeader::{f.width} wide"
    return f"  {kind} {f.name}{{}};  ///< {width}: {f.doc}"


def record_struct(r: Record, size: int | None) -> list[str]:
    lines = [f"/// {r.doc}", f"struct {r.name} {{"]
    if size is not None:
        lines.append(f"  static constexpr std::size_t kBytes = {size};")
    lines += [member(f) for f in r.fields]
    return lines + [f"  friend bool operator==(const {r.name}&, const {r.name}&) = default;",
                    "};", ""]


def subscripts(f: BitField):
    return [""] if f.count is None else [f"[{i}]" for i in range(f.count)]


def fits_terms(r: Record, width) -> list[str]:
    """Conditions that every value fits; 1-bit fields and full 32-bit ones always do."""
    return [f"detail::fits(value.{f.name}{sub}, {width(f)})"
            for f in r.fields if f.width not in (1, 32) for sub in subscripts(f)]


def fixed_record(r: Record) -> str:
    """pack and unpack through whole words: shifts and masks known at compile time."""
    word_bits = 32 if r.bytes == 4 else 64
    words: list[list[str]] = [[] for _ in range(8 * r.bytes // word_bits)]
    loads = []
    at = 0
    for f in r.fields:
        for sub in subscripts(f):
            word, shift = divmod(at, word_bits)
            value = f"value.{f.name}{sub}"
            bits = (f"std::uint64_t{{{value}}}" if f.width in (1, 32)
                    else f"detail::low({value}, {f.width})")
            words[word].append(bits if shift == 0 else f"{bits} << {shift}U")
            load = f"w{word}" if shift == 0 else f"w{word} >> {shift}U"
            if shift + f.width > word_bits:
                words[word + 1].append(f"{bits} >> {word_bits - shift}U")
                load = f"{load} | w{word + 1} << {word_bits - shift}U"
            if f.width == 1:
                loads.append(f"  value.{f.name}{sub} = (({load}) & 1U) != 0;")
            else:
                loads.append(f"  value.{f.name}{sub} = static_cast<std::uint32_t>("
                             f"detail::low({load}, {f.width}));")
            at += f.width
    lines = record_struct(r, r.bytes)
    fits = fits_terms(r, lambda f: f.width)
    argument = f"const {r.name}& value" if fits else f"const {r.name}& /*value*/"
    lines += ["/// True if every value fits its field.",
              f"constexpr bool fits({argument}) {{",
              f"  return {' && '.join(fits) if fits else 'true'};", "}", "",
              "/// Values that do not fit are cut to their field; see fits().",
              f"constexpr void pack(const {r.name}& value, "
              f"std::span<std::byte, {r.name}::kBytes> out) {{"]
    for i, terms in enumerate(words):
        lines.append(f"  const std::uint64_t w{i} = {' | '.join(terms)};")
    for i in range(len(words)):
        value = f"w{i}" if word_bits == 64 else f"static_cast<std::uint32_t>(w{i} & 0xFFFFFFFFU)"
        lines.append(f"  detail::put{word_bits}(out.data() + {i * word_bits // 8}, {value});")
    lines += ["}", "",
              f"constexpr {r.name} unpack_{snake(r.name)}("
              f"std::span<const std::byte, {r.name}::kBytes> in) {{"]
    for i in range(len(words)):
        lines.append(f"  const std::uint64_t w{i} = "
                     f"detail::get{word_bits}(in.data() + {i * word_bits // 8});")
    lines += [f"  {r.name} value;"] + loads + ["  return value;", "}", "", ""]
    return "\n".join(lines)


def codec(r: Record) -> str:
    """A class that packs and unpacks with the widths of an ImageHeader."""
    name = r.name.removesuffix("Record") + "Codec"
    names = r.width_names

    def width(f: BitField) -> str:
        return f"{f.width}_" if isinstance(f.width, str) else f"{f.width}U"

    def in_byte_order(act) -> list[str]:
        return [act(f, sub) for f in r.fields for sub in subscripts(f)]

    total = " + ".join(f"{width(f)}" if f.count is None else f"{f.count}U * {width(f)}"
                       for f in r.fields)
    valid = " && ".join(f"detail::is_width(header.{n})" for n in names)
    init = "".join(f"        {n}_(detail::width_or_limit(header.{n})),\n" for n in names)
    fits = [f"detail::fits(value.{f.name}{sub}, {width(f)})"
            for f in r.fields for sub in subscripts(f)]
    lines = record_struct(r, None)
    lines += [f"/// Packs and unpacks {r.name} with the widths of an image header.",
              f"class {name} {{", " public:",
              f"  constexpr explicit {name}(const ImageHeader& header)",
              f"      : valid_({valid}),", init.rstrip(",\n") + " {}", "",
              "  /// False if a width in the header is not in [1, 32]: the image is broken.",
              "  [[nodiscard]] constexpr bool valid() const { return valid_; }", "",
              "  /// Bits of a record.",
              f"  [[nodiscard]] constexpr std::size_t bits() const {{ return {total}; }}", "",
              "  /// Bytes from one record to the next.",
              "  [[nodiscard]] constexpr std::size_t stride() const { return (bits() + 7U) / 8U; }",
              "", "  /// True if every value fits its field.",
              f"  [[nodiscard]] constexpr bool fits(const {r.name}& value) const {{",
              f"    return {' && '.join(fits)};", "  }", "",
              "  /// Writes stride() bytes, padding zero. False, with nothing written, if a value",
              "  /// does not fit its field or `out` is too short.",
              f"  [[nodiscard]] constexpr bool pack(const {r.name}& value, "
              "std::span<std::byte> out) const {",
              "    if (!fits(value) || out.size() < stride()) {", "      return false;", "    }",
              "    for (std::size_t i = 0; i < stride(); ++i) {", "      out[i] = std::byte{0};",
              "    }", "    unsigned at = 0;"]
    lines += in_byte_order(lambda f, sub: f"    at = detail::add_bits(out.data(), at, {width(f)}, "
                                          f"value.{f.name}{sub});")
    lines += ["    return at == bits();", "  }", "",
              "  /// Reads stride() bytes; `in` must hold as many.",
              f"  [[nodiscard]] constexpr {r.name} unpack(std::span<const std::byte> in) const {{",
              f"    {r.name} value;", "    unsigned at = 0;"]
    steps = in_byte_order(lambda f, sub: f"    value.{f.name}{sub} = "
                                         f"detail::bits_at(in.data(), at, {width(f)});"
                                         f"\n    at += {width(f)};")
    steps[-1] = steps[-1].split("\n")[0]
    lines += steps
    lines += ["    return value;", "  }", "",
              "  /// The record at an index of a section; the section must hold it.",
              f"  [[nodiscard]] constexpr {r.name} at(std::span<const std::byte> section, "
              "std::size_t index) const {",
              "    return unpack(section.subspan(index * stride(), stride()));", "  }", "",
              " private:", "  bool valid_;"]
    lines += [f"  unsigned {n}_;" for n in names]
    lines += ["};", "", ""]
    return "\n".join(lines)
