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
using Integers = hn::RebindToSigned<Floats>;
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

/// What is computed of each lane's ray and triangle, all by det's sign.
struct Test {
  Vector size;  ///< |det|
  Vector u, v, tn;
};

/// From det, tn, the edges and r = (V0 - P0) x D.
HWY_INLINE Test make_test(const Vector& det, const Vector& tn, const Vector3& e1, const Vector3& e2,
                          const Vector3& r) {
  const Vector sign_bit = hn::SignBit(Floats{});
  const Vector sign = hn::And(det, sign_bit);
  return {hn::Xor(det, sign), hn::Xor(dot(e2, r), sign),
          hn::Xor(dot(e1, r), hn::Xor(sign, sign_bit)), hn::Xor(tn, sign)};
}

/// Lanes in which the ray meets the triangle at 0 <= tn <= limit * det. Never leaves one out that
/// is hit (docs/numerics.md, section 7): `e` bounds the error of u, v and det, `f` half of what
/// that of tn, with theirs, may come to.
HWY_INLINE hn::Mask<Floats> possible(const Test& test, float e, float f, const Vector& limit) {
  const Floats tag;
  const auto inside = hn::Ge(hn::Min(test.u, test.v), hn::Set(tag, -4.0F * e));
  const auto below = hn::Le(hn::Sub(hn::Add(test.u, test.v), test.size), hn::Set(tag, 8.0F * e));
  const auto after = hn::Ge(test.tn, hn::Set(tag, -f));
  const auto before = hn::Le(hn::NegMulAdd(limit, test.size, test.tn), hn::Set(tag, f));
  return hn::And(hn::And(inside, below), hn::And(after, before));
}

/// Lanes in which it surely does, with limit = 1.
HWY_INLINE hn::Mask<Floats> certain(const Test& test, float e, float f) {
  const Floats tag;
  const auto inside = hn::Ge(hn::Min(test.u, test.v), hn::Set(tag, 4.0F * e));
  const auto below = hn::Ge(hn::Sub(test.size, hn::Add(test.u, test.v)), hn::Set(tag, 8.0F * e));
  const auto after = hn::Ge(hn::Min(test.tn, hn::Sub(test.size, test.tn)), hn::Set(tag, f));
  return hn::And(hn::And(inside, below), after);
}

/// A block's triangles with one ray.
HWY_INLINE Test test_block(const float* block, const WideRay& ray) {
  const std::size_t n = hn::Lanes(Floats{});
  const Vector3 v0 = load_rows(block);
  const Vector3 t{hn::Sub(v0.x, ray.p0.x), hn::Sub(v0.y, ray.p0.y), hn::Sub(v0.z, ray.p0.z)};
  const Vector3 normal = load_rows(block + 9 * n);
  return make_test(dot(ray.d, normal), dot(t, normal), load_rows(block + 3 * n),
                   load_rows(block + 6 * n), cross(t, ray.d));
}

/// The triangles of a block that the ray may hit at tn <= limit * det, a bit each.
HWY_INLINE unsigned candidates(const float* block, const WideRay& ray, float e, float f,
                               float limit) {
  return mask_bits(possible(test_block(block, ray), e, f, hn::Set(Floats{}, limit)));
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
