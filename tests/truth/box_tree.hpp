// A tree of integer boxes that finds every triangle whose box a segment meets, exactly.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "tests/truth/lattice.hpp"

namespace gridrt::truth {

/// Prunes the search of large scenes; leaves hold at most four triangles.
class BoxTree {
 public:
  explicit BoxTree(std::span<const Triangle> triangles);

  /// Calls visit(id) for every triangle in a leaf whose closed box meets the closed segment.
  template <class Visit>
  void each(const Point& p0, const Point& p1, const Visit& visit) const {
    if (nodes_.empty()) return;
    std::vector<std::uint32_t> pending{0};
    while (!pending.empty()) {
      const Node& node = nodes_[pending.back()];
      pending.pop_back();
      if (!meets(node, p0, p1)) continue;
      if (node.count == 0) {
        pending.push_back(node.first);
        pending.push_back(node.first + 1);
      }
      for (std::uint32_t i = 0; i < node.count; ++i) visit(order_[node.first + i]);
    }
  }

 private:
  struct Node {
    Point lo{};
    Point hi{};
    std::uint32_t first = 0;  ///< of a leaf: first entry of order_; else the first child
    std::uint32_t count = 0;  ///< triangles of a leaf; 0: an inner node
  };
  static bool meets(const Node& node, const Point& p0, const Point& p1);
  void split(std::uint32_t node, std::uint32_t begin, std::uint32_t end,
             std::span<const Triangle> triangles);

  std::vector<Node> nodes_;
  std::vector<std::uint32_t> order_;
};

}  // namespace gridrt::truth
