// The exact test of a triangle that a filter could not rule out.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>

#include "host/grid/intersect.hpp"
#include "host/grid/intersect_narrow.hpp"
#include "host/pe/ray_lanes.hpp"

namespace gridrt {

/// floor(2^24 tn / det) for 0 <= tn <= det, 0 < det < 2^54: hit_quotient without a division of 128
/// bits.
inline std::uint32_t quotient_narrow(std::int64_t tn, std::int64_t det) {
  // The rounded quotient is off by less than one, so the remainder, taken modulo 2^64, tells by how
  // much.
  const double estimate = static_cast<double>(tn) / static_cast<double>(det) * 0x1p24;
  auto q = static_cast<std::int64_t>(estimate);
  const auto rest =
      static_cast<std::int64_t>((static_cast<std::uint64_t>(tn) << 24) -
                                static_cast<std::uint64_t>(q) * static_cast<std::uint64_t>(det));
  if (rest < 0) --q;
  if (rest >= det) ++q;
  return static_cast<std::uint32_t>(q);
}

/// The quotient of a hit, by the exact integers; nothing on a miss. `narrow`: every coordinate is
/// below 2^17. `d` is p1 - p0.
inline std::optional<std::uint32_t> exact_quotient(bool narrow, const glm::ivec3& p0,
                                                   const glm::ivec3& d, const EdgeTriangle& t) {
  if (narrow) {
    const std::optional<ExactHit> hit = intersect_narrow(p0, d, t);
    if (!hit) return std::nullopt;
    return quotient_narrow(static_cast<std::int64_t>(hit->tn), static_cast<std::int64_t>(hit->det));
  }
  const std::optional<ExactHit> hit =
      intersect_exact(p0, p0 + d, {{t.v0, t.v0 + t.e1, t.v0 + t.e2}});
  if (!hit) return std::nullopt;
  return hit_quotient(*hit);
}

/// The triangle whose 12 numbers are `lanes` apart from `row` on.
inline EdgeTriangle triangle_of(const float* row, std::size_t lanes) {
  EdgeTriangle t;
  for (int a = 0; a < 3; ++a) {
    t.v0[a] = static_cast<int>(row[0]);
    t.e1[a] = static_cast<int>(row[3 * lanes]);
    t.e2[a] = static_cast<int>(row[6 * lanes]);
    row += lanes;
  }
  return t;
}

/// Tests that triangle, and keeps its key if it is the smallest; true if it is.
inline bool settle(bool narrow, const float* row, std::size_t lanes, std::uint32_t id,
                   TestLane& test) {
  if (id == test.ray->ray.ignore) return false;
  const std::optional<std::uint32_t> q =
      exact_quotient(narrow, test.ray->ray.p0, test.d, triangle_of(row, lanes));
  if (!q || !(HitKey{*q, id} < test.best)) return false;
  test.best = {*q, id};
  // A smaller key has floor(2^24 tn / det) <= q.
  test.limit = std::min(1.0F, static_cast<float>(*q + 1) * 0x1p-24F);
  return true;
}

}  // namespace gridrt
