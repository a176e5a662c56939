#include "tests/truth/segment.hpp"

#include <cmath>

#include "tests/truth/volumes.hpp"

namespace gridrt::truth {

Segment cut(const Lattice& lattice, const Ray& ray) {
  Segment out;
  Rational first(ray.tmin);
  Rational last;
  bool bounded = std::isfinite(ray.tmax);
  if (bounded) last = Rational(ray.tmax);

  std::array<Rational, 3> start;
  std::array<Rational, 3> slope;
  for (std::size_t i = 0; i < 3; ++i) {
    start[i] = lattice.place(static_cast<int>(i), Rational(ray.origin[i]));
    slope[i] = Rational(ray.direction[i]) * lattice.step[i];
    if (slope[i] == 0) {
      if (start[i] < 0 || start[i] > lattice.far[i]) return out;
      continue;
    }
    Rational enter = -start[i] / slope[i];
    Rational leave = (lattice.far[i] - start[i]) / slope[i];
    if (slope[i] < 0) std::swap(enter, leave);
    if (enter > first) first = enter;
    if (!bounded || leave < last) last = leave;
    bounded = true;
  }
  if (first > last) return out;
  for (std::size_t i = 0; i < 3; ++i) {
    out.p0[i] = static_cast<std::int32_t>(nearest(start[i] + first * slope[i]).get_si());
    out.p1[i] = static_cast<std::int32_t>(nearest(start[i] + last * slope[i]).get_si());
  }
  out.meets_box = true;
  out.t0 = first;
  out.t1 = last;
  return out;
}

namespace {

/// Steps `at` along the normal's largest axis until it is strictly on the side that `direction`
/// points to; false, at the last point within the box, if the box ends first.
bool climb(const Lattice& lattice, const Triangle& triangle, const std::array<double, 3>& direction,
           Point& at) {
  const std::array<Wide, 3> normal = normal_of(triangle);
  Rational facing = 0;
  std::size_t axis = 0;
  const auto size = [](Wide x) { return x < 0 ? -x : x; };
  for (std::size_t i = 0; i < 3; ++i) {
    facing += rational(normal[i]) * Rational(direction[i]) * lattice.step[i];
    if (size(normal[i]) > size(normal[axis])) axis = i;
  }
  if (facing == 0) return true;
  const int side = facing > 0 ? 1 : -1;
  const std::int32_t step = (normal[axis] > 0) == (facing > 0) ? 1 : -1;
  const auto height = [&] {  // side n.(at - a), to become positive
    Wide sum = 0;
    for (std::size_t i = 0; i < 3; ++i) sum += normal[i] * (at[i] - triangle.a[i]);
    return side * sum;
  };
  while (height() <= 0) {
    const std::int32_t next = at[axis] + step;
    if (next < 0 || next > lattice.far[axis]) return false;
    at[axis] = next;
  }
  return true;
}

}  // namespace

std::optional<Point> secondary_start(const Lattice& lattice, const Point& p0, const Point& p1,
                                     const Triangle& triangle,
                                     const std::array<double, 3>& direction) {
  const auto meeting = meet(p0, p1, triangle);
  if (!meeting) return std::nullopt;
  const Rational along = rational(meeting->before) / rational(meeting->before + meeting->after);
  Point at{};
  for (std::size_t i = 0; i < 3; ++i) {
    at[i] = static_cast<std::int32_t>(nearest(p0[i] + along * (p1[i] - p0[i])).get_si());
  }

  if (!climb(lattice, triangle, direction, at)) return std::nullopt;
  return at;
}

Point secondary_end(const Lattice& lattice, const Point& end, const Triangle& triangle,
                    const std::array<double, 3>& direction) {
  Point at = end;
  climb(lattice, triangle, direction, at);
  return at;
}

}  // namespace gridrt::truth
