// A segment against a triangle by signed volumes of tetrahedra, in exact integers.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "tests/truth/lattice.hpp"

namespace gridrt::truth {

/// Where a segment crosses a triangle: volumes, none negative. `before` : `after` divides the
/// segment; weight_a : weight_b : weight_c are the barycentric weights of the vertices.
/// before + after = weight_a + weight_b + weight_c > 0.
struct Meeting {
  Wide before = 0;
  Wide after = 0;
  Wide weight_a = 0;
  Wide weight_b = 0;
  Wide weight_c = 0;

  /// floor(2^24 before / (before + after)).
  [[nodiscard]] std::uint32_t quotient() const {
    return static_cast<std::uint32_t>((before << 24) / (before + after));
  }
};

/// The closed segment p0 p1 against the closed triangle; nothing if they do not meet, lie in one
/// plane, or the triangle has no area.
std::optional<Meeting> meet(const Point& p0, const Point& p1, const Triangle& triangle);

/// (b - a) x (c - a).
std::array<Wide, 3> normal_of(const Triangle& triangle);

}  // namespace gridrt::truth
