#include <array>
#include <cstdint>
#include <utility>

#include <fmt/format.h>

#include "host/scene/assemble.hpp"
#include "host/scene/ply_body.hpp"
#include "host/scene/ply_header.hpp"
#include "host/scene/readers.hpp"
#include "host/scene/text.hpp"

namespace gridrt::scene_detail {
namespace {

class PlyReader {
 public:
  PlyReader(std::string_view bytes, PlyHeader header, const std::string& name)
      : header_(std::move(header)), body_(bytes, header_, name), name_(name) {
    scene_.materials.emplace_back();
  }

  Result<Scene> read() {
    for (const PlyElement& element : header_.elements) {
      vertex_count_ = element.name == "vertex" ? element.count : vertex_count_;
    }
    for (const PlyElement& element : header_.elements) {
      const auto ok = element.name == "vertex" ? vertices(element)
                      : element.name == "face" ? faces(element)
                                               : others(element);
      if (!ok) {
        return std::unexpected(ok.error());
      }
    }
    if (body_.has_more()) {
      scene_.warnings.push_back(fmt::format("{}: data after the last element is left out", name_));
    }
    if (scene_.triangles.empty()) {
      scene_.warnings.push_back(fmt::format("{}: no faces", name_));
    }
    return finish();
  }

 private:
  std::unexpected<Error> bad(const std::string& what) const {
    return fail(ErrorKind::kInput, fmt::format("{}: {}", name_, what));
  }

  Result<void> vertices(const PlyElement& element) {
    constexpr std::array<const char*, 6> kNames = {"x", "y", "z", "nx", "ny", "nz"};
    if (element.count >= kNoIndex) {
      return fail(ErrorKind::kLimit, fmt::format("{}: too many vertices", name_));
    }
    std::vector<std::size_t> part_of(element.properties.size(), kNames.size());
    std::size_t found = 0;
    for (std::size_t part = 0; part < kNames.size(); ++part) {
      const auto at = element.find(kNames[part]);
      if (at && !element.properties[*at].count_type) {
        part_of[*at] = part;
        found |= 1U << part;
      }
    }
    if ((found & 7U) != 7U) {
      return bad("element 'vertex' has no properties x, y and z");
    }
    has_normals_ = (found >> 3U) == 7U;
    scene_.positions.reserve(element.count);
    for (std::uint64_t i = 0; i < element.count; ++i) {
      if (const auto ok = vertex(element, part_of, i); !ok) {
        return ok;
      }
    }
    return {};
  }

  Result<void> vertex(const PlyElement& element, const std::vector<std::size_t>& part_of,
                      std::uint64_t number) {
    std::array<float, 6> parts{};
    if (const auto ok = body_.begin(element, number); !ok) {
      return ok;
    }
    for (std::size_t p = 0; p < element.properties.size(); ++p) {
      if (part_of[p] == parts.size()) {
        if (const auto ok = body_.skip(element.properties[p]); !ok) {
          return ok;
        }
        continue;
      }
      const auto value = body_.next(element.properties[p].type);
      if (!value) {
        return std::unexpected(value.error());
      }
      const auto real = body_.real(*value);
      if (!real) {
        return std::unexpected(real.error());
      }
      parts[part_of[p]] = *real;
    }
    scene_.positions.emplace_back(parts[0], parts[1], parts[2]);
    if (has_normals_) {
      normal_at_.push_back(add_normal(scene_, glm::dvec3(parts[3], parts[4], parts[5])));
    }
    return body_.end();
  }

  Result<void> faces(const PlyElement& element) {
    auto list = element.find("vertex_indices");
    list = list ? list : element.find("vertex_index");
    if (!list || !element.properties[*list].count_type ||
        !is_integer(element.properties[*list].type)) {
      return bad("element 'face' has no list of integers vertex_indices or vertex_index");
    }
    for (std::uint64_t i = 0; i < element.count; ++i) {
      if (const auto ok = body_.begin(element, i); !ok) {
        return ok;
      }
      for (std::size_t p = 0; p < element.properties.size(); ++p) {
        const auto ok = p == *list ? fan(element.properties[p]) : body_.skip(element.properties[p]);
        if (!ok) {
          return ok;
        }
      }
      if (const auto ok = body_.end(); !ok) {
        return ok;
      }
    }
    return {};
  }

  Result<void> fan(const PlyProperty& property) {
    const auto length = body_.list_length(property);
    if (!length) {
      return std::unexpected(length.error());
    }
    if (*length < 3) {
      return body_.bad(fmt::format("a face with {} corners", *length));
    }
    if (scene_.triangles.size() + *length - 2 > kMaxTriangles) {
      return fail(ErrorKind::kLimit,
                  fmt::format("{}: more than {} triangles", name_, kMaxTriangles));
    }
    std::uint32_t first = 0;
    std::uint32_t last = 0;
    for (std::uint64_t i = 0; i < *length; ++i) {
      const auto value = body_.next(property.type);
      if (!value) {
        return std::unexpected(value.error());
      }
      const auto index = body_.integer(*value);
      if (!index) {
        return std::unexpected(index.error());
      }
      if (static_cast<std::uint64_t>(*index) >= vertex_count_) {
        return body_.bad(fmt::format("vertex index {} of only {}", *index, vertex_count_));
      }
      const auto corner = static_cast<std::uint32_t>(*index);
      if (i == 0) {
        first = corner;
      } else if (i >= 2) {
        add_triangle(scene_, {first, last, corner});
      }
      last = corner;
    }
    return {};
  }

  Result<void> others(const PlyElement& element) {
    if (element.count > 0 && !element.properties.empty()) {
      scene_.warnings.push_back(
          fmt::format("{}: element '{}' is left out", name_, shorten(element.name)));
    }
    // Elements without properties take no bytes, however many are announced.
    const std::uint64_t count = element.properties.empty() ? 0 : element.count;
    for (std::uint64_t i = 0; i < count; ++i) {
      if (const auto ok = body_.begin(element, i); !ok) {
        return ok;
      }
      for (const PlyProperty& property : element.properties) {
        if (const auto ok = body_.skip(property); !ok) {
          return ok;
        }
      }
      if (const auto ok = body_.end(); !ok) {
        return ok;
      }
    }
    return {};
  }

  // Vertices may stand after the faces that use them, so normals are given at the end.
  Result<Scene> finish() {
    if (has_normals_) {
      scene_.triangle_normals.assign(scene_.triangles.size(), kFlat);
      for (std::size_t i = 0; i < scene_.triangles.size(); ++i) {
        Corners normals{};
        bool smooth = true;
        for (std::size_t k = 0; k < 3; ++k) {
          normals[k] = normal_at_[scene_.triangles[i][k]];
          smooth = smooth && normals[k] != kNoIndex;
        }
        scene_.triangle_normals[i] = smooth ? normals : kFlat;
      }
    }
    return std::move(scene_);
  }

  PlyHeader header_;
  PlyBody body_;
  const std::string& name_;
  Scene scene_;
  std::uint64_t vertex_count_ = 0;
  bool has_normals_ = false;
  std::vector<std::uint32_t> normal_at_;
};

}  // namespace

Result<Scene> read_ply(std::string_view bytes, const std::string& name) {
  auto header = read_ply_header(bytes, name);
  if (!header) {
    return std::unexpected(header.error());
  }
  return PlyReader(bytes, std::move(*header), name).read();
}

}  // namespace gridrt::scene_detail
