// From a ray in scene units to a segment on the lattice: the last place where anything is rounded.
#pragma once

#include <limits>
#include <optional>

#include <glm/vec3.hpp>

#include "hal/error.hpp"
#include "host/grid/lattice.hpp"

namespace gridrt {

/// A ray O + t D, t in [tmin, tmax]; D not 0, finite, 0 <= tmin <= tmax (tmax may be infinite).
struct Ray {
  glm::dvec3 origin{0.0};
  glm::dvec3 direction{0.0, 0.0, 1.0};
  double tmin = 0.0;
  double tmax = std::numeric_limits<double>::infinity();
};

inline constexpr std::uint32_t kNoTriangle = 0xFFFFFFFFU;  ///< no triangle is ignored

/// A ray on the lattice. p0 == p1 is a miss by definition (so is a ray that never meets the box).
struct Segment {
  glm::ivec3 p0{0};  ///< lattice end points, each in [0, box]
  glm::ivec3 p1{0};
  double t0 = 0.0;                     ///< ray parameter at p0, relative error <= 1e-13
  double t1 = 0.0;                     ///< ray parameter at p1, relative error <= 1e-13
  std::uint32_t ignore = kNoTriangle;  ///< global id of the triangle that the ray leaves

  [[nodiscard]] bool is_miss() const { return p0 == p1; }
};

/// Checks what Ray demands; the error says which number is wrong.
Result<void> validate(const Ray& ray);

/// Cuts a valid ray to the closed lattice box and rounds its end points to nearest, as if in
/// rational arithmetic (a filter in double-double decides almost always, rationals the rest).
Segment make_segment(const Lattice& lattice, const Ray& ray);

/// Where a secondary ray starts: the hit point rn(p0 + (tn/det)(p1 - p0)) of `incoming` on
/// `triangle`, moved along the axis of the normal's largest component until it lies strictly on
/// the side of `triangle` that `direction` (scene units) points to. A direction in the triangle's
/// plane leaves the point where it is. Nothing if the point leaves the box.
std::optional<glm::ivec3> secondary_origin(const Lattice& lattice, const Segment& incoming,
                                           const LatticeTriangle& triangle,
                                           const glm::dvec3& direction);

/// A secondary ray: its start point is `p0` (tmin is 0, so t0 is 0), `ignore` the triangle it
/// leaves, its end point and parameter those of make_segment. An end point that rounding has put
/// on the plane of `triangle` or behind it is moved like the start point, as far as the box allows:
/// a ray that leaves a plane cannot come back to it. A ray whose line misses the box is a miss.
Segment make_secondary_segment(const Lattice& lattice, const Ray& ray, const glm::ivec3& p0,
                               const LatticeTriangle& triangle, std::uint32_t ignore);

}  // namespace gridrt
