#include "host/grid/lattice.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "host/grid/two_sum.hpp"

namespace gridrt {
namespace {

/// Largest s with (hi - lo) 2^s <= limit, or nothing for a zero extent. Exact: the difference is
/// held as d + e, and `limit` is a double, so d 2^s and limit compare first and e only breaks a
/// tie.
std::optional<int> largest_scale(float lo, float hi, double limit) {
  const TwoSum d = two_diff(hi, lo);
  if (d.sum == 0.0) return std::nullopt;
  int s = std::ilogb(limit) - std::ilogb(d.sum) + 1;
  const auto fits = [&](int k) {
    const double scaled = std::ldexp(d.sum, k);
    return scaled < limit || (scaled == limit && d.error <= 0.0);
  };
  while (!fits(s)) --s;
  return s;
}

/// floor((v - lo) 2^s + 1/2) for a finite v with 0 <= v - lo and a result below 2^52. The error
/// term of the difference is below half a unit in the last place of the sum, so it only matters
/// where the fraction is exactly one half.
int round_scaled(float v, float lo, int s) {
  const TwoSum d = two_diff(v, lo);
  const double x = std::ldexp(d.sum, s);
  const double n = std::floor(x);
  const double fraction = x - n;
  const bool up = fraction > 0.5 || (fraction == 0.5 && d.error >= 0.0);
  return static_cast<int>(n) + (up ? 1 : 0);
}

}  // namespace

Result<Lattice> make_lattice(std::span<const glm::vec3> positions,
                             std::span<const std::array<std::uint32_t, 3>> triangles, int bits) {
  if (bits < kMinBits || bits > kMaxBits) {
    return fail(ErrorKind::kUsage, fmt::format("{} lattice bits asked for", bits),
                fmt::format("choose between {} and {}", kMinBits, kMaxBits));
  }
  Lattice lattice;
  lattice.bits = bits;
  if (triangles.empty()) return lattice;

  glm::vec3 lo{std::numeric_limits<float>::max()};
  glm::vec3 hi{std::numeric_limits<float>::lowest()};
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    for (const std::uint32_t index : triangles[i]) {
      if (index >= positions.size()) {
        return fail(ErrorKind::kInput, fmt::format("triangle {} refers to vertex {} of {}", i,
                                                   index, positions.size()));
      }
      const glm::vec3& p = positions[index];
      for (int a = 0; a < 3; ++a) {
        if (!std::isfinite(p[a])) {
          return fail(ErrorKind::kInput,
                      fmt::format("vertex {} of triangle {} is not finite", index, i));
        }
        lo[a] = std::min(lo[a], p[a]);
        hi[a] = std::max(hi[a], p[a]);
      }
    }
  }
  const double limit = std::ldexp(1.0, bits) - 5.0;
  std::array<std::optional<int>, 3> scale;
  std::optional<int> largest;
  for (int a = 0; a < 3; ++a) {
    scale[static_cast<std::size_t>(a)] = largest_scale(lo[a], hi[a], limit);
    largest = std::max(largest, scale[static_cast<std::size_t>(a)]);
  }
  for (int a = 0; a < 3; ++a) {
    // -0 and +0 are one number; keep one of them so that equal scenes have equal images.
    lattice.lo[a] = lo[a] + 0.0F;
    lattice.hi[a] = hi[a] + 0.0F;
    lattice.scale[a] = scale[static_cast<std::size_t>(a)].value_or(largest.value_or(0));
    lattice.max_q[a] = 2 + round_scaled(hi[a], lo[a], lattice.scale[a]);
  }
  return lattice;
}

glm::ivec3 snap(const Lattice& lattice, const glm::vec3& v) {
  glm::ivec3 q;
  for (int a = 0; a < 3; ++a) q[a] = 2 + round_scaled(v[a], lattice.lo[a], lattice.scale[a]);
  return q;
}

std::vector<glm::ivec3> snap_all(const Lattice& lattice, std::span<const glm::vec3> positions) {
  std::vector<glm::ivec3> snapped(positions.size(), glm::ivec3{0});
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const glm::vec3& v = positions[i];
    const bool inside = v.x >= lattice.lo.x && v.x <= lattice.hi.x && v.y >= lattice.lo.y &&
                        v.y <= lattice.hi.y && v.z >= lattice.lo.z && v.z <= lattice.hi.z;
    if (inside) snapped[i] = snap(lattice, v);
  }
  return snapped;
}

bool is_degenerate(const LatticeTriangle& triangle) {
  const glm::i64vec3 a{triangle.v[1] - triangle.v[0]};
  const glm::i64vec3 b{triangle.v[2] - triangle.v[0]};
  return a.y * b.z == a.z * b.y && a.z * b.x == a.x * b.z && a.x * b.y == a.y * b.x;
}

}  // namespace gridrt
