// The definition itself, word for word, in rational arithmetic.
#include <cmath>
#include <optional>

#include <gmpxx.h>

#include "host/grid/segment_cut.hpp"

namespace gridrt::detail {
namespace {

mpq_class times_power_of_two(mpq_class x, int exponent) {
  if (exponent >= 0) {
    mpq_mul_2exp(x.get_mpq_t(), x.get_mpq_t(), static_cast<mp_bitcnt_t>(exponent));
  } else {
    mpq_div_2exp(x.get_mpq_t(), x.get_mpq_t(), static_cast<mp_bitcnt_t>(-exponent));
  }
  return x;
}

/// floor(x + 1/2) of a value within the lattice box.
int round_half_up(const mpq_class& x) {
  const mpz_class numerator = 2 * x.get_num() + x.get_den();
  const mpz_class denominator = 2 * x.get_den();
  mpz_class n;
  mpz_fdiv_q(n.get_mpz_t(), numerator.get_mpz_t(), denominator.get_mpz_t());
  return static_cast<int>(n.get_si());
}

double to_double(const mpq_class& x) {
  const double d = x.get_d();
  return std::isfinite(d) ? d : std::numeric_limits<double>::max();
}

}  // namespace

Cut cut_exact(const Lattice& lattice, const Ray& ray) {
  std::array<mpq_class, 3> origin;
  std::array<mpq_class, 3> direction;
  for (int a = 0; a < 3; ++a) {
    const auto i = static_cast<std::size_t>(a);
    const mpq_class offset = mpq_class(ray.origin[a]) - mpq_class(lattice.lo[a]);
    origin[i] = times_power_of_two(offset, lattice.scale[a]) + 2;
    direction[i] = times_power_of_two(mpq_class(ray.direction[a]), lattice.scale[a]);
  }
  mpq_class t0(ray.tmin);
  std::optional<mpq_class> t1;
  if (std::isfinite(ray.tmax)) t1 = mpq_class(ray.tmax);
  for (int a = 0; a < 3; ++a) {
    const auto i = static_cast<std::size_t>(a);
    const mpq_class far_face(lattice.box()[a]);
    if (direction[i] == 0) {
      if (origin[i] < 0 || origin[i] > far_face) return {Cut::Outcome::kMiss, {}, {}, 0.0, 0.0};
      continue;
    }
    mpq_class enter = -origin[i] / direction[i];
    mpq_class leave = (far_face - origin[i]) / direction[i];
    if (leave < enter) std::swap(enter, leave);
    if (enter > t0) t0 = enter;
    if (!t1 || leave < *t1) t1 = leave;
  }
  // The direction is not zero, so some axis has set t1.
  if (!t1 || *t1 < t0) return {Cut::Outcome::kMiss, {}, {}, 0.0, 0.0};
  Cut cut;
  cut.outcome = Cut::Outcome::kCut;
  for (int a = 0; a < 3; ++a) {
    const auto i = static_cast<std::size_t>(a);
    cut.p0[a] = round_half_up(origin[i] + t0 * direction[i]);
    cut.p1[a] = round_half_up(origin[i] + *t1 * direction[i]);
  }
  cut.t0 = to_double(t0);
  cut.t1 = to_double(*t1);
  return cut;
}

}  // namespace gridrt::detail
