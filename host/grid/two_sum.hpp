// Sums of doubles without error: a rounded sum and what the rounding lost.
#pragma once

namespace gridrt {

/// sum + error is the exact value; |error| <= half a unit in the last place of sum.
struct TwoSum {
  double sum;
  double error;
};

/// Knuth's two-sum ("The Art of Computer Programming", vol. 2, 4.2.2): exact unless it overflows.
inline TwoSum two_sum(double a, double b) {
  const double s = a + b;
  const double bb = s - a;
  return {s, (a - (s - bb)) + (b - bb)};
}

/// The exact difference a - b.
inline TwoSum two_diff(double a, double b) { return two_sum(a, -b); }

}  // namespace gridrt
