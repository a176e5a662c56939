// Double-double numbers that carry an absolute error bound: the filter in front of rationals.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>
#include <optional>

#include "host/grid/two_sum.hpp"

namespace gridrt::detail {

/// The true value lies within `error` of hi + lo; |lo| <= 2^-52 |hi|.
struct Bounded {
  double hi = 0.0;
  double lo = 0.0;
  double error = 0.0;
};

/// 2^k; a lattice's scale is far within (-1022, 1023), and so are products of moderate numbers
/// with it: exact, and much faster than ldexp.
inline double power_of_two(int k) {
  return std::bit_cast<double>(static_cast<std::uint64_t>(1023 + k) << 52);
}

/// One double-double operation is wrong by at most a few 2^-104 of its result (Dekker, "A
/// floating-point technique for extending the available precision", 1971); 2^-98 leaves room for
/// the rounding of the bounds themselves.
inline constexpr double kRelativeError = 0x1p-98;

inline Bounded renormalized(double hi, double lo, double error) {
  const TwoSum s = two_sum(hi, lo);
  return {s.sum, s.error, error};
}

/// bound - x for a small integer `bound`.
inline Bounded subtract_from(double bound, const Bounded& x) {
  const TwoSum s = two_diff(bound, x.hi);
  // The low parts are added with one rounding: 2^-53 of at most 2^-52 (|hi| + |bound|).
  const double error = x.error + kRelativeError * (std::abs(x.hi) + std::abs(bound));
  return renormalized(s.sum, s.error - x.lo, error);
}

/// x / d for an exact d.
inline Bounded divide(const Bounded& x, double d) {
  const double q = x.hi / d;
  const double remainder = std::fma(-q, d, x.hi) + x.lo;
  const double error = 1.0000001 * (x.error / std::abs(d)) + kRelativeError * std::abs(q);
  return renormalized(q, remainder / d, error);
}

/// x + t d for an exact d.
inline Bounded add_product(const Bounded& x, const Bounded& t, double d) {
  const double p = t.hi * d;
  const double p_low = std::fma(t.hi, d, -p) + t.lo * d;
  const TwoSum s = two_sum(x.hi, p);
  const double error = 1.0000001 * (x.error + t.error * std::abs(d)) +
                       kRelativeError * (std::abs(x.hi) + std::abs(p));
  return renormalized(s.sum, s.error + (x.lo + p_low), error);
}

/// Sign of a - b, or nothing where the bounds do not decide (equal values included).
inline std::optional<int> compare(const Bounded& a, const Bounded& b) {
  const double difference = (a.hi - b.hi) + (a.lo - b.lo);
  // The difference itself is rounded: at most 2^-50 of it, or of the low parts when the high parts
  // cancel.
  const double slack = 1.0000001 * (a.error + b.error) + 0x1p-50 * std::abs(difference) +
                       0x1p-100 * (std::abs(a.hi) + std::abs(b.hi));
  if (difference > slack) return 1;
  if (difference < -slack) return -1;
  return std::nullopt;
}

/// floor(x + 1/2) for |x| < 2^31, or nothing where the bound does not decide.
inline std::optional<int> round_half_up(const Bounded& x) {
  const double n = std::floor(x.hi);
  const double above_half = ((x.hi - n) - 0.5) + x.lo;
  if (x.error != 0.0 && std::abs(above_half) <= 1.0000001 * x.error + 0x1p-100) return std::nullopt;
  return static_cast<int>(n) + (above_half >= 0.0 ? 1 : 0);
}

}  // namespace gridrt::detail
