#include "tests/truth/numbers.hpp"

#include <cmath>
#include <limits>

namespace gridrt::truth {

Rational power_of_two(int k) {
  Rational r(1);
  if (k >= 0) {
    mpq_mul_2exp(r.get_mpq_t(), r.get_mpq_t(), static_cast<mp_bitcnt_t>(k));
  } else {
    mpq_div_2exp(r.get_mpq_t(), r.get_mpq_t(), static_cast<mp_bitcnt_t>(-k));
  }
  return r;
}

Integer floor_of(const Rational& x) {
  Integer q;
  mpz_fdiv_q(q.get_mpz_t(), x.get_num_mpz_t(), x.get_den_mpz_t());
  return q;
}

Integer nearest(const Rational& x) { return floor_of(x + Rational(1, 2)); }

Rational rational(Wide x) {
  const bool negative = x < 0;
  const Wide size = negative ? -x : x;
  Integer n(static_cast<unsigned long>(size >> 64));
  n <<= 64;
  n += static_cast<unsigned long>(size & ~0UL);
  if (negative) n = -n;
  return Rational(n);
}

bool close(double reported, const Rational& exact, double bound) {
  if (std::isnan(reported)) return false;
  if (std::isinf(reported)) return exact > Rational(std::numeric_limits<double>::max());
  // get_d truncates, by less than 2^-52 of a normal value; so most cases are settled at once.
  const double near = exact.get_d();
  if (std::isnormal(near) && std::abs(near) < 0x1p1000 &&
      std::abs(reported - near) <= (bound - 0x1p-50) * std::abs(near)) {
    return true;
  }
  const Rational difference = abs(Rational(reported) - exact);
  if (difference <= Rational(bound) * abs(exact)) return true;
  return abs(exact) < Rational(std::numeric_limits<double>::min()) &&
         difference <= Rational(std::numeric_limits<double>::denorm_min());
}

}  // namespace gridrt::truth
