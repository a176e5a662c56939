#include "host/scene/ply_header.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include <fmt/format.h>

#include "host/scene/number.hpp"
#include "host/scene/text.hpp"

namespace gridrt::scene_detail {
namespace {

std::optional<PlyType> type_of(std::string_view word) {
  constexpr std::array<std::pair<const char*, PlyType>, 16> kTypes = {{
      {"char", PlyType::kInt8},
      {"uchar", PlyType::kUint8},
      {"short", PlyType::kInt16},
      {"ushort", PlyType::kUint16},
      {"int", PlyType::kInt32},
      {"uint", PlyType::kUint32},
      {"float", PlyType::kFloat32},
      {"double", PlyType::kFloat64},
      {"int8", PlyType::kInt8},
      {"uint8", PlyType::kUint8},
      {"int16", PlyType::kInt16},
      {"uint16", PlyType::kUint16},
      {"int32", PlyType::kInt32},
      {"uint32", PlyType::kUint32},
      {"float32", PlyType::kFloat32},
      {"float64", PlyType::kFloat64},
  }};
  for (const auto& [known, type] : kTypes) {
    if (word == known) {
      return type;
    }
  }
  return std::nullopt;
}

class HeaderReader {
 public:
  HeaderReader(std::string_view bytes, const std::string& name)
      : bytes_(bytes), lines_(bytes), name_(name) {}

  Result<PlyHeader> read() {
    const auto magic = lines_.next();
    if (!magic || trim(*magic) != "ply") {
      return fail(ErrorKind::kInput, fmt::format("{}:1: not a PLY file", name_),
                  "its first line is 'ply'");
    }
    while (const auto line = lines_.next()) {
      if (trim(*line) == "end_header") {
        return finish();
      }
      if (const auto ok = statement(*line); !ok) {
        return std::unexpected(ok.error());
      }
    }
    return bad("the file ends within its header");
  }

 private:
  std::unexpected<Error> bad(const std::string& what) const {
    return fail(ErrorKind::kInput, fmt::format("{}:{}: {}", name_, lines_.number(), what));
  }

  Result<void> statement(std::string_view line) {
    const std::string_view keyword = next_token(line);
    if (keyword.empty() || keyword == "comment" || keyword == "obj_info") {
      return {};
    }
    if (keyword == "format") {
      return format(line);
    }
    if (keyword == "element") {
      return element(line);
    }
    if (keyword == "property") {
      return property(line);
    }
    return bad(fmt::format("unknown statement '{}' in the header", shorten(keyword)));
  }

  Result<void> format(std::string_view line) {
    const std::string_view encoding = next_token(line);
    if (has_format_) {
      return bad("a second format statement");
    }
    if (encoding == "ascii") {
      header_.encoding = PlyEncoding::kAscii;
    } else if (encoding == "binary_little_endian") {
      header_.encoding = PlyEncoding::kLittleEndian;
    } else if (encoding == "binary_big_endian") {
      header_.encoding = PlyEncoding::kBigEndian;
    } else {
      return bad(fmt::format("unknown format '{}'", shorten(encoding)));
    }
    if (next_token(line) != "1.0") {
      return bad("the version of the format is not 1.0");
    }
    has_format_ = true;
    return {};
  }

  Result<void> element(std::string_view line) {
    const std::string_view word = next_token(line);
    const auto count = parse_integer(next_token(line));
    if (word.empty() || !count || *count < 0) {
      return bad("an element needs a name and a count");
    }
    for (const PlyElement& other : header_.elements) {
      if (other.name == word) {
        return bad(fmt::format("a second element '{}'", shorten(word)));
      }
    }
    header_.elements.push_back({std::string(word), static_cast<std::uint64_t>(*count), {}});
    return {};
  }

  Result<void> property(std::string_view line) {
    if (header_.elements.empty()) {
      return bad("a property before any element");
    }
    PlyProperty property;
    std::string_view word = next_token(line);
    if (word == "list") {
      property.count_type = type_of(next_token(line));
      if (!property.count_type || !is_integer(*property.count_type)) {
        return bad("the count of a list has no integer type");
      }
      word = next_token(line);
    }
    const auto type = type_of(word);
    if (!type) {
      return bad(fmt::format("unknown type '{}'", shorten(word)));
    }
    property.type = *type;
    property.name = std::string(next_token(line));
    PlyElement& element = header_.elements.back();
    if (property.name.empty() || element.find(property.name)) {
      return bad(fmt::format("a property without a name of its own in element '{}'",
                             shorten(element.name)));
    }
    element.properties.push_back(std::move(property));
    return {};
  }

  Result<PlyHeader> finish() {
    if (!has_format_) {
      return bad("the header has no format statement");
    }
    header_.lines = lines_.number();
    header_.body_from = bytes_.size() - lines_.rest().size();
    // If the only LF of the header is its last byte, lines end in CR alone, and it is data.
    const std::string_view head = bytes_.substr(0, header_.body_from);
    if (head.ends_with("\r\n") && head.find('\n') == head.size() - 1) {
      --header_.body_from;
    }
    const std::uint64_t body = bytes_.size() - header_.body_from;
    // The last line of a text needs no end, which counts as a byte of its least size.
    const std::uint64_t room = body + (header_.encoding == PlyEncoding::kAscii ? 1 : 0);
    std::uint64_t needed = 0;
    for (const PlyElement& element : header_.elements) {
      const std::uint64_t least = element.least_bytes(header_.encoding);
      const std::uint64_t left = room - std::min(needed, room);
      if (least > 0 && element.count > left / least) {
        return fail(ErrorKind::kInput,
                    fmt::format("{}: {} elements '{}' of at least {} bytes are announced, but only "
                                "{} bytes follow the header",
                                name_, element.count, shorten(element.name), least, body),
                    "the file may be truncated");
      }
      needed += least * element.count;
    }
    return std::move(header_);
  }

  std::string_view bytes_;
  LineReader lines_;
  const std::string& name_;
  PlyHeader header_;
  bool has_format_ = false;
};

}  // namespace

std::size_t size_of(PlyType type) {
  switch (type) {
    case PlyType::kInt8:
    case PlyType::kUint8:
      return 1;
    case PlyType::kInt16:
    case PlyType::kUint16:
      return 2;
    case PlyType::kInt32:
    case PlyType::kUint32:
    case PlyType::kFloat32:
      return 4;
    case PlyType::kFloat64:
      break;
  }
  return 8;
}

bool is_integer(PlyType type) { return type != PlyType::kFloat32 && type != PlyType::kFloat64; }

std::optional<std::size_t> PlyElement::find(std::string_view property) const {
  for (std::size_t i = 0; i < properties.size(); ++i) {
    if (properties[i].name == property) {
      return i;
    }
  }
  return std::nullopt;
}

std::uint64_t PlyElement::least_bytes(PlyEncoding encoding) const {
  std::uint64_t bytes = 0;
  for (const PlyProperty& property : properties) {
    // A digit and a blank, or the value; an empty list has its count only.
    bytes +=
        encoding == PlyEncoding::kAscii ? 2 : size_of(property.count_type.value_or(property.type));
  }
  return bytes;
}

Result<PlyHeader> read_ply_header(std::string_view bytes, const std::string& name) {
  return HeaderReader(bytes, name).read();
}

}  // namespace gridrt::scene_detail
