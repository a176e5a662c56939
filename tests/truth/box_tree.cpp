#include "tests/truth/box_tree.hpp"

#include <algorithm>
#include <cstdlib>
#include <numeric>

namespace gridrt::truth {
namespace {

/// Three times the middle of the corners.
std::int64_t centre(const Triangle& t, std::size_t axis) {
  return static_cast<std::int64_t>(t.a[axis]) + t.b[axis] + t.c[axis];
}

}  // namespace

BoxTree::BoxTree(std::span<const Triangle> triangles) : order_(triangles.size()) {
  if (triangles.empty()) return;
  std::iota(order_.begin(), order_.end(), 0U);
  nodes_.emplace_back();
  split(0, 0, static_cast<std::uint32_t>(order_.size()), triangles);
}

void BoxTree::split(std::uint32_t node, std::uint32_t begin, std::uint32_t end,
                    std::span<const Triangle> triangles) {
  Point lo = triangles[order_[begin]].a;
  Point hi = lo;
  for (std::uint32_t i = begin; i < end; ++i) {
    const Triangle& t = triangles[order_[i]];
    for (std::size_t axis = 0; axis < 3; ++axis) {
      lo[axis] = std::min({lo[axis], t.a[axis], t.b[axis], t.c[axis]});
      hi[axis] = std::max({hi[axis], t.a[axis], t.b[axis], t.c[axis]});
    }
  }
  nodes_[node].lo = lo;
  nodes_[node].hi = hi;
  if (end - begin <= 4) {
    nodes_[node].first = begin;
    nodes_[node].count = end - begin;
    return;
  }
  // Halves with as many triangles each, along the axis whose centres spread farthest for the size
  // of the triangles there: the one that leaves the least overlap.
  std::size_t axis = 0;
  double best = -1.0;
  for (std::size_t i = 0; i < 3; ++i) {
    double size = 1.0;
    double low = static_cast<double>(centre(triangles[order_[begin]], i));
    double high = low;
    for (std::uint32_t k = begin; k < end; ++k) {
      const Triangle& t = triangles[order_[k]];
      const auto [least, most] = std::minmax({t.a[i], t.b[i], t.c[i]});
      size += most - least;
      low = std::min(low, static_cast<double>(centre(t, i)));
      high = std::max(high, static_cast<double>(centre(t, i)));
    }
    if ((high - low) / size > best) {
      best = (high - low) / size;
      axis = i;
    }
  }
  const std::uint32_t middle = begin + (end - begin) / 2;
  std::nth_element(order_.begin() + begin, order_.begin() + middle, order_.begin() + end,
                   [&](std::uint32_t x, std::uint32_t y) {
                     return centre(triangles[x], axis) < centre(triangles[y], axis);
                   });
  const auto first = static_cast<std::uint32_t>(nodes_.size());
  nodes_[node].first = first;
  nodes_.resize(nodes_.size() + 2);
  split(first, begin, middle, triangles);
  split(first + 1, middle, end, triangles);
}

bool BoxTree::meets(const Node& node, const Point& p0, const Point& p1) {
  // Separating axes of a segment and a box, everything doubled so that the middles are integers:
  // entries below 2^26, products below 2^53.
  std::array<std::int64_t, 3> half{};    // of the box
  std::array<std::int64_t, 3> reach{};   // of the segment
  std::array<std::int64_t, 3> offset{};  // of its middle from the box's
  std::array<std::int64_t, 3> width{};   // |reach|
  for (std::size_t i = 0; i < 3; ++i) {
    half[i] = static_cast<std::int64_t>(node.hi[i]) - node.lo[i];
    reach[i] = static_cast<std::int64_t>(p1[i]) - p0[i];
    offset[i] = static_cast<std::int64_t>(p0[i]) + p1[i] - node.lo[i] - node.hi[i];
    width[i] = std::abs(reach[i]);
    if (std::abs(offset[i]) > half[i] + width[i]) return false;
  }
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3;
    const std::size_t k = (i + 2) % 3;
    const std::int64_t apart = std::abs(reach[j] * offset[k] - reach[k] * offset[j]);
    if (apart > half[j] * width[k] + half[k] * width[j]) return false;
  }
  return true;
}

}  // namespace gridrt::truth
