#include "host/grid/box_entry.hpp"

#include <algorithm>

#include "host/grid/traversal.hpp"

namespace gridrt {

std::optional<std::uint32_t> entry_quotient(const glm::ivec3& p0, const glm::ivec3& p1,
                                            const glm::ivec3& lo, const glm::ivec3& hi) {
  Fraction enter{0, 1};
  Fraction leave{1, 1};
  for (int a = 0; a < 3; ++a) {
    const std::int64_t d = std::int64_t{p1[a]} - p0[a];
    if (d == 0) {
      if (p0[a] < lo[a] || p0[a] > hi[a]) return std::nullopt;
      continue;
    }
    const std::int64_t den = d < 0 ? -d : d;
    const Fraction near{d > 0 ? std::int64_t{lo[a]} - p0[a] : std::int64_t{p0[a]} - hi[a], den};
    const Fraction far{d > 0 ? std::int64_t{hi[a]} - p0[a] : std::int64_t{p0[a]} - lo[a], den};
    if (enter < near) enter = near;
    if (far < leave) leave = far;
  }
  if (leave < enter) return std::nullopt;
  return enter.quotient();
}

}  // namespace gridrt
