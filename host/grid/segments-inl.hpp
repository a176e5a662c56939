// The filter of segment.cpp, cut_filtered(), for as many rays as a vector has lanes: the same
// operations in the same order, so the same bits. Compiled for each kind of vectors.
#include <cmath>
#include <cstdint>

#include "host/grid/bounded.hpp"
#include "host/grid/segment.hpp"

#if defined(GRIDRT_SEGMENTS_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef GRIDRT_SEGMENTS_INL
#undef GRIDRT_SEGMENTS_INL
#else
#define GRIDRT_SEGMENTS_INL
#endif

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace gridrt::detail {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using Doubles = hn::CappedTag<double, 8>;
using Numbers = hn::Vec<Doubles>;
using Lanes = hn::Mask<Doubles>;

HWY_INLINE Numbers all(double x) { return hn::Set(Doubles{}, x); }

/// Bounded in every lane.
struct WideBounded {
  Numbers hi, lo, error;
};

/// TwoSum in every lane.
struct WideSum {
  Numbers sum, error;
};

HWY_INLINE WideSum wide_sum(const Numbers& a, const Numbers& b) {
  const Numbers s = hn::Add(a, b);
  const Numbers bb = hn::Sub(s, a);
  return {s, hn::Add(hn::Sub(a, hn::Sub(s, bb)), hn::Sub(b, bb))};
}

HWY_INLINE WideBounded choose(const Lanes& which, const WideBounded& yes, const WideBounded& no) {
  return {hn::IfThenElse(which, yes.hi, no.hi), hn::IfThenElse(which, yes.lo, no.lo),
          hn::IfThenElse(which, yes.error, no.error)};
}

HWY_INLINE WideBounded renormalized(const Numbers& hi, const Numbers& lo, const Numbers& error) {
  const WideSum s = wide_sum(hi, lo);
  return {s.sum, s.error, error};
}

HWY_INLINE WideBounded subtract_from(const Numbers& bound, const WideBounded& x) {
  const WideSum s = wide_sum(bound, hn::Neg(x.hi));
  const Numbers error =
      hn::Add(x.error, hn::Mul(all(kRelativeError), hn::Add(hn::Abs(x.hi), hn::Abs(bound))));
  return renormalized(s.sum, hn::Sub(s.error, x.lo), error);
}

HWY_INLINE WideBounded divide(const WideBounded& x, const Numbers& d) {
  const Numbers q = hn::Div(x.hi, d);
  const Numbers remainder = hn::Add(hn::NegMulAdd(q, d, x.hi), x.lo);
  const Numbers error = hn::Add(hn::Mul(all(1.0000001), hn::Div(x.error, hn::Abs(d))),
                                hn::Mul(all(kRelativeError), hn::Abs(q)));
  return renormalized(q, hn::Div(remainder, d), error);
}

HWY_INLINE WideBounded add_product(const WideBounded& x, const WideBounded& t, const Numbers& d) {
  const Numbers p = hn::Mul(t.hi, d);
  const Numbers p_low = hn::Add(hn::MulSub(t.hi, d, p), hn::Mul(t.lo, d));
  const WideSum s = wide_sum(x.hi, p);
  const Numbers error =
      hn::Add(hn::Mul(all(1.0000001), hn::Add(x.error, hn::Mul(t.error, hn::Abs(d)))),
              hn::Mul(all(kRelativeError), hn::Add(hn::Abs(x.hi), hn::Abs(p))));
  return renormalized(s.sum, hn::Add(s.error, hn::Add(x.lo, p_low)), error);
}

/// Sign of a - b where the bounds decide.
struct Compared {
  Lanes above, below;
};

HWY_INLINE Compared compare(const WideBounded& a, const WideBounded& b) {
  const Numbers difference = hn::Add(hn::Sub(a.hi, b.hi), hn::Sub(a.lo, b.lo));
  const Numbers slack = hn::Add(hn::Add(hn::Mul(all(1.0000001), hn::Add(a.error, b.error)),
                                        hn::Mul(all(0x1p-50), hn::Abs(difference))),
                                hn::Mul(all(0x1p-100), hn::Add(hn::Abs(a.hi), hn::Abs(b.hi))));
  return {hn::Gt(difference, slack), hn::Lt(difference, hn::Neg(slack))};
}

/// floor(x + 1/2) where the bound decides.
struct Rounded {
  Numbers value;
  Lanes open;
};

HWY_INLINE Rounded round_half_up(const WideBounded& x) {
  const Numbers n = hn::Floor(x.hi);
  const Numbers above_half = hn::Add(hn::Sub(hn::Sub(x.hi, n), all(0.5)), x.lo);
  const Numbers bound = hn::Add(hn::Mul(all(1.0000001), x.error), all(0x1p-100));
  const Lanes open = hn::And(hn::Ne(x.error, all(0.0)), hn::Le(hn::Abs(above_half), bound));
  const Numbers up = hn::IfThenElseZero(hn::Ge(above_half, all(0.0)), all(1.0));
  return {hn::Add(n, up), open};
}

HWY_INLINE Lanes moderate(const Numbers& x) {
  const Numbers size = hn::Abs(x);
  return hn::Or(hn::Eq(x, all(0.0)),
                hn::And(hn::Gt(size, all(0x1p-200)), hn::Lt(size, all(0x1p200))));
}

/// One end of each ray.
struct WideEnd {
  WideBounded t;
  Numbers axis;  ///< whose face sets it, -1: none
  Numbers face;
};

/// What a vector of rays comes to: lanes neither `miss` nor `open` have a segment.
struct WideCut {
  Lanes open, miss;
  Numbers p0[3], p1[3];
  Numbers t0, t1;
};

/// `rays`: as many as a vector has lanes.
HWY_INLINE WideCut cut_rays(const Lattice& lattice, const Ray* rays) {
  const Doubles f;
  static_assert(sizeof(Ray) == 8 * sizeof(double));
  const hn::RebindToSigned<Doubles> n;
  const auto place = hn::ShiftLeft<3>(hn::Iota(n, 0));
  const auto* const numbers = reinterpret_cast<const double*>(rays);
  const auto field = [&](int i) { return hn::GatherIndex(f, numbers + i, place); };
  const Numbers zero = hn::Zero(f);
  WideBounded origin[3];
  Numbers d[3];
  Lanes open = hn::Ne(zero, zero);
  for (int a = 0; a < 3; ++a) {
    const Numbers o = field(a);
    const Numbers w = field(3 + a);
    open = hn::Or(open, hn::Not(hn::And(moderate(o), moderate(w))));
    const Numbers step = all(power_of_two(lattice.scale[a]));
    const WideSum offset = wide_sum(o, all(-static_cast<double>(lattice.lo[a])));
    origin[a] = {hn::Mul(offset.sum, step), hn::Mul(offset.error, step), zero};
    d[a] = hn::Mul(w, step);
  }
  const Numbers tmin = field(6);
  const Numbers tmax = field(7);
  Lanes bounded = hn::Lt(tmax, all(std::numeric_limits<double>::infinity()));
  open = hn::Or(open, hn::Not(moderate(tmin)));
  open = hn::Or(open, hn::AndNot(moderate(tmax), bounded));
  WideEnd near{{tmin, zero, zero}, all(-1.0), zero};
  // Where nothing bounds the far end yet, any leave is earlier.
  WideEnd far{{hn::IfThenElseZero(bounded, tmax), zero, zero}, all(-1.0), zero};
  Lanes miss = hn::Ne(zero, zero);
  const auto close = [&](const Lanes& undecided) {
    open = hn::Or(open, hn::AndNot(miss, undecided));
  };
  const auto fail = [&](const Lanes& missed) { miss = hn::Or(miss, hn::AndNot(open, missed)); };
  for (int a = 0; a < 3; ++a) {
    const Numbers low = all(-2.0);
    const Numbers high = all(lattice.max_q[a]);
    const Lanes flat = hn::Eq(d[a], zero);
    const Compared below = compare(origin[a], {low, zero, zero});
    const Compared above = compare(origin[a], {high, zero, zero});
    close(hn::And(flat, hn::Not(hn::And(hn::Or(below.above, below.below),
                                        hn::Or(above.above, above.below)))));
    fail(hn::And(flat, hn::Or(below.below, above.above)));
    const Lanes forward = hn::Gt(d[a], zero);
    const Numbers enter_face = hn::IfThenElse(forward, low, high);
    const Numbers leave_face = hn::IfThenElse(forward, high, low);
    const Numbers by = hn::IfThenElse(flat, all(1.0), d[a]);
    const WideBounded enter = divide(subtract_from(enter_face, origin[a]), by);
    const WideBounded leave = divide(subtract_from(leave_face, origin[a]), by);
    const Compared later = compare(enter, near.t);
    close(hn::Not(hn::Or(flat, hn::Or(later.above, later.below))));
    const Lanes sets_near = hn::AndNot(flat, later.above);
    near.t = choose(sets_near, enter, near.t);
    near.axis = hn::IfThenElse(sets_near, all(a), near.axis);
    near.face = hn::IfThenElse(sets_near, enter_face, near.face);
    const Compared earlier = compare(leave, far.t);
    close(hn::And(bounded, hn::Not(hn::Or(flat, hn::Or(earlier.above, earlier.below)))));
    const Lanes sets_far = hn::AndNot(flat, hn::Or(hn::Not(bounded), earlier.below));
    far.t = choose(sets_far, leave, far.t);
    far.axis = hn::IfThenElse(sets_far, all(a), far.axis);
    far.face = hn::IfThenElse(sets_far, leave_face, far.face);
    bounded = hn::Or(bounded, hn::Not(flat));
  }
  const Compared order = compare(far.t, near.t);
  close(hn::Not(hn::Or(order.above, order.below)));
  fail(order.below);
  const auto inaccurate = [](const WideBounded& t) {
    return hn::Gt(t.error, hn::Mul(all(0x1p-50), hn::Abs(t.hi)));
  };
  close(hn::Or(inaccurate(near.t), inaccurate(far.t)));
  WideCut cut;
  cut.t0 = near.t.hi;
  cut.t1 = far.t.hi;
  const auto round_end = [&](const WideEnd& end, Numbers* point) {
    for (int a = 0; a < 3; ++a) {
      const Lanes on_face = hn::Eq(end.axis, all(a));
      const Lanes flat = hn::Eq(d[a], zero);
      const Rounded x = round_half_up(choose(flat, origin[a], add_product(origin[a], end.t, d[a])));
      close(hn::AndNot(on_face, x.open));
      point[a] = hn::Add(hn::IfThenElse(on_face, end.face, x.value), all(2.0));
    }
  };
  round_end(near, cut.p0);
  round_end(far, cut.p1);
  cut.open = open;
  cut.miss = miss;
  return cut;
}

}  // namespace HWY_NAMESPACE
}  // namespace gridrt::detail
HWY_AFTER_NAMESPACE();

#endif
