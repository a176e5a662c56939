// The start of a secondary ray, without an epsilon.
#include <algorithm>
#include <cmath>
#include <cstdlib>

#include <gmpxx.h>

#include "host/grid/intersect.hpp"
#include "host/grid/segment.hpp"
#include "host/grid/segment_cut.hpp"

namespace gridrt {
namespace {

/// Sign of sum n_i d_i 2^s_i, exactly.
int sign_of_dot(const glm::i64vec3& n, const glm::dvec3& direction, const glm::ivec3& scale) {
  double sum = 0.0;
  double magnitude = 0.0;
  for (int a = 0; a < 3; ++a) {
    const double term = static_cast<double>(n[a]) * std::ldexp(direction[a], scale[a]);
    sum += term;
    magnitude += std::abs(term);
  }
  // Conversions, products and two additions: well below 8 units of 2^-53 of the magnitudes;
  // a magnitude near the ends of double's range is left to the rationals.
  if (magnitude > 0x1p-900 && magnitude < 0x1p900 && std::abs(sum) > 0x1p-49 * magnitude) {
    return sum > 0.0 ? 1 : -1;
  }
  mpq_class exact = 0;
  for (int a = 0; a < 3; ++a) {
    mpq_class term = mpq_class(direction[a]) * mpq_class(static_cast<long>(n[a]));
    const int s = scale[a];
    if (s >= 0) {
      mpq_mul_2exp(term.get_mpq_t(), term.get_mpq_t(), static_cast<mp_bitcnt_t>(s));
    } else {
      mpq_div_2exp(term.get_mpq_t(), term.get_mpq_t(), static_cast<mp_bitcnt_t>(-s));
    }
    exact += term;
  }
  return sgn(exact);
}

Int128 floor_divide(Int128 a, Int128 b) {  // b > 0
  const Int128 q = a / b;
  return q * b > a ? q - 1 : q;
}

/// Moves `point` along the axis of the largest component of the triangle's normal n until
/// s n.(point - v0) > 0 with s = sign(n.direction); where that is 0 it stays.
glm::i64vec3 move_to_side(const Lattice& lattice, const LatticeTriangle& triangle,
                          const glm::dvec3& direction, glm::i64vec3 point) {
  const glm::i64vec3 v0{triangle.v[0]};
  const glm::i64vec3 e1 = glm::i64vec3{triangle.v[1]} - v0;
  const glm::i64vec3 e2 = glm::i64vec3{triangle.v[2]} - v0;
  const glm::i64vec3 n{e1.y * e2.z - e1.z * e2.y, e1.z * e2.x - e1.x * e2.z,
                       e1.x * e2.y - e1.y * e2.x};
  const int side = sign_of_dot(n, direction, lattice.scale);
  if (side == 0) return point;
  int axis = 0;
  for (int a = 1; a < 3; ++a) {
    if (std::llabs(n[a]) > std::llabs(n[axis])) axis = a;
  }
  const glm::i64vec3 r = point - v0;
  const Int128 height = side * (Int128{n.x} * r.x + Int128{n.y} * r.y + Int128{n.z} * r.z);
  if (height <= 0) {
    const Int128 steps = -height / std::llabs(n[axis]) + 1;
    point[axis] += static_cast<std::int64_t>(steps) * ((n[axis] > 0) == (side > 0) ? 1 : -1);
  }
  return point;
}

}  // namespace

std::optional<glm::ivec3> secondary_origin(const Lattice& lattice, const Segment& incoming,
                                           const LatticeTriangle& triangle,
                                           const glm::dvec3& direction) {
  const std::optional<ExactHit> hit = intersect_exact(incoming.p0, incoming.p1, triangle);
  if (!hit) return std::nullopt;
  glm::i64vec3 point;
  for (int a = 0; a < 3; ++a) {
    // p0 + floor(d tn / det + 1/2); d tn takes 102 bits.
    const Int128 d = incoming.p1[a] - incoming.p0[a];
    const Int128 rounded = floor_divide(2 * d * hit->tn + hit->det, 2 * hit->det);
    point[a] = incoming.p0[a] + static_cast<std::int64_t>(rounded);
  }
  point = move_to_side(lattice, triangle, direction, point);
  const glm::i64vec3 box{lattice.box()};
  for (int a = 0; a < 3; ++a) {
    if (point[a] < 0 || point[a] > box[a]) return std::nullopt;
  }
  return glm::ivec3{point};
}

Segment make_secondary_segment(const Lattice& lattice, const Ray& ray, const glm::ivec3& p0,
                               const LatticeTriangle& triangle, std::uint32_t ignore) {
  const detail::Cut c = detail::cut(lattice, ray);
  if (c.outcome != detail::Cut::Outcome::kCut) return {};
  const glm::i64vec3 end = move_to_side(lattice, triangle, ray.direction, glm::i64vec3{c.p1});
  Segment segment{p0, c.p1, 0.0, c.t1, ignore};
  for (int a = 0; a < 3; ++a) {
    segment.p1[a] = static_cast<int>(std::clamp<std::int64_t>(end[a], 0, lattice.box()[a]));
  }
  return segment;
}

}  // namespace gridrt
