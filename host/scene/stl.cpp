#include <algorithm>
#include <array>
#include <bit>
#include <cctype>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>

#include <fmt/format.h>

#include "host/scene/assemble.hpp"
#include "host/scene/number.hpp"
#include "host/scene/readers.hpp"
#include "host/scene/text.hpp"

namespace gridrt::scene_detail {
namespace {

constexpr std::size_t kHeaderBytes = 84;  // 80 of text, 4 of the number of triangles
constexpr std::size_t kTriangleBytes = 50;
constexpr std::uint64_t kMaxStlTriangles = kMaxTriangles / 3;  // vertices are not shared

std::string lower(std::string_view word) {
  std::string text(word);
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

std::uint32_t word_at(std::string_view bytes, std::size_t offset) {
  std::uint32_t word = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    word |= static_cast<std::uint32_t>(static_cast<unsigned char>(bytes[offset + i])) << (8 * i);
  }
  return word;
}

std::uint64_t announced(std::string_view bytes) { return word_at(bytes, kHeaderBytes - 4); }

// Binary files may begin with "solid" too. A length that fits the count settles it; else text is
// what begins with "solid" and holds no byte that text does not.
bool is_text(std::string_view bytes) {
  if (bytes.size() >= kHeaderBytes &&
      bytes.size() == kHeaderBytes + kTriangleBytes * announced(bytes)) {
    return false;
  }
  constexpr std::size_t kLookedAt = 4096;
  const std::string_view head = bytes.substr(0, kLookedAt);
  const bool printable = std::all_of(head.begin(), head.end(), [](unsigned char c) {
    return c >= ' ' || (c >= '\t' && c <= '\r');
  });
  std::string_view rest = head.substr(std::min(head.find_first_not_of(" \t\r\n"), head.size()));
  return printable && lower(rest.substr(0, 5)) == "solid";
}

Result<Scene> read_binary(std::string_view bytes, const std::string& name) {
  if (bytes.size() < kHeaderBytes) {
    return fail(ErrorKind::kInput,
                fmt::format("{}: not an STL file: {} bytes, neither text that begins with 'solid' "
                            "nor a binary header of {} bytes",
                            name, bytes.size(), kHeaderBytes));
  }
  const std::uint64_t count = announced(bytes);
  const std::uint64_t held = (bytes.size() - kHeaderBytes) / kTriangleBytes;
  if (count > held) {
    return fail(ErrorKind::kInput,
                fmt::format("{}: {} triangles are announced, but only {} follow the header", name,
                            count, held),
                "the file may be truncated, or is not an STL file");
  }
  if (count > kMaxStlTriangles) {
    return fail(ErrorKind::kLimit, fmt::format("{}: {} triangles; at most {} are read from STL",
                                               name, count, kMaxStlTriangles));
  }
  Scene scene;
  scene.materials.emplace_back();
  scene.positions.reserve(3 * count);
  scene.triangles.reserve(count);
  scene.triangle_materials.reserve(count);
  for (std::uint64_t i = 0; i < count; ++i) {
    const std::size_t from = kHeaderBytes + kTriangleBytes * i;
    std::array<float, 12> parts{};  // normal, then three vertices
    for (std::size_t p = 0; p < parts.size(); ++p) {
      parts[p] = std::bit_cast<float>(word_at(bytes, from + 4 * p));
      if (!std::isfinite(parts[p])) {
        return fail(ErrorKind::kInput, fmt::format("{}: triangle {} (byte {}): a {} is not finite",
                                                   name, i, from, p < 3 ? "normal" : "vertex"));
      }
    }
    const auto first = static_cast<std::uint32_t>(scene.positions.size());
    for (std::size_t k = 1; k <= 3; ++k) {
      scene.positions.emplace_back(parts[3 * k], parts[3 * k + 1], parts[3 * k + 2]);
    }
    add_triangle(scene, {first, first + 1, first + 2});
  }
  if (bytes.size() != kHeaderBytes + kTriangleBytes * count) {
    scene.warnings.push_back(fmt::format("{}: data after the last triangle is left out", name));
  }
  return scene;
}

class TextReader {
 public:
  TextReader(std::string_view text, const std::string& name) : lines_(text), name_(name) {
    scene_.materials.emplace_back();
  }

  Result<Scene> read() {
    bool within_solid = false;
    for (std::string word = next(); !word.empty(); word = next()) {
      if (word == "solid" && !within_solid) {
        within_solid = true;
        line_ = {};  // the rest is a name
      } else if (word == "endsolid" && within_solid) {
        within_solid = false;
        line_ = {};
      } else if (word == "facet" && within_solid) {
        if (const auto ok = facet(); !ok) {
          return std::unexpected(ok.error());
        }
      } else {
        return bad(fmt::format("'{}' where {} is expected", shorten(word),
                               within_solid ? "facet or endsolid" : "solid"));
      }
    }
    if (within_solid) {
      return bad("the file ends before endsolid");
    }
    return std::move(scene_);
  }

 private:
  std::unexpected<Error> bad(const std::string& what) const {
    return fail(ErrorKind::kInput, fmt::format("{}:{}: {}", name_, lines_.number(), what));
  }

  // The next word of this or a later line as it stands; empty at the end.
  std::string_view next_word() {
    for (;;) {
      const std::string_view token = next_token(line_);
      if (!token.empty()) {
        return token;
      }
      const auto line = lines_.next();
      if (!line) {
        return {};
      }
      line_ = *line;
    }
  }

  std::string next() { return lower(next_word()); }

  Result<void> expect(const char* word) {
    const std::string found = next();
    if (found != word) {
      return found.empty() ? bad(fmt::format("the file ends where {} is expected", word))
                           : bad(fmt::format("'{}' where {} is expected", shorten(found), word));
    }
    return {};
  }

  Result<glm::vec3> vector() {
    glm::vec3 value(0.0F);
    for (int i = 0; i < 3; ++i) {
      const auto parsed = parse_float(next_word());
      if (!parsed) {
        return bad(parsed.error().message);
      }
      value[i] = *parsed;
    }
    return value;
  }

  Result<void> facet() {
    if (const auto ok = expect("normal"); !ok) {
      return ok;
    }
    // The plane of a facet follows from its vertices; its normal must only be one.
    if (const auto normal = vector(); !normal) {
      return std::unexpected(normal.error());
    }
    for (const char* word : {"outer", "loop"}) {
      if (const auto ok = expect(word); !ok) {
        return ok;
      }
    }
    if (scene_.triangles.size() >= kMaxStlTriangles) {
      return fail(ErrorKind::kLimit,
                  fmt::format("{}: more than {} triangles", name_, kMaxStlTriangles));
    }
    const auto first = static_cast<std::uint32_t>(scene_.positions.size());
    for (int k = 0; k < 3; ++k) {
      if (const auto ok = expect("vertex"); !ok) {
        return ok;
      }
      const auto position = vector();
      if (!position) {
        return std::unexpected(position.error());
      }
      scene_.positions.push_back(*position);
    }
    add_triangle(scene_, {first, first + 1, first + 2});
    if (const auto ok = expect("endloop"); !ok) {
      return ok;
    }
    return expect("endfacet");
  }

  LineReader lines_;
  const std::string& name_;
  std::string_view line_;
  Scene scene_;
};

}  // namespace

Result<Scene> read_stl(std::string_view bytes, const std::string& name) {
  auto scene = is_text(bytes) ? TextReader(bytes, name).read() : read_binary(bytes, name);
  if (scene && scene->triangles.empty()) {
    scene->warnings.push_back(fmt::format("{}: no facets", name));
  }
  return scene;
}

}  // namespace gridrt::scene_detail
