// From a ray in scene units to a segment on the lattice, in rationals.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <optional>

#include "tests/truth/lattice.hpp"

namespace gridrt::truth {

/// O + t D for t in [tmin, tmax]; D not 0, all finite but tmax, 0 <= tmin <= tmax.
struct Ray {
  std::array<double, 3> origin{};
  std::array<double, 3> direction{0, 0, 1};
  double tmin = 0.0;
  double tmax = std::numeric_limits<double>::infinity();
};

inline constexpr std::int64_t kNone = -1;

/// A ray on the lattice, or nothing of it.
struct Segment {
  bool meets_box = false;  ///< false: a miss, and the rest means nothing
  Point p0{};
  Point p1{};
  Rational t0;
  Rational t1;
  std::int64_t ignore = kNone;  ///< id of a triangle that is never hit

  [[nodiscard]] bool miss() const { return !meets_box || p0 == p1; }
};

/// Cuts to the closed box and rounds both end points to nearest.
Segment cut(const Lattice& lattice, const Ray& ray);

/// The start of a ray that leaves `triangle` at the point where `incoming` (its end points) hit
/// it: rounded to nearest, then moved until strictly on the side that `direction` points to.
/// Nothing if it leaves the box. Among equal largest normal components the first axis is taken.
std::optional<Point> secondary_start(const Lattice& lattice, const Point& p0, const Point& p1,
                                     const Triangle& triangle,
                                     const std::array<double, 3>& direction);

/// Where it ends: `end`, moved as the start is where it lies on the plane of `triangle` or behind
/// it, but not out of the box.
Point secondary_end(const Lattice& lattice, const Point& end, const Triangle& triangle,
                    const std::array<double, 3>& direction);

}  // namespace gridrt::truth
