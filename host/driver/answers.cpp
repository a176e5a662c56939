#include "host/driver/answers.hpp"

#include <algorithm>
#include <utility>

#include "host/grid/intersect_narrow.hpp"

namespace gridrt {

Result<Answers> Answers::make(const Image& image) {
  Result<ImageTriangles> triangles = decode_triangles(image);
  if (!triangles) return std::unexpected(std::move(triangles.error()));
  Answers answers;
  answers.triangles_ = std::move(*triangles);
  answers.narrow_ = image.header.bits <= kMaxCompactBits;
  if (image.header.chunks > 1) return answers;
  answers.local_ids_.assign(image.header.triangles, kNoTriangle);
  for (std::size_t i = 0; i < answers.triangles_.global_ids.size(); ++i) {
    const std::uint32_t global = answers.triangles_.global_ids[i];
    if (global >= answers.local_ids_.size()) {
      return fail(ErrorKind::kInput, "the image maps a local id beyond its triangles");
    }
    answers.local_ids_[global] = static_cast<std::uint32_t>(i);
  }
  return answers;
}

std::uint32_t Answers::local_id(std::uint32_t global_id) const {
  if (!local_ids_.empty()) {
    return global_id < local_ids_.size() ? local_ids_[global_id] : kNoTriangle;
  }
  const auto found = std::ranges::lower_bound(triangles_.global_ids, global_id);
  if (found == triangles_.global_ids.end() || *found != global_id) return kNoTriangle;
  return static_cast<std::uint32_t>(found - triangles_.global_ids.begin());
}

std::optional<Hit> Answers::hit(const Segment& segment, std::uint32_t id) const {
  const LatticeTriangle& triangle = triangles_.triangles[id];
  const std::optional<ExactHit> exact =
      narrow_ ? intersect_narrow(segment.p0, segment.p1 - segment.p0, EdgeTriangle{triangle})
              : intersect_exact(segment.p0, segment.p1, triangle);
  if (!exact) return std::nullopt;
  const HitParameters p = hit_parameters(segment, *exact);
  return Hit{static_cast<std::int32_t>(triangles_.global_ids[id]), p.t, p.u, p.v};
}

}  // namespace gridrt
