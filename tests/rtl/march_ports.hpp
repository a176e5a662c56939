// The model's structures as the RTL's packed structs: grid_t, start_t (gridrt_state_pkg) and
// bundle_t (gridrt_pkg), field by field from bit 0.
#pragma once

#include <cstdint>
#include <ostream>

#include "tests/rtl/march_model.hpp"
#include "tests/rtl/ports.hpp"

namespace gridrt::march {

/// Writes fields of a packed vector, lowest first.
template <class Wide>
class Put {
 public:
  explicit Put(Wide& wide) : wide_(&wide) {}
  void operator()(std::int64_t value, int width) {
    rtl::put_bits(*wide_, at_, width, static_cast<std::uint64_t>(value));
    at_ += width;
  }

 private:
  Wide* wide_;
  int at_ = 0;
};

/// Reads them.
template <class Wide>
class Get {
 public:
  explicit Get(const Wide& wide) : wide_(&wide) {}
  std::int64_t operator()(int width) {
    at_ += width;
    return static_cast<std::int64_t>(rtl::get_bits(*wide_, at_ - width, width));
  }
  std::int64_t with_sign(int width) {
    const std::int64_t v = (*this)(width);
    return (v >> (width - 1)) != 0 ? v - (std::int64_t{1} << width) : v;
  }

 private:
  const Wide* wide_;
  int at_ = 0;
};

template <class Wide>
void put_grid(Wide& wide, const Grid& g) {
  Put<Wide> put(wide);
  for (int a = 0; a < 3; ++a) put(g.stride[a], 12);
  for (int a = 0; a < 3; ++a) put(g.half_blocks[a], 10);
  for (int a = 0; a < 3; ++a) put(g.span[a], 19);
  for (int a = 0; a < 3; ++a) put(g.edge[a], 18);
}

template <class Wide>
void put_state(Wide& wide, const State& s) {
  Put<Wide> put(wide);
  for (const Lateral& l : s.lateral) put(l.lim, 11);
  for (const Lateral& l : s.lateral) put(l.m, 29);
  for (const Lateral& l : s.lateral) put(l.r, 28);
  for (const Lateral& l : s.lateral) put(l.low, 3);
  for (const Lateral& l : s.lateral) put(l.h, 4);
  put(s.enter, 19);
  put(s.last, 3);
  put(s.first, 3);
  put(s.slabs, 8);
  put(s.block, 12);
  for (const bool neg : s.neg) put(neg ? 1 : 0, 1);
  put(s.axis, 2);
}

template <class Wide>
State get_state(const Wide& wide) {
  Get<Wide> get(wide);
  State s;
  for (Lateral& l : s.lateral) l.lim = static_cast<int>(get(11));
  for (Lateral& l : s.lateral) l.m = get(29);
  for (Lateral& l : s.lateral) l.r = get(28);
  for (Lateral& l : s.lateral) l.low = static_cast<int>(get(3));
  for (Lateral& l : s.lateral) l.h = static_cast<int>(get.with_sign(4));
  s.enter = static_cast<int>(get.with_sign(19));
  s.last = static_cast<int>(get(3));
  s.first = static_cast<int>(get(3));
  s.slabs = static_cast<int>(get(8));
  s.block = static_cast<int>(get(12));
  for (bool& neg : s.neg) neg = get(1) != 0;
  s.axis = static_cast<int>(get(2));
  return s;
}

}  // namespace gridrt::march
