#include "host/grid/segment.hpp"

#include <array>
#include <cmath>

#include <fmt/format.h>

#include "host/grid/bounded.hpp"
#include "host/grid/segment_cut.hpp"

namespace gridrt {
namespace detail {
namespace {

/// Magnitudes for which no product or quotient of the filter comes near under- or overflow.
bool is_moderate(double x) { return x == 0.0 || (std::abs(x) > 0x1p-200 && std::abs(x) < 0x1p200); }

constexpr Cut kUndecided{};
constexpr Cut kMiss{Cut::Outcome::kMiss, glm::ivec3{0}, glm::ivec3{0}, 0.0, 0.0};

/// One end of the ray: its parameter, and the axis whose face sets it (-1: tmin or tmax does).
struct End {
  Bounded t;
  int axis = -1;
  double face = 0.0;
};

/// Coordinates relative to the lattice origin (the box is [-2, max q]).
struct ScaledRay {
  std::array<Bounded, 3> origin;
  std::array<double, 3> direction{};
};

/// The lattice point of one end; false where a rounding is undecided.
bool round_end(const ScaledRay& ray, const End& end, glm::ivec3& point) {
  for (int a = 0; a < 3; ++a) {
    const auto i = static_cast<std::size_t>(a);
    if (a == end.axis) {
      point[a] = 2 + static_cast<int>(end.face);
      continue;
    }
    const Bounded x = ray.direction[i] == 0.0 ? ray.origin[i]
                                              : add_product(ray.origin[i], end.t, ray.direction[i]);
    const std::optional<int> n = round_half_up(x);
    if (!n) return false;
    point[a] = 2 + *n;
  }
  return true;
}

/// The parameter must be good to 1e-13 for the reported t.
bool is_accurate(const Bounded& t) { return t.error <= 0x1p-50 * std::abs(t.hi); }

}  // namespace

Cut cut_filtered(const Lattice& lattice, const Ray& ray) {
  ScaledRay scaled;
  for (int a = 0; a < 3; ++a) {
    const auto i = static_cast<std::size_t>(a);
    if (!is_moderate(ray.origin[a]) || !is_moderate(ray.direction[a])) return kUndecided;
    const TwoSum offset = two_diff(ray.origin[a], lattice.lo[a]);
    const double step = power_of_two(lattice.scale[a]);
    scaled.origin[i] = {offset.sum * step, offset.error * step, 0.0};
    scaled.direction[i] = ray.direction[a] * step;
  }
  if (!is_moderate(ray.tmin) || (std::isfinite(ray.tmax) && !is_moderate(ray.tmax))) {
    return kUndecided;
  }
  End near{{ray.tmin, 0.0, 0.0}, -1, 0.0};
  End far{{ray.tmax, 0.0, 0.0}, -1, 0.0};
  bool bounded = std::isfinite(ray.tmax);
  for (int a = 0; a < 3; ++a) {
    const auto i = static_cast<std::size_t>(a);
    const double low = -2.0;
    const double high = lattice.max_q[a];
    const double d = scaled.direction[i];
    if (d == 0.0) {
      const std::optional<int> below = compare(scaled.origin[i], {low, 0.0, 0.0});
      const std::optional<int> above = compare(scaled.origin[i], {high, 0.0, 0.0});
      if (!below || !above) return kUndecided;
      if (*below < 0 || *above > 0) return kMiss;
      continue;
    }
    const double enter_face = d > 0.0 ? low : high;
    const double leave_face = d > 0.0 ? high : low;
    const Bounded enter = divide(subtract_from(enter_face, scaled.origin[i]), d);
    const Bounded leave = divide(subtract_from(leave_face, scaled.origin[i]), d);
    const std::optional<int> later = compare(enter, near.t);
    if (!later) return kUndecided;
    if (*later > 0) near = {enter, a, enter_face};
    const std::optional<int> earlier = bounded ? compare(leave, far.t) : -1;
    if (!earlier) return kUndecided;
    if (*earlier < 0) far = {leave, a, leave_face};
    bounded = true;
  }
  const std::optional<int> order = compare(far.t, near.t);
  if (!order) return kUndecided;
  if (*order < 0) return kMiss;
  if (!is_accurate(near.t) || !is_accurate(far.t)) return kUndecided;
  Cut cut{Cut::Outcome::kCut, glm::ivec3{0}, glm::ivec3{0}, near.t.hi, far.t.hi};
  if (!round_end(scaled, near, cut.p0) || !round_end(scaled, far, cut.p1)) return kUndecided;
  return cut;
}

Cut cut(const Lattice& lattice, const Ray& ray) {
  Cut result = cut_filtered(lattice, ray);
  if (result.outcome == Cut::Outcome::kUndecided) result = cut_exact(lattice, ray);
  return result;
}

}  // namespace detail

Result<void> validate(const Ray& ray) {
  constexpr std::array<char, 3> kAxes{'x', 'y', 'z'};
  for (int a = 0; a < 3; ++a) {
    const char axis = kAxes[static_cast<std::size_t>(a)];
    if (!std::isfinite(ray.origin[a])) {
      return fail(ErrorKind::kInput, fmt::format("origin {} is {}", axis, ray.origin[a]),
                  "use finite numbers");
    }
    if (!std::isfinite(ray.direction[a])) {
      return fail(ErrorKind::kInput, fmt::format("direction {} is {}", axis, ray.direction[a]),
                  "use finite numbers");
    }
  }
  if (ray.direction.x == 0.0 && ray.direction.y == 0.0 && ray.direction.z == 0.0) {
    return fail(ErrorKind::kInput, "the direction is zero", "give a direction of any length but 0");
  }
  if (!std::isfinite(ray.tmin) || ray.tmin < 0.0) {
    return fail(ErrorKind::kInput, fmt::format("tmin is {}", ray.tmin), "tmin is finite and >= 0");
  }
  if (!(ray.tmax >= ray.tmin)) {
    return fail(ErrorKind::kInput, fmt::format("tmax is {} with tmin {}", ray.tmax, ray.tmin),
                "tmax is not below tmin; infinity is allowed");
  }
  return {};
}

Segment make_segment(const Lattice& lattice, const Ray& ray) {
  const detail::Cut c = detail::cut(lattice, ray);
  if (c.outcome != detail::Cut::Outcome::kCut) return {};
  return {c.p0, c.p1, c.t0, c.t1, kNoTriangle};
}

}  // namespace gridrt
