// Which voxels a segment meets, apart from the engine's march.
#pragma once

#include <cstdlib>

#include <glm/ext/vector_int3_sized.hpp>

#include "host/grid/segment.hpp"
#include "host/grid/voxel_grid.hpp"

namespace gridrt::adversarial {

/// Closed segment against the closed box of a voxel: separating axes in doubled integers.
inline bool meets(const VoxelGrid& grid, const glm::ivec3& voxel, const Segment& s) {
  glm::i64vec3 reach{s.p1 - s.p0};
  glm::i64vec3 offset;
  glm::i64vec3 half;
  for (int i = 0; i < 3; ++i) {
    half[i] = grid.edge[i];
    offset[i] = std::int64_t{s.p0[i]} + s.p1[i] - (2 * std::int64_t{voxel[i]} + 1) * grid.edge[i];
    if (std::abs(offset[i]) > half[i] + std::abs(reach[i])) return false;
  }
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3;
    const int k = (i + 2) % 3;
    if (std::abs(reach[j] * offset[k] - reach[k] * offset[j]) >
        half[j] * std::abs(reach[k]) + half[k] * std::abs(reach[j])) {
      return false;
    }
  }
  return true;
}

}  // namespace gridrt::adversarial
