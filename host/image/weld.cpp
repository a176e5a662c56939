#include "host/image/weld.hpp"

#include <bit>

namespace gridrt {
namespace {

constexpr std::uint32_t kFree = 0xFFFFFFFFU;

/// Spreads the coordinates over all bits (constants of the golden ratio and of MurmurHash3's
/// finaliser).
std::uint64_t mix(const glm::ivec3& p) {
  std::uint64_t h = static_cast<std::uint32_t>(p.x) | std::uint64_t{static_cast<std::uint32_t>(p.y)}
                                                          << 32U;
  h ^= std::uint64_t{static_cast<std::uint32_t>(p.z)} * 0x9E3779B97F4A7C15U;
  h = (h ^ (h >> 33U)) * 0xFF51AFD7ED558CCDU;
  h = (h ^ (h >> 33U)) * 0xC4CEB9FE1A85EC53U;
  return h ^ (h >> 33U);
}

}  // namespace

WeldedPoints weld(std::span<const glm::ivec3> points) {
  WeldedPoints welded;
  welded.index.reserve(points.size());
  // Open addressing, at most half full.
  const std::size_t slots = std::bit_ceil(2 * points.size() + 2);
  std::vector<std::uint32_t> table(slots, kFree);
  for (const glm::ivec3& p : points) {
    std::size_t slot = mix(p) & (slots - 1);
    while (table[slot] != kFree && welded.points[table[slot]] != p) slot = (slot + 1) & (slots - 1);
    if (table[slot] == kFree) {
      table[slot] = static_cast<std::uint32_t>(welded.points.size());
      welded.points.push_back(p);
    }
    welded.index.push_back(table[slot]);
  }
  return welded;
}

}  // namespace gridrt
