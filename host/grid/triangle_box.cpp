#include "host/grid/triangle_box.hpp"

#include <algorithm>
#include <cstdlib>

#include "host/grid/intersect.hpp"

namespace gridrt {

EighthBox eighth_box(const glm::ivec3& lo, const glm::ivec3& hi, int margin) {
  const glm::i64vec3 l{lo};
  const glm::i64vec3 h{hi};
  return {4L * (l + h), 4L * (h - l) + 8L * margin};
}

EighthBox eighth_slab_box(const glm::ivec3& lo, const glm::ivec3& hi, int margin, int axis,
                          int quarter) {
  EighthBox box = eighth_box(lo, hi, margin);
  const std::int64_t extent = std::int64_t{hi[axis]} - lo[axis];
  box.centre[axis] = 8 * std::int64_t{lo[axis]} + (2 * quarter + 1) * extent;
  box.half[axis] = extent + 8L * margin;
  return box;
}

TriangleBoxTest::TriangleBoxTest(const LatticeTriangle& triangle) {
  std::int64_t largest = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    v_[i] = 8L * glm::i64vec3{triangle.v[i]};
    edge_[i] = glm::i64vec3{triangle.v[(i + 1) % 3]} - glm::i64vec3{triangle.v[i]};
    for (int a = 0; a < 3; ++a) largest = std::max<std::int64_t>(largest, triangle.v[i][a]);
  }
  for (int a = 0; a < 3; ++a) {
    low_[a] = std::min({v_[0][a], v_[1][a], v_[2][a]});
    high_[a] = std::max({v_[0][a], v_[1][a], v_[2][a]});
  }
  const glm::i64vec3& a = edge_[0];
  const glm::i64vec3& b = edge_[1];
  normal_ = {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
  narrow_ = largest < (std::int64_t{1} << kMaxCompactBits);
}

template <class Scalar>
bool TriangleBoxTest::plane_meets(const EighthBox& box) const {
  Scalar distance = 0;
  Scalar radius = 0;
  for (int i = 0; i < 3; ++i) {
    distance += Scalar{normal_[i]} * (v_[0][i] - box.centre[i]);
    radius += Scalar{std::llabs(normal_[i])} * box.half[i];
  }
  return distance <= radius && -distance <= radius;
}

bool TriangleBoxTest::meets(const EighthBox& box) const {
  std::array<glm::i64vec3, 3> r{};
  for (std::size_t i = 0; i < 3; ++i) r[i] = v_[i] - box.centre;
  for (int a = 0; a < 3; ++a) {
    if (std::min({r[0][a], r[1][a], r[2][a]}) > box.half[a]) return false;
    if (std::max({r[0][a], r[1][a], r[2][a]}) < -box.half[a]) return false;
  }
  // A vertex in the box spares the rest.
  for (const glm::i64vec3& x : r) {
    if (std::llabs(x.x) <= box.half.x && std::llabs(x.y) <= box.half.y &&
        std::llabs(x.z) <= box.half.z) {
      return true;
    }
  }
  if (narrow_ ? !plane_meets<std::int64_t>(box) : !plane_meets<Int128>(box)) return false;
  // Axis a x edge: the component along `a` is zero, so each test is two-dimensional.
  for (std::size_t e = 0; e < 3; ++e) {
    for (int a = 0; a < 3; ++a) {
      const int b = (a + 1) % 3;
      const int c = (a + 2) % 3;
      const std::int64_t nb = -edge_[e][c];
      const std::int64_t nc = edge_[e][b];
      const std::int64_t p = nb * r[e][b] + nc * r[e][c];
      const std::size_t other = (e + 2) % 3;
      const std::int64_t q = nb * r[other][b] + nc * r[other][c];
      const std::int64_t radius = std::llabs(nb) * box.half[b] + std::llabs(nc) * box.half[c];
      if (std::min(p, q) > radius || std::max(p, q) < -radius) return false;
    }
  }
  return true;
}

}  // namespace gridrt
