// The rays that a stream works on, one for each lane of a vector.
#pragma once

#include <array>
#include <cstdint>

#include "host/pe/batch_ray.hpp"
#include "host/pe/ray_layout.hpp"

namespace gridrt {

/// The march, a row of lanes for each quantity. Along axis a the ray meets the next plane between
/// voxels at parameter first[a] + crossed[a] * pitch[a] of p0 .. p1.
struct alignas(64) MarchLanes {
  using Row = std::array<float, kMostLanes>;
  alignas(64) std::array<Row, 3> first;    ///< parameter of the first plane
  alignas(64) std::array<Row, 3> pitch;    ///< from plane to plane
  alignas(64) std::array<Row, 3> rate;     ///< its reciprocal
  alignas(64) std::array<Row, 3> crossed;  ///< planes crossed so far
  alignas(64) Row limit;                   ///< the march ends beyond this parameter
  alignas(64) std::array<std::array<std::int32_t, kMostLanes>, 3> step;  ///< in voxel numbers
  alignas(64) std::array<std::int32_t, kMostLanes> voxel;                ///< where the ray is
};

/// What the triangle tests of a lane need.
struct TestLane {
  const BatchRay* ray = nullptr;
  std::size_t index = 0;  ///< of the ray in its batch
  glm::ivec3 d{0};
  float length = 0.0F;  ///< sum of the absolute components of d
  float limit = 1.0F;   ///< a hit that matters has tn <= limit * det
  HitKey best;
};

}  // namespace gridrt
