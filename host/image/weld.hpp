// Gives equal lattice points one index.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

namespace gridrt {

/// Distinct points in the order of their first occurrence, and for each input point its index
/// among them.
struct WeldedPoints {
  std::vector<glm::ivec3> points;
  std::vector<std::uint32_t> index;
};

/// Takes fewer than 2^32 points.
WeldedPoints weld(std::span<const glm::ivec3> points);

}  // namespace gridrt
