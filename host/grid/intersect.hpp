// The exact test of a segment against a triangle, and the key that orders hits.
#pragma once

#include <compare>
#include <cstdint>
#include <optional>

#include "host/grid/lattice.hpp"
#include "host/grid/segment.hpp"

namespace gridrt {

/// Wide enough for every product at 24 bits (det takes 77).
__extension__ using Int128 = __int128;

/// The exact integers of a hit, in Moeller and Trumbore's arrangement ("Fast, Minimum Storage
/// Ray/Triangle Intersection", 1997): D = p1 - p0, E1 = v1 - v0, E2 = v2 - v0, T = p0 - v0,
/// det = E1.(D x E2), u = T.(D x E2), v = D.(T x E1), tn = E2.(T x E1). All have det's sign or are
/// 0.
struct ExactHit {
  Int128 det = 0;
  Int128 u = 0;
  Int128 v = 0;
  Int128 tn = 0;
};

/// The order of hits: floor(2^24 tn / det), in [0, 2^24], then the triangle's id. Smallest wins.
struct HitKey {
  std::uint32_t quotient = 0xFFFFFFFFU;
  std::uint32_t id = kNoTriangle;
  auto operator<=>(const HitKey&) const = default;
};

/// Exact for bits <= 24. Two-sided and closed; degenerate and coplanar triangles are never hit.
std::optional<ExactHit> intersect_exact(const glm::ivec3& p0, const glm::ivec3& p1,
                                        const LatticeTriangle& triangle);

/// floor(2^24 tn / det) of a hit.
std::uint32_t hit_quotient(const ExactHit& hit);

/// What the host reports for a hit: relative error <= 1e-12 each.
struct HitParameters {
  double t = 0.0;  ///< in units of the ray's direction
  double u = 0.0;  ///< barycentric weight of the second vertex
  double v = 0.0;  ///< barycentric weight of the third vertex
};
HitParameters hit_parameters(const Segment& segment, const ExactHit& hit);

}  // namespace gridrt
