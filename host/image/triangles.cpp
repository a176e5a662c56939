#include "host/image/triangles.hpp"

#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "host/image/scene_section.hpp"

namespace gridrt {
namespace {

using protocol::SectionKind;

/// No section bounds this number of the header, so something else has to.
constexpr std::uint32_t kMostDegenerate = 1U << 24;

std::unexpected<Error> bad(SectionKind kind, int pe, std::string_view message) {
  return fail(ErrorKind::kInput, fmt::format("{}: {}", section_name(kind, pe), message));
}

Result<std::vector<glm::ivec3>> decode_vertices(const Image& image, int pe) {
  const protocol::VertexCodec codec(image.header);
  if (!codec.valid()) return bad(SectionKind::kVertices, pe, "a width in the header is not valid");
  const auto section = find_records(image, SectionKind::kVertices, pe, codec.stride());
  if (!section) return std::unexpected(section.error());
  std::vector<glm::ivec3> vertices((*section)->bytes.size() / codec.stride());
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    const protocol::VertexRecord record = codec.at((*section)->bytes, i);
    for (int a = 0; a < 3; ++a) {
      const auto j = static_cast<std::size_t>(a);
      const auto most = std::int64_t{image.header.max_q[j]};
      if (record.q[j] < 2 || record.q[j] > most) {
        return bad(
            SectionKind::kVertices, pe,
            fmt::format("vertex {}: coordinate {} is outside [2, {}]", i, record.q[j], most));
      }
      vertices[i][a] = static_cast<std::int32_t>(record.q[j]);
    }
  }
  return vertices;
}

}  // namespace

std::string section_name(SectionKind kind, int pe) {
  const bool owned = kind == SectionKind::kReferences || kind == SectionKind::kTriangles ||
                     kind == SectionKind::kVertices;
  return owned ? fmt::format("section {} of PE {}", protocol::name(kind), pe)
               : fmt::format("section {}", protocol::name(kind));
}

Result<const ImageSection*> find_records(const Image& image, SectionKind kind, int pe,
                                         std::size_t stride) {
  const ImageSection* section = image.find(kind, pe);
  if (section == nullptr) return bad(kind, pe, "is missing");
  if (section->bytes.size() % stride != 0) {
    return bad(kind, pe,
               fmt::format("{} bytes are not whole records of {}", section->bytes.size(), stride));
  }
  return section;
}

Result<PeTriangles> decode_pe_triangles(const Image& image, int pe) {
  const auto vertices = decode_vertices(image, pe);
  if (!vertices) return std::unexpected(vertices.error());
  const protocol::TriangleCodec codec(image.header);
  if (!codec.valid()) return bad(SectionKind::kTriangles, pe, "a width in the header is not valid");
  const auto section = find_records(image, SectionKind::kTriangles, pe, codec.stride());
  if (!section) return std::unexpected(section.error());
  PeTriangles out;
  const std::size_t count = (*section)->bytes.size() / codec.stride();
  out.triangles.resize(count);
  out.ids.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    const protocol::TriangleRecord record = codec.at((*section)->bytes, i);
    for (std::size_t c = 0; c < 3; ++c) {
      if (record.vertex[c] >= vertices->size()) {
        return bad(
            SectionKind::kTriangles, pe,
            fmt::format("triangle {}: vertex {} of {}", i, record.vertex[c], vertices->size()));
      }
      out.triangles[i].v[c] = (*vertices)[record.vertex[c]];
    }
    if (record.id >= image.header.local_ids) {
      return bad(SectionKind::kTriangles, pe,
                 fmt::format("triangle {}: id {} of {}", i, record.id, image.header.local_ids));
    }
    if (i > 0 && record.id <= out.ids[i - 1]) {
      return bad(SectionKind::kTriangles, pe,
                 fmt::format("triangle {}: id {} after {}", i, record.id, out.ids[i - 1]));
    }
    out.ids[i] = record.id;
  }
  return out;
}

Result<std::vector<std::uint32_t>> decode_ids(const Image& image) {
  const auto section = find_records(image, SectionKind::kIds, 0, 4);
  if (!section) return std::unexpected(section.error());
  const std::vector<std::byte>& bytes = (*section)->bytes;
  if (bytes.size() / 4 != image.header.local_ids) {
    return bad(
        SectionKind::kIds, 0,
        fmt::format("{} ids, but the header says {}", bytes.size() / 4, image.header.local_ids));
  }
  std::vector<std::uint32_t> ids(image.header.local_ids);
  for (std::size_t i = 0; i < ids.size(); ++i) {
    ids[i] = protocol::detail::get32(bytes.data() + 4 * i);
    if (ids[i] >= image.header.triangles) {
      return bad(SectionKind::kIds, 0,
                 fmt::format("id {}: triangle {} of {}", i, ids[i], image.header.triangles));
    }
    if (i > 0 && ids[i] <= ids[i - 1]) {
      return bad(SectionKind::kIds, 0,
                 fmt::format("id {}: triangle {} after {}", i, ids[i], ids[i - 1]));
    }
  }
  return ids;
}

Result<ImageTriangles> decode_triangles(const Image& image) {
  auto ids = decode_ids(image);
  if (!ids) return std::unexpected(std::move(ids.error()));
  ImageTriangles out;
  out.global_ids = std::move(*ids);
  out.triangles.resize(out.global_ids.size());
  std::vector<std::uint8_t> seen(out.global_ids.size(), 0);
  for (int pe = 0; pe < image.header.pes; ++pe) {
    const auto local = decode_pe_triangles(image, pe);
    if (!local) return std::unexpected(local.error());
    for (std::size_t i = 0; i < local->ids.size(); ++i) {
      const std::uint32_t id = local->ids[i];
      if (seen[id] != 0 && out.triangles[id].v != local->triangles[i].v) {
        return bad(SectionKind::kTriangles, pe,
                   fmt::format("triangle {} (id {}) differs from an earlier PE's copy", i, id));
      }
      seen[id] = 1;
      out.triangles[id] = local->triangles[i];
    }
  }
  for (std::size_t id = 0; id < seen.size(); ++id) {
    if (seen[id] == 0) {
      return fail(ErrorKind::kInput, fmt::format("no PE holds the triangle with local id {}", id));
    }
  }
  return out;
}

namespace {

/// A scene of the lattice's own vertices: degenerate triangles are points at the origin's vertex.
Result<Scene> lattice_scene(const Image& image) {
  const auto local = decode_triangles(image);
  if (!local) return std::unexpected(local.error());
  const std::size_t degenerate = image.header.triangles - local->triangles.size();
  if (degenerate > kMostDegenerate) {
    return fail(ErrorKind::kLimit,
                fmt::format("{} degenerate triangles in an image without a scene", degenerate));
  }
  const Lattice lattice = image.lattice();
  Scene scene;
  scene.materials.emplace_back();
  scene.positions.reserve(3 * local->triangles.size() + 1);
  scene.positions.push_back(lattice.lo);
  scene.triangles.assign(image.header.triangles, {0, 0, 0});
  scene.triangle_materials.assign(image.header.triangles, 0);
  for (std::size_t i = 0; i < local->triangles.size(); ++i) {
    auto& triangle = scene.triangles[local->global_ids[i]];
    for (std::size_t c = 0; c < 3; ++c) {
      triangle[c] = static_cast<std::uint32_t>(scene.positions.size());
      glm::vec3& v = scene.positions.emplace_back();
      for (int a = 0; a < 3; ++a) {
        const int steps = local->triangles[i].v[c][a] - 2;
        v[a] = static_cast<float>(lattice.lo[a] + std::ldexp(steps, -lattice.scale[a]));
      }
    }
  }
  return scene;
}

}  // namespace

Result<Scene> decode_scene(const Image& image) {
  const ImageSection* section = image.find(SectionKind::kScene);
  if (section == nullptr) return lattice_scene(image);
  auto scene = unpack_scene(section->bytes);
  if (scene && scene->triangles.size() != image.header.triangles) {
    return bad(SectionKind::kScene, 0,
               fmt::format("{} triangles, but the header says {}", scene->triangles.size(),
                           image.header.triangles));
  }
  return scene;
}

}  // namespace gridrt
