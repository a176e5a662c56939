// The march of a stream: a vector of rays, each from voxel to voxel, over empty space in one step.
// Compiled for each kind of vectors.
//
// Positions are rounded, so a ray may be found in a voxel that it only comes close to. It strays by
// less than the margin with which triangles were put into voxels (docs/numerics.md, section 7), so
// no hit is lost.
#include "host/pe/ray_lanes.hpp"

#if defined(GRIDRT_RAY_MARCH_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef GRIDRT_RAY_MARCH_INL
#undef GRIDRT_RAY_MARCH_INL
#else
#define GRIDRT_RAY_MARCH_INL
#endif

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace gridrt {
namespace HWY_NAMESPACE {

inline void idle_lane(MarchLanes& march, std::size_t lane) {
  for (std::size_t a = 0; a < 3; ++a) {
    march.first[a][lane] = 4.0F;
    march.pitch[a][lane] = 4.0F;
    march.rate[a][lane] = 0.25F;
    march.crossed[a][lane] = 0.0F;
    march.step[a][lane] = 0;
  }
  march.limit[lane] = 0.0F;
  march.voxel[lane] = 0;
}

inline void start_march(const RayLayout& layout, const PeRay& ray, MarchLanes& march,
                        std::size_t lane) {
  std::int32_t number = 0;
  for (int i = 0; i < 3; ++i) {
    const auto a = static_cast<std::size_t>(i);
    const int edge = layout.edge()[i];
    const int d = ray.p1[i] - ray.p0[i];
    const int voxel = std::min(ray.p0[i] / edge, layout.count()[i] - 1);
    number += (voxel + 1) * layout.stride()[i];
    march.crossed[a][lane] = 0.0F;
    if (d == 0) {  // never meets a plane: all lie beyond every limit
      march.first[a][lane] = 4.0F;
      march.pitch[a][lane] = 4.0F;
      march.rate[a][lane] = 0.25F;
      march.step[a][lane] = 0;
      continue;
    }
    const float size = static_cast<float>(std::abs(d));
    const int face = d > 0 ? (voxel + 1) * edge - ray.p0[i] : ray.p0[i] - voxel * edge;
    march.first[a][lane] = static_cast<float>(face) / size;
    march.pitch[a][lane] = static_cast<float>(edge) / size;
    march.rate[a][lane] = size / static_cast<float>(edge);
    march.step[a][lane] = d > 0 ? layout.stride()[i] : -layout.stride()[i];
  }
  march.limit[lane] = 1.0F;
  march.voxel[lane] = number;
}

/// What a lane needs for its tests.
inline TestLane start_test(const BatchRay& ray, std::size_t index) {
  TestLane test;
  test.ray = &ray;
  test.index = index;
  test.d = ray.ray.p1 - ray.ray.p0;
  test.length = static_cast<float>(std::abs(test.d.x) + std::abs(test.d.y) + std::abs(test.d.z));
  return test;
}

/// Moves every ray out of the empty space around its voxel, or, from a voxel with triangles, to the
/// next one. Bit i: the ray of lane i has passed its limit. `reach`: 1, or how far the nearest
/// voxel with triangles is.
HWY_INLINE unsigned advance(MarchLanes& march, const hn::Vec<Integers>& reach) {
  const Floats f;
  const Integers n;
  const Vector steps = hn::ConvertTo(f, reach);
  const Vector one = hn::Set(f, 1.0F);
  const Vector beyond = hn::Sub(steps, one);
  Vector next[3];   // where the ray meets the next plane
  Vector leave[3];  // and the last one of the empty space
  Vector crossed[3];
  for (std::size_t a = 0; a < 3; ++a) {
    const Vector pitch = hn::Load(f, march.pitch[a].data());
    crossed[a] = hn::Load(f, march.crossed[a].data());
    next[a] = hn::MulAdd(crossed[a], pitch, hn::Load(f, march.first[a].data()));
    leave[a] = hn::MulAdd(beyond, pitch, next[a]);
  }
  const Vector exit = hn::Min(hn::Min(leave[0], leave[1]), leave[2]);
  auto voxel = hn::Load(n, march.voxel.data());
  for (std::size_t a = 0; a < 3; ++a) {
    const Vector rate = hn::Load(f, march.rate[a].data());
    const Vector planes = hn::MulAdd(hn::Sub(exit, next[a]), rate, one);
    const auto whole = hn::ConvertTo(n, hn::Max(planes, hn::Zero(f)));
    const auto count = hn::IfThenElse(hn::RebindMask(n, hn::Eq(leave[a], exit)), reach, whole);
    hn::Store(hn::Add(crossed[a], hn::ConvertTo(f, count)), f, march.crossed[a].data());
    voxel = hn::Add(voxel, hn::Mul(count, hn::Load(n, march.step[a].data())));
  }
  hn::Store(voxel, n, march.voxel.data());
  return mask_bits(hn::Gt(exit, hn::Load(f, march.limit.data())));
}

struct Looked {
  hn::Vec<Integers> reach;
  unsigned occupied;  ///< bit i: lane i is in a voxel with triangles
};

HWY_INLINE Looked look(const RayLayout& layout, const MarchLanes& march) {
  const Integers n;
  const auto code = hn::GatherIndex(n, layout.codes(), hn::Load(n, march.voxel.data()));
  const auto empty = hn::Lt(code, hn::Zero(n));
  const auto reach = hn::IfThenElse(empty, hn::Neg(code), hn::Set(n, 1));
  return {reach, ~mask_bits(hn::RebindMask(Floats{}, empty))};
}

}  // namespace HWY_NAMESPACE
}  // namespace gridrt
HWY_AFTER_NAMESPACE();

#endif
