#include "host/grid/intersect.hpp"

#include <glm/ext/vector_int3_sized.hpp>

namespace gridrt {
namespace {

/// The 2x2 minors of 25-bit differences fit 51 bits.
glm::i64vec3 cross(const glm::i64vec3& a, const glm::i64vec3& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

template <class Scalar>
Scalar dot(const glm::i64vec3& a, const glm::i64vec3& b) {
  return Scalar{a.x} * b.x + Scalar{a.y} * b.y + Scalar{a.z} * b.z;
}

/// Moeller-Trumbore in a scalar that holds every product.
template <class Scalar>
std::optional<ExactHit> intersect(const glm::i64vec3& p0, const glm::i64vec3& d,
                                  const LatticeTriangle& triangle) {
  const glm::i64vec3 v0{triangle.v[0]};
  const glm::i64vec3 e1 = glm::i64vec3{triangle.v[1]} - v0;
  const glm::i64vec3 e2 = glm::i64vec3{triangle.v[2]} - v0;
  const glm::i64vec3 p = cross(d, e2);
  Scalar det = dot<Scalar>(e1, p);
  if (det == 0) return std::nullopt;
  const glm::i64vec3 t = p0 - v0;
  Scalar u = dot<Scalar>(t, p);
  const glm::i64vec3 q = cross(t, e1);
  Scalar v = dot<Scalar>(d, q);
  Scalar tn = dot<Scalar>(e2, q);
  if (det < 0) {
    det = -det;
    u = -u;
    v = -v;
    tn = -tn;
  }
  if (u < 0 || v < 0 || u + v > det || tn < 0 || tn > det) return std::nullopt;
  return ExactHit{det, u, v, tn};
}

/// The nearest double; the short way for what 64 bits hold.
double to_double(Int128 x) {
  const auto low = static_cast<std::int64_t>(x);
  return low == x ? static_cast<double>(low) : static_cast<double>(x);
}

}  // namespace

std::optional<ExactHit> intersect_exact(const glm::ivec3& p0, const glm::ivec3& p1,
                                        const LatticeTriangle& triangle) {
  const glm::i64vec3 start{p0};
  const glm::i64vec3 d = glm::i64vec3{p1} - start;
  // With every coordinate below 2^17 the determinants are below 3 * 2 * 2^51 < 2^54; a sum of two
  // (u + v) stays far from 2^63.
  const auto small = [](const glm::ivec3& a) {
    return ((a.x | a.y | a.z) >> kMaxCompactBits) == 0;
  };
  if (small(p0) && small(p1) && small(triangle.v[0]) && small(triangle.v[1]) &&
      small(triangle.v[2])) {
    return intersect<std::int64_t>(start, d, triangle);
  }
  return intersect<Int128>(start, d, triangle);
}

std::uint32_t hit_quotient(const ExactHit& hit) {
  return static_cast<std::uint32_t>((hit.tn << 24) / hit.det);
}

HitParameters hit_parameters(const Segment& segment, const ExactHit& hit) {
  const auto det = to_double(hit.det);
  // Both weights are rounded quotients of exact integers and both terms are >= 0, so nothing
  // cancels: the relative error is that of t0 and t1 plus a few units in the last place.
  const double far_weight = to_double(hit.tn) / det;
  const double near_weight = to_double(hit.det - hit.tn) / det;
  return {segment.t0 * near_weight + segment.t1 * far_weight, to_double(hit.u) / det,
          to_double(hit.v) / det};
}

}  // namespace gridrt
