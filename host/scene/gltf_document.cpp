#include "host/scene/gltf_document.hpp"

#include <algorithm>
#include <optional>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "host/scene/refuse.hpp"
#include "host/scene/text.hpp"

namespace gridrt::scene_detail {
namespace {

std::uint32_t word_at(std::string_view bytes, std::size_t offset) {
  std::uint32_t word = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    word |= static_cast<std::uint32_t>(static_cast<unsigned char>(bytes[offset + i])) << (8 * i);
  }
  return word;
}

struct GlbParts {
  std::string_view json;
  std::optional<std::string_view> binary;
};

// GLB: a header of 12 bytes, then chunks of length, type and data; JSON first, BIN second.
GlbParts split_glb(std::string_view bytes, const std::string& file) {
  constexpr std::uint32_t kMagic = 0x46546C67;
  constexpr std::uint32_t kJson = 0x4E4F534A;
  constexpr std::uint32_t kBin = 0x004E4942;
  constexpr std::size_t kHeader = 12;
  constexpr std::size_t kChunkHeader = 8;
  if (bytes.size() < kHeader || word_at(bytes, 0) != kMagic) {
    refuse(ErrorKind::kInput,
           fmt::format("{}: not a GLB file: it does not begin with 'glTF'", file));
  }
  if (word_at(bytes, 4) != 2) {
    refuse(ErrorKind::kInput,
           fmt::format("{}: version {} of GLB, only 2 is read", file, word_at(bytes, 4)));
  }
  if (word_at(bytes, 8) > bytes.size()) {
    refuse(ErrorKind::kInput,
           fmt::format("{}: the header announces {} bytes, but the file has {}", file,
                       word_at(bytes, 8), bytes.size()),
           "the file may be truncated");
  }
  std::string_view rest = bytes.substr(0, word_at(bytes, 8));
  rest.remove_prefix(std::min(kHeader, rest.size()));
  GlbParts parts;
  for (std::size_t chunk = 0; rest.size() >= kChunkHeader; ++chunk) {
    const std::uint32_t length = word_at(rest, 0);
    const std::uint32_t type = word_at(rest, 4);
    rest.remove_prefix(kChunkHeader);
    if (length > rest.size()) {
      refuse(ErrorKind::kInput, fmt::format("{}: chunk {} announces {} bytes, but {} follow", file,
                                            chunk, length, rest.size()));
    }
    if (chunk == 0 && type != kJson) {
      refuse(ErrorKind::kInput, fmt::format("{}: the first chunk is not JSON", file));
    }
    if (chunk == 0) {
      parts.json = rest.substr(0, length);
    } else if (chunk == 1 && type == kBin) {
      parts.binary = rest.substr(0, length);
    }
    const std::size_t padded = std::min<std::size_t>((length + 3ULL) / 4 * 4, rest.size());
    rest.remove_prefix(padded);
  }
  if (parts.json.empty()) {
    refuse(ErrorKind::kInput, fmt::format("{}: no JSON chunk", file));
  }
  return parts;
}

int base64_value(char c) {
  constexpr std::string_view kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  const std::size_t at = kDigits.find(c);
  return at == std::string_view::npos ? -1 : static_cast<int>(at);
}

std::optional<std::string> decode_base64(std::string_view text) {
  while (text.ends_with('=')) {
    text.remove_suffix(1);
  }
  std::string bytes;
  bytes.reserve(text.size() / 4 * 3 + 3);
  std::uint32_t held = 0;
  int bits = 0;
  for (const char c : text) {
    const int value = base64_value(c);
    if (value < 0) {
      return std::nullopt;
    }
    held = (held << 6U | static_cast<std::uint32_t>(value)) & 0xFFFFU;
    bits += 6;
    if (bits >= 8) {
      bits -= 8;
      bytes += static_cast<char>(held >> static_cast<unsigned>(bits) & 0xFFU);
    }
  }
  return bytes;
}

// RFC 3986 percent-encoding; what is no valid escape stays as it is.
std::string decode_percent(const std::string& uri) {
  const auto hex = [](char c) {
    constexpr std::string_view kDigits = "0123456789abcdef";
    const std::size_t at = kDigits.find(static_cast<char>(c >= 'A' && c <= 'F' ? c + 32 : c));
    return at == std::string_view::npos ? -1 : static_cast<int>(at);
  };
  std::string text;
  for (std::size_t i = 0; i < uri.size(); ++i) {
    const bool escape = uri[i] == '%' && i + 2 < uri.size();
    const int high = escape ? hex(uri[i + 1]) : -1;
    const int low = escape ? hex(uri[i + 2]) : -1;
    if (high >= 0 && low >= 0) {
      text += static_cast<char>(high * 16 + low);
      i += 2;
    } else {
      text += uri[i];
    }
  }
  return text;
}

}  // namespace

GltfDocument::GltfDocument(std::string_view bytes, bool binary, const std::string& file,
                           const FileResolver& resolve)
    : file_(file), resolve_(resolve) {
  std::string_view text = bytes;
  if (binary) {
    const GlbParts parts = split_glb(bytes, file);
    text = parts.json;
    has_binary_chunk_ = parts.binary.has_value();
    binary_chunk_ = parts.binary.value_or(std::string_view{});
  }
  try {
    json_ = std::make_unique<nlohmann::json>(nlohmann::json::parse(text));
  } catch (const nlohmann::json::exception& error) {
    refuse(ErrorKind::kInput, fmt::format("{}: {}", file, error.what()));
  }
  const std::string version = root().at("asset").at("version").text();
  if (!version.starts_with("2.")) {
    root().at("asset").at("version").refuse_value(
        fmt::format("is {}, only 2 is read", shorten(version)));
  }
  buffers_.resize(count("buffers"));
}

GltfDocument::~GltfDocument() = default;

JsonNode GltfDocument::root() const { return {*json_, "", file_}; }

std::size_t GltfDocument::count(const char* list) const {
  const auto found = root().find(list);
  return found ? found->size() : 0;
}

JsonNode GltfDocument::element(const char* list, const JsonNode& reference) const {
  const std::size_t index = reference.index(count(list), list);
  return root().at(list)[index];
}

std::string GltfDocument::load_uri(const JsonNode& uri) const {
  const std::string text = uri.text();
  if (!text.starts_with("data:")) {
    auto bytes = resolve_(decode_percent(text));
    if (!bytes) {
      uri.refuse_value(fmt::format("cannot be read: {}", bytes.error().message));
    }
    return std::move(*bytes);
  }
  constexpr std::string_view kMark = ";base64,";
  const std::size_t comma = text.find(',');
  const std::size_t mark = text.find(kMark);
  if (mark == std::string::npos || mark + kMark.size() != comma + 1) {
    uri.refuse_value("is a data URI, but not in base64");
  }
  auto bytes = decode_base64(std::string_view(text).substr(comma + 1));
  if (!bytes) {
    uri.refuse_value("holds a character that is not of base64");
  }
  return std::move(*bytes);
}

std::string_view GltfDocument::buffer(std::size_t index) {
  Buffer& buffer = buffers_[index];
  if (buffer.loaded) {
    return buffer.bytes;
  }
  const JsonNode node = root().at("buffers")[index];
  const std::uint64_t length = node.at("byteLength").whole();
  if (const auto uri = node.find("uri")) {
    buffer.owned = load_uri(*uri);
    buffer.bytes = buffer.owned;
  } else if (index == 0 && has_binary_chunk_) {
    buffer.bytes = binary_chunk_;
  } else {
    node.refuse_value("has neither a URI nor a BIN chunk");
  }
  if (length > buffer.bytes.size()) {
    node.refuse_value(
        fmt::format("announces {} bytes, but {} are there", length, buffer.bytes.size()));
  }
  buffer.bytes = buffer.bytes.substr(0, length);
  buffer.loaded = true;
  return buffer.bytes;
}

std::string_view GltfDocument::view(const JsonNode& buffer_view) {
  const std::string_view bytes = buffer(buffer_view.at("buffer").index(buffers_.size(), "buffers"));
  const auto offset_node = buffer_view.find("byteOffset");
  const std::uint64_t offset = offset_node ? offset_node->whole() : 0;
  const std::uint64_t length = buffer_view.at("byteLength").whole();
  if (offset > bytes.size() || length > bytes.size() - offset) {
    buffer_view.refuse_value(
        fmt::format("ends at byte {} of a buffer of {} bytes", offset + length, bytes.size()));
  }
  return bytes.substr(offset, length);
}

}  // namespace gridrt::scene_detail
