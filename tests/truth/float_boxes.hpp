// A tree of boxes in scene units that finds every triangle whose box a ray meets, and a few more.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "tests/truth/segment.hpp"

namespace gridrt::truth {

/// A closed box of a scene's own float32 numbers.
struct FloatBox {
  std::array<double, 3> lo{};
  std::array<double, 3> hi{};
};

/// Prunes the search of large scenes; leaves hold at most four boxes.
class FloatBoxes {
 public:
  explicit FloatBoxes(std::span<const FloatBox> boxes);

  /// Calls visit(index) for every box that some point of the ray, tmin to tmax, lies in.
  template <class Visit>
  void each(const Ray& ray, const Visit& visit) const {
    if (nodes_.empty()) return;
    std::vector<std::uint32_t> pending{0};
    while (!pending.empty()) {
      const Node& node = nodes_[pending.back()];
      pending.pop_back();
      if (!may_meet(node.box, ray)) continue;
      if (node.count == 0) {
        pending.push_back(node.first);
        pending.push_back(node.first + 1);
      }
      for (std::uint32_t i = 0; i < node.count; ++i) visit(order_[node.first + i]);
    }
  }

 private:
  struct Node {
    FloatBox box;
    std::uint32_t first = 0;  ///< of a leaf: first entry of order_; else the first child
    std::uint32_t count = 0;  ///< boxes of a leaf; 0: an inner node
  };
  static bool may_meet(const FloatBox& box, const Ray& ray);
  void split(std::uint32_t node, std::uint32_t begin, std::uint32_t end,
             std::span<const FloatBox> boxes);

  std::vector<Node> nodes_;
  std::vector<std::uint32_t> order_;
};

}  // namespace gridrt::truth
