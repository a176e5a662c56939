#include "tests/truth/given.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "tests/truth/numbers.hpp"

namespace gridrt::truth {
namespace {

using Vector = std::array<double, 3>;

/// A number and a bound on its absolute error.
struct Approximate {
  double value;
  double error;
};

constexpr double kRounding = 0x1p-52;  // twice the half unit, for the bounds' own roundings

Approximate difference(double a, double b) {
  return {a - b, kRounding * (std::abs(a) + std::abs(b))};
}

Approximate operator-(const Approximate& a, const Approximate& b) {
  return {a.value - b.value,
          a.error + b.error + kRounding * (std::abs(a.value) + std::abs(b.value))};
}

Approximate operator+(const Approximate& a, const Approximate& b) {
  return {a.value + b.value,
          a.error + b.error + kRounding * (std::abs(a.value) + std::abs(b.value))};
}

Approximate operator*(const Approximate& a, const Approximate& b) {
  const double size = std::abs(a.value * b.value);
  return {a.value * b.value,
          1.0001 * (std::abs(a.value) * b.error + std::abs(b.value) * a.error + a.error * b.error) +
              kRounding * size};
}

Rational exact_difference(double a, double b) { return Rational(a) - Rational(b); }

Approximate take(double a, double b, const Approximate*) { return difference(a, b); }
Rational take(double a, double b, const Rational*) { return exact_difference(a, b); }

/// Volumes of the ray and the edges, all six times, and that of the ray's length to the plane.
template <class Number>
struct Volumes {
  std::array<Number, 3> side;  // opposite to each vertex
  Number det;                  // their sum
  Number before;               // t = before / det
};

/// u_k = D . (A_k x B_k), the edges seen from the origin (as Pluecker coordinates do).
template <class Number>
Volumes<Number> volumes(const Ray& ray, const std::array<Vector, 3>& v) {
  std::array<std::array<Number, 3>, 3> from;
  std::array<Number, 3> d;
  constexpr const Number* kKind = nullptr;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t k = 0; k < 3; ++k) from[k][i] = take(v[k][i], ray.origin[i], kKind);
    d[i] = take(ray.direction[i], 0.0, kKind);
  }
  const auto cross = [](const std::array<Number, 3>& a, const std::array<Number, 3>& b) {
    return std::array<Number, 3>{Number(a[1] * b[2] - a[2] * b[1]),
                                 Number(a[2] * b[0] - a[0] * b[2]),
                                 Number(a[0] * b[1] - a[1] * b[0])};
  };
  const auto dot = [](const std::array<Number, 3>& a, const std::array<Number, 3>& b) {
    return Number(a[0] * b[0] + a[1] * b[1] + a[2] * b[2]);
  };
  const auto bc = cross(from[1], from[2]);
  Volumes<Number> out;
  out.side = {dot(d, bc), dot(d, cross(from[2], from[0])), dot(d, cross(from[0], from[1]))};
  out.det = Number(out.side[0] + out.side[1] + out.side[2]);
  out.before = dot(from[0], bc);
  return out;
}

/// False only if the ray surely misses.
bool may_meet(const Ray& ray, const std::array<Vector, 3>& v) {
  const auto all = volumes<Approximate>(ray, v);
  bool positive = false;
  bool negative = false;
  for (const Approximate& side : all.side) {
    positive |= side.value > side.error;
    negative |= side.value < -side.error;
  }
  return !(positive && negative);
}

std::optional<Rational> meet_exactly(const Ray& ray, const std::array<Vector, 3>& v) {
  const auto all = volumes<Rational>(ray, v);
  const int sign = sgn(all.det);
  if (sign == 0) return std::nullopt;
  for (const Rational& side : all.side) {
    if (sgn(side) * sign < 0) return std::nullopt;
  }
  Rational t = all.before / all.det;
  if (t < Rational(ray.tmin)) return std::nullopt;
  if (std::isfinite(ray.tmax) && t > Rational(ray.tmax)) return std::nullopt;
  return t;
}

}  // namespace

GivenTracer::GivenTracer(const Scene& scene, Search search) {
  std::vector<FloatBox> boxes;
  for (const auto& triangle : scene.triangles) {
    Corners& corners = triangles_.emplace_back();
    for (std::size_t k = 0; k < 3; ++k) {
      const glm::vec3& p = scene.positions[triangle[k]];
      corners.v[k] = {p.x, p.y, p.z};
    }
    FloatBox& box = boxes.emplace_back(FloatBox{corners.v[0], corners.v[0]});
    for (std::size_t a = 0; a < 3; ++a) {
      box.lo[a] = std::min({corners.v[0][a], corners.v[1][a], corners.v[2][a]});
      box.hi[a] = std::max({corners.v[0][a], corners.v[1][a], corners.v[2][a]});
    }
  }
  if (search == Search::kPruned) tree_.emplace(boxes);
}

std::vector<std::int64_t> GivenTracer::closest(const Ray& ray) const {
  std::vector<std::int64_t> ids;
  Rational best;
  const auto test = [&](std::size_t id) {
    if (!may_meet(ray, triangles_[id].v)) return;
    const std::optional<Rational> t = meet_exactly(ray, triangles_[id].v);
    if (!t || (!ids.empty() && *t > best)) return;
    if (ids.empty() || *t < best) {
      ids.clear();
      best = *t;
    }
    ids.push_back(static_cast<std::int64_t>(id));
  };
  if (tree_) {
    tree_->each(ray, test);
    std::ranges::sort(ids);
  } else {
    for (std::size_t id = 0; id < triangles_.size(); ++id) test(id);
  }
  return ids;
}

}  // namespace gridrt::truth
