// The numbers of the truth: rationals without bound, and integers wide enough for every volume.
#pragma once

#include <array>
#include <cstdint>

#include <gmpxx.h>

namespace gridrt::truth {

using Rational = mpq_class;
using Integer = mpz_class;

/// Holds every volume of four lattice points at 24 bits: 6 |differences|^3 < 2^78.
__extension__ using Wide = __int128;

/// A lattice point.
using Point = std::array<std::int32_t, 3>;

/// 2^k, k of either sign.
Rational power_of_two(int k);

/// Largest integer not above x.
Integer floor_of(const Rational& x);

/// floor(x + 1/2).
Integer nearest(const Rational& x);

/// The same number as a rational.
Rational rational(Wide x);

/// |reported - exact| <= bound |exact|; a result too small for a normal double may be off by one
/// denormal step, one too large for a double must be infinite. NaN is never close.
bool close(double reported, const Rational& exact, double bound);

}  // namespace gridrt::truth
