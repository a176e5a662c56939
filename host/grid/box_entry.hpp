// Where a segment enters a box, as hits are ordered.
#pragma once

#include <cstdint>
#include <optional>

#include <glm/vec3.hpp>

namespace gridrt {

/// floor(2^24 t) of the smallest parameter t in [0, 1] at which p0 + t (p1 - p0) lies in the closed
/// box [lo, hi], or nothing if there is none. Exact: every hit within the box has a quotient
/// (HitKey) at least as large. p0 != p1; coordinates and bounds below 2^25 in magnitude.
std::optional<std::uint32_t> entry_quotient(const glm::ivec3& p0, const glm::ivec3& p1,
                                            const glm::ivec3& lo, const glm::ivec3& hi);

}  // namespace gridrt
