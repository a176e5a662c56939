// The exact test in 64 bits, for lattices of at most 17 bits: the inner loop of software PEs.
#pragma once

#include <cstdint>
#include <optional>

#include <glm/vec3.hpp>

#include "host/grid/intersect.hpp"

namespace gridrt {

/// A triangle prepared for the test: first vertex and both edges, below 2^18 in magnitude.
struct EdgeTriangle {
  glm::ivec3 v0{0};
  glm::ivec3 e1{0};
  glm::ivec3 e2{0};

  EdgeTriangle() = default;
  explicit EdgeTriangle(const LatticeTriangle& t)
      : v0(t.v[0]), e1(t.v[1] - t.v[0]), e2(t.v[2] - t.v[0]) {}
};

/// The same answer as intersect_exact where every coordinate is below 2^17: the determinants are
/// below 3 * 2 * 2^51 < 2^54. `d` is p1 - p0. A triangle that u alone rules out costs no more.
inline std::optional<ExactHit> intersect_narrow(const glm::ivec3& p0, const glm::ivec3& d,
                                                const EdgeTriangle& triangle) {
  const auto wide = [](int x) { return static_cast<std::int64_t>(x); };
  const auto minor = [&](int a, int b, int c, int e) { return wide(a) * b - wide(c) * e; };
  const glm::ivec3& e1 = triangle.e1;
  const glm::ivec3& e2 = triangle.e2;
  const std::int64_t px = minor(d.y, e2.z, d.z, e2.y);
  const std::int64_t py = minor(d.z, e2.x, d.x, e2.z);
  const std::int64_t pz = minor(d.x, e2.y, d.y, e2.x);
  std::int64_t det = e1.x * px + e1.y * py + e1.z * pz;
  const glm::ivec3 t = p0 - triangle.v0;
  std::int64_t u = t.x * px + t.y * py + t.z * pz;
  // All bits of `sign` are those of det's sign; (x ^ sign) - sign negates where det is negative.
  const std::int64_t sign = det >> 63;
  det = (det ^ sign) - sign;
  u = (u ^ sign) - sign;
  if (det == 0 || u < 0 || u > det) return std::nullopt;
  const std::int64_t qx = minor(t.y, e1.z, t.z, e1.y);
  const std::int64_t qy = minor(t.z, e1.x, t.x, e1.z);
  const std::int64_t qz = minor(t.x, e1.y, t.y, e1.x);
  const std::int64_t v = ((d.x * qx + d.y * qy + d.z * qz) ^ sign) - sign;
  if (v < 0 || u + v > det) return std::nullopt;
  const std::int64_t tn = ((e2.x * qx + e2.y * qy + e2.z * qz) ^ sign) - sign;
  if (tn < 0 || tn > det) return std::nullopt;
  return ExactHit{det, u, v, tn};
}

}  // namespace gridrt
