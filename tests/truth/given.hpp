// The closest hit of a scene as it is given: float32 vertices, float64 rays, no lattice.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "host/scene/scene.hpp"
#include "tests/truth/float_boxes.hpp"
#include "tests/truth/tracer.hpp"

namespace gridrt::truth {

/// By brute force over all triangles, or over those whose boxes the ray meets: interval bounds in
/// double rule most of them out, rationals decide the rest.
class GivenTracer {
 public:
  GivenTracer(const Scene& scene, Search search);

  /// Ids of all triangles that the ray meets at the smallest t in [tmin, tmax], ascending; none for
  /// a miss. Triangles are two-sided and closed; degenerate and coplanar ones are never met.
  [[nodiscard]] std::vector<std::int64_t> closest(const Ray& ray) const;

 private:
  struct Corners {
    std::array<std::array<double, 3>, 3> v;
  };
  std::vector<Corners> triangles_;
  std::optional<FloatBoxes> tree_;
};

}  // namespace gridrt::truth
