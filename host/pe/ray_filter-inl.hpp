// The triangle test of a stream: all triangles of a voxel against one ray in single precision, and
// exact integers for those that this could not rule out. Compiled for each kind of vectors.
#include "host/pe/ray_candidate.hpp"
#include "host/pe/ray_lanes.hpp"

#if defined(GRIDRT_RAY_FILTER_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef GRIDRT_RAY_FILTER_INL
#undef GRIDRT_RAY_FILTER_INL
#else
#define GRIDRT_RAY_FILTER_INL
#endif

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace gridrt {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using Floats = hn::CappedTag<float, kMostLanes>;
using Vector = hn::Vec<Floats>;

struct Vector3 {
  Vector x, y, z;
};

HWY_INLINE Vector3 load_rows(const float* rows) {
  const Floats f;
  const std::size_t n = hn::Lanes(f);
  return {hn::Load(f, rows), hn::Load(f, rows + n), hn::Load(f, rows + 2 * n)};
}

HWY_INLINE Vector dot(const Vector3& a, const Vector3& b) {
  return hn::MulAdd(a.x, b.x, hn::MulAdd(a.y, b.y, hn::Mul(a.z, b.z)));
}

HWY_INLINE Vector3 cross(const Vector3& a, const Vector3& b) {
  return {hn::MulSub(a.y, b.z, hn::Mul(a.z, b.y)), hn::MulSub(a.z, b.x, hn::Mul(a.x, b.z)),
          hn::MulSub(a.x, b.y, hn::Mul(a.y, b.x))};
}

/// Bit i: lane i.
HWY_INLINE unsigned mask_bits(const hn::Mask<Floats>& mask) {
  std::uint8_t bytes[8] = {};
  hn::StoreMaskBits(Floats{}, mask, bytes);
  return bytes[0] | static_cast<unsigned>(bytes[1]) << 8;
}

/// A ray in every lane.
struct WideRay {
  Vector3 p0, d;
};

inline WideRay widen(const TestLane& test) {
  const Floats f;
  const auto set = [&](int x) { return hn::Set(f, static_cast<float>(x)); };
  const glm::ivec3& p0 = test.ray->ray.p0;
  return {{set(p0.x), set(p0.y), set(p0.z)}, {set(test.d.x), set(test.d.y), set(test.d.z)}};
}

/// The triangles of a block that the ray may hit at tn <= limit * det, a bit each. Never leaves one
/// out that it does hit (docs/numerics.md, section 7): `e` bounds the error of u, v and det, `f`
/// half of what that of tn, with theirs, may come to.
HWY_INLINE unsigned candidates(const float* block, const WideRay& ray, float e, float f,
                               float limit) {
  const Floats tag;
  const std::size_t n = hn::Lanes(tag);
  const Vector3 v0 = load_rows(block);
  const Vector3 t{hn::Sub(v0.x, ray.p0.x), hn::Sub(v0.y, ray.p0.y), hn::Sub(v0.z, ray.p0.z)};
  const Vector3 normal = load_rows(block + 9 * n);
  const Vector det = dot(ray.d, normal);
  const Vector tn = dot(t, normal);
  const Vector3 r = cross(t, ray.d);
  const Vector u = dot(load_rows(block + 6 * n), r);
  const Vector minus_v = dot(load_rows(block + 3 * n), r);
  // All by det's sign.
  const Vector sign_bit = hn::SignBit(tag);
  const Vector sign = hn::And(det, sign_bit);
  const Vector size = hn::Xor(det, sign);
  const Vector u1 = hn::Xor(u, sign);
  const Vector v1 = hn::Xor(minus_v, hn::Xor(sign, sign_bit));
  const Vector tn1 = hn::Xor(tn, sign);
  const auto inside = hn::Ge(hn::Min(u1, v1), hn::Set(tag, -4.0F * e));
  const auto below = hn::Le(hn::Sub(hn::Add(u1, v1), size), hn::Set(tag, 8.0F * e));
  const auto after = hn::Ge(tn1, hn::Set(tag, -f));
  const auto before = hn::Le(hn::NegMulAdd(hn::Set(tag, limit), size, tn1), hn::Set(tag, f));
  return mask_bits(hn::And(hn::And(inside, below), hn::And(after, before)));
}

/// Tests the triangles of a voxel; true if the ray's best hit has changed.
inline bool test_cell(const RayLayout& layout, const LayoutCell& cell, TestLane& test) {
  const std::size_t lanes = hn::Lanes(Floats{});
  const WideRay ray = widen(test);
  const auto box = static_cast<float>(layout.box());
  const float e = 0x1p-20F * box * test.length * cell.reach;
  const float f = 2.0F * (e + 0x3p-20F * box * cell.reach * cell.reach);
  bool changed = false;
  for (std::uint32_t b = cell.first; b < cell.first + cell.blocks; ++b) {
    const float* const block = layout.block(b);
    for (unsigned left = candidates(block, ray, e, f, test.limit); left != 0; left &= left - 1) {
      const auto lane = static_cast<std::size_t>(std::countr_zero(left));
      changed |= settle(layout.narrow(), block + lane, lanes, layout.ids(b)[lane], test);
    }
  }
  return changed;
}

}  // namespace HWY_NAMESPACE
}  // namespace gridrt
HWY_AFTER_NAMESPACE();

#endif
