#include "host/pe/pe.hpp"

#include "host/grid/quarters.hpp"
#include "host/image/quarter_code.hpp"

namespace gridrt {
namespace {

using protocol::ErrorCode;
using protocol::SectionKind;

/// True if the ray and the triangle may meet within the voxel.
bool share_a_cell(const VoxelReference& reference, CellSet ray) {
  return (cells_of(reference.quarters) & ray) != 0;
}

}  // namespace

Accepted<Pe> Pe::decode(const protocol::ImageHeader& header, std::uint8_t number,
                        std::span<const std::byte> references, std::span<const std::byte> triangles,
                        std::span<const std::byte> vertices) {
  const protocol::ReferenceCodec reference_codec(header);
  const protocol::TriangleCodec triangle_codec(header);
  const protocol::VertexCodec vertex_codec(header);
  if (!reference_codec.valid() || !triangle_codec.valid() || !vertex_codec.valid()) {
    return refuse(ErrorCode::kBadHeader, 104);  // offset of the first width
  }
  const auto bad = [&](SectionKind kind) {
    return refuse(ErrorCode::kBadSection, section_detail(kind, number));
  };
  if (vertices.size() % vertex_codec.stride() != 0) return bad(SectionKind::kVertices);
  if (triangles.size() % triangle_codec.stride() != 0) return bad(SectionKind::kTriangles);
  if (references.size() % reference_codec.stride() != 0) return bad(SectionKind::kReferences);

  std::vector<glm::ivec3> corners(vertices.size() / vertex_codec.stride());
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const protocol::VertexRecord record = vertex_codec.at(vertices, i);
    for (int a = 0; a < 3; ++a) {
      const std::uint32_t q = record.q[static_cast<std::size_t>(a)];
      const auto j = static_cast<std::size_t>(a);
      if (q > static_cast<std::uint32_t>(header.max_q[j])) return bad(SectionKind::kVertices);
      corners[i][a] = static_cast<std::int32_t>(q);
    }
  }
  Pe pe;
  pe.narrow_ = header.bits <= kMaxCompactBits;
  pe.triangles_.resize(triangles.size() / triangle_codec.stride());
  for (std::size_t i = 0; i < pe.triangles_.size(); ++i) {
    const protocol::TriangleRecord record = triangle_codec.at(triangles, i);
    LatticeTriangle triangle{};
    for (std::size_t c = 0; c < 3; ++c) {
      if (record.vertex[c] >= corners.size()) return bad(SectionKind::kTriangles);
      triangle.v[c] = corners[record.vertex[c]];
    }
    pe.triangles_[i].edges = EdgeTriangle(triangle);
    if (record.id >= header.local_ids) return bad(SectionKind::kTriangles);
    pe.triangles_[i].id = record.id;
  }
  pe.references_.resize(references.size() / reference_codec.stride());
  for (std::size_t i = 0; i < pe.references_.size(); ++i) {
    const protocol::ReferenceRecord record = reference_codec.at(references, i);
    if (record.triangle >= pe.triangles_.size()) return bad(SectionKind::kReferences);
    pe.references_[i] = {record.triangle, quarters_of_code(record.quarters)};
  }
  return pe;
}

std::optional<ExactHit> Pe::intersect(const PeRay& ray, const glm::ivec3& d,
                                      const Triangle& triangle) const {
  const EdgeTriangle& e = triangle.edges;
  if (narrow_) return intersect_narrow(ray.p0, d, e);
  return intersect_exact(ray.p0, ray.p1, {{e.v0, e.v0 + e.e1, e.v0 + e.e2}});
}

void Pe::test(const PeRay& ray, std::uint32_t first, std::uint32_t count, CellSet cells,
              HitKey& best, PeCounters& counters, PeObserver* observer) const {
  const glm::ivec3 d = ray.p1 - ray.p0;
  for (const VoxelReference& reference : std::span(references_).subspan(first, count)) {
    const Triangle& triangle = triangles_[reference.triangle];
    if (!share_a_cell(reference, cells)) {
      ++counters.masked;
      if (observer != nullptr) observer->on_masked(triangle.id);
      continue;
    }
    if (triangle.id == ray.ignore) continue;
    ++counters.tests;
    const std::optional<ExactHit> hit = intersect(ray, d, triangle);
    std::optional<HitKey> key;
    if (hit) {
      key = HitKey{hit_quotient(*hit), triangle.id};
      if (*key < best) best = *key;
    }
    if (observer != nullptr) observer->on_test(triangle.id, key);
  }
}

bool Pe::test_any(const PeRay& ray, std::uint32_t first, std::uint32_t count, CellSet cells,
                  PeCounters& counters) const {
  const glm::ivec3 d = ray.p1 - ray.p0;
  for (const VoxelReference& reference : std::span(references_).subspan(first, count)) {
    const Triangle& triangle = triangles_[reference.triangle];
    if (!share_a_cell(reference, cells)) {
      ++counters.masked;
      continue;
    }
    if (triangle.id == ray.ignore) continue;
    ++counters.tests;
    if (intersect(ray, d, triangle)) return true;
  }
  return false;
}

}  // namespace gridrt
