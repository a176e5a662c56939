#include "tests/truth/float_boxes.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace gridrt::truth {

FloatBoxes::FloatBoxes(std::span<const FloatBox> boxes) : order_(boxes.size()) {
  if (boxes.empty()) return;
  std::iota(order_.begin(), order_.end(), 0U);
  nodes_.emplace_back();
  split(0, 0, static_cast<std::uint32_t>(order_.size()), boxes);
}

void FloatBoxes::split(std::uint32_t node, std::uint32_t begin, std::uint32_t end,
                       std::span<const FloatBox> boxes) {
  FloatBox all = boxes[order_[begin]];
  for (std::uint32_t i = begin; i < end; ++i) {
    for (std::size_t a = 0; a < 3; ++a) {
      all.lo[a] = std::min(all.lo[a], boxes[order_[i]].lo[a]);
      all.hi[a] = std::max(all.hi[a], boxes[order_[i]].hi[a]);
    }
  }
  nodes_[node].box = all;
  if (end - begin <= 4) {
    nodes_[node].first = begin;
    nodes_[node].count = end - begin;
    return;
  }
  std::size_t axis = 0;
  for (std::size_t a = 1; a < 3; ++a) {
    if (all.hi[a] - all.lo[a] > all.hi[axis] - all.lo[axis]) axis = a;
  }
  const std::uint32_t middle = begin + (end - begin) / 2;
  std::nth_element(order_.begin() + begin, order_.begin() + middle, order_.begin() + end,
                   [&](std::uint32_t x, std::uint32_t y) {
                     return boxes[x].lo[axis] + boxes[x].hi[axis] <
                            boxes[y].lo[axis] + boxes[y].hi[axis];
                   });
  const auto first = static_cast<std::uint32_t>(nodes_.size());
  nodes_[node].first = first;
  nodes_.resize(nodes_.size() + 2);
  split(first, begin, middle, boxes);
  split(first + 1, middle, end, boxes);
}

bool FloatBoxes::may_meet(const FloatBox& box, const Ray& ray) {
  // Each parameter is a rounded quotient of a rounded difference: off by less than 2^-51 of itself,
  // or by a denormal step.
  constexpr double kRelative = 0x1p-50;
  constexpr double kTiny = 0x1p-1000;
  double near = ray.tmin;
  double far = ray.tmax;
  for (std::size_t a = 0; a < 3; ++a) {
    const double o = ray.origin[a];
    const double d = ray.direction[a];
    if (d == 0.0) {
      if (o < box.lo[a] || o > box.hi[a]) return false;
      continue;
    }
    const double enter = ((d > 0.0 ? box.lo[a] : box.hi[a]) - o) / d;
    const double leave = ((d > 0.0 ? box.hi[a] : box.lo[a]) - o) / d;
    near = std::max(near, enter - kRelative * std::abs(enter) - kTiny);
    far = std::min(far, leave + kRelative * std::abs(leave) + kTiny);
  }
  return near <= far;
}

}  // namespace gridrt::truth
