// How far empty space reaches around each voxel of a box of voxels.
#pragma once

#include <cstdint>
#include <span>

#include <glm/vec3.hpp>

namespace gridrt {

/// `codes`, size.x * size.y * size.z in order x, y, z: >= 0 for a voxel with triangles, anything
/// below 0 for an empty one. Empty ones become -k, k the number of steps (to any of 26 neighbours)
/// to the nearest voxel with triangles, at most kFarthest.
void measure_empty_space(const glm::ivec3& size, std::span<std::int32_t> codes);

inline constexpr std::int32_t kFarthest = 1 << 20;

}  // namespace gridrt
