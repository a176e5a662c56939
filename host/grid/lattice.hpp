// The lattice: every vertex and every end point of a ray is snapped to it once, and all that
// follows is exact integer arithmetic.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "hal/error.hpp"

namespace gridrt {

inline constexpr int kMinBits = 4;          ///< fewest lattice bits an axis
inline constexpr int kMaxBits = 24;         ///< most lattice bits an axis (wide records)
inline constexpr int kMaxCompactBits = 17;  ///< most lattice bits in compact records
inline constexpr int kDefaultBits = 17;

/// Scale and origin per axis: q = 2 + floor((v - lo) 2^scale + 1/2), in [2, max_q].
struct Lattice {
  int bits = kDefaultBits;
  glm::vec3 lo{0.0F};   ///< lower bound of the vertices that triangles use
  glm::vec3 hi{0.0F};   ///< upper bound
  glm::ivec3 scale{0};  ///< s: powers of two, largest with (hi - lo) 2^s <= 2^bits - 5
  glm::ivec3 max_q{2};  ///< largest snapped coordinate of any vertex in use

  /// The far corner of the closed lattice box [0, 2 + max q].
  [[nodiscard]] glm::ivec3 box() const { return max_q + 2; }
};

/// A triangle on the lattice.
struct LatticeTriangle {
  std::array<glm::ivec3, 3> v;
};

/// Bounds and scale of the vertices that triangles use; with no triangle, the unit lattice.
/// Errors: kUsage for bits outside [kMinBits, kMaxBits], kInput for a vertex that is not finite or
/// an index out of range (naming the element).
Result<Lattice> make_lattice(std::span<const glm::vec3> positions,
                             std::span<const std::array<std::uint32_t, 3>> triangles, int bits);

/// Snaps one vertex; exact for every finite float32 within the lattice's bounds.
glm::ivec3 snap(const Lattice& lattice, const glm::vec3& v);

/// Snaps every position that is within the bounds; others (used by no triangle) become 0.
std::vector<glm::ivec3> snap_all(const Lattice& lattice, std::span<const glm::vec3> positions);

/// True if the snapped triangle is a point or a segment: it is never hit.
bool is_degenerate(const LatticeTriangle& triangle);

}  // namespace gridrt
