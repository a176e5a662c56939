// Random numbers that are the same with every standard library.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>
#include <random>

#include <glm/vec3.hpp>

namespace gridrt::adversarial {

/// A seeded source of numbers; all of the tests' scenes and rays come from it.
class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed * 0x9E3779B97F4A7C15ULL + 1) {}

  /// Uniform in [0, n), n >= 1.
  std::uint64_t below(std::uint64_t n) { return engine_() % n; }
  /// Uniform in [lo, hi].
  int between(int lo, int hi) {
    return lo + static_cast<int>(below(static_cast<std::uint64_t>(std::int64_t{hi} - lo + 1)));
  }
  /// Uniform in [0, 1), 53 bits.
  double unit() { return static_cast<double>(engine_() >> 11) * 0x1p-53; }
  double uniform(double lo, double hi) { return lo + (hi - lo) * unit(); }
  bool chance(double p) { return unit() < p; }

  /// Uniform in the box [lo, hi].
  glm::dvec3 in_box(const glm::dvec3& lo, const glm::dvec3& hi) {
    const double x = uniform(lo.x, hi.x);
    const double y = uniform(lo.y, hi.y);
    return {x, y, uniform(lo.z, hi.z)};
  }
  /// A direction, uniform on the sphere.
  glm::dvec3 direction() {
    for (;;) {
      const glm::dvec3 d = in_box(glm::dvec3{-1.0}, glm::dvec3{1.0});
      const double l = d.x * d.x + d.y * d.y + d.z * d.z;
      if (l > 0.01 && l < 1.0) return d / std::sqrt(l);
    }
  }
  /// Any finite double with a binary exponent in [lo, hi], either sign.
  double scaled(int lo, int hi) {
    const double mantissa = uniform(1.0, 2.0);
    return std::ldexp(chance(0.5) ? mantissa : -mantissa, between(lo, hi));
  }

 private:
  std::mt19937_64 engine_;
};

}  // namespace gridrt::adversarial
