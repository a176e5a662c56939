#include "host/pe/empty_space.hpp"

#include <algorithm>
#include <vector>

namespace gridrt {
namespace {

/// One sweep of Rosenfeld and Pfaltz ("Sequential operations in digital picture processing", 1966)
/// in the order of `way` (+1 or -1): with 26 neighbours the two sweeps give exact distances.
class Sweep {
 public:
  Sweep(const glm::ivec3& size, std::span<std::int32_t> codes, int way)
      : size_(size), codes_(codes), way_(way), near_(static_cast<std::size_t>(size.x) + 2) {}

  void run() {
    for (int k = 0; k < size_.z; ++k) {
      const int z = way_ > 0 ? k : size_.z - 1 - k;
      for (int j = 0; j < size_.y; ++j) row(way_ > 0 ? j : size_.y - 1 - j, z);
    }
  }

 private:
  [[nodiscard]] std::int32_t* row_at(int y, int z) const {
    return codes_.data() + (static_cast<std::ptrdiff_t>(z) * size_.y + y) * size_.x;
  }

  /// Distances are held as negative codes, so that the nearest is the largest; those with triangles
  /// count as 0.
  void row(int y, int z) {
    std::ranges::fill(near_, -kFarthest);
    const auto take = [&](int dy, int dz) {
      if (y + dy < 0 || y + dy >= size_.y || z + dz < 0 || z + dz >= size_.z) return;
      const std::int32_t* from = row_at(y + dy, z + dz);
      for (int x = 0; x < size_.x; ++x) {
        std::int32_t& to = near_[static_cast<std::size_t>(x) + 1];
        to = std::max(to, std::min(from[x], 0));
      }
    };
    for (int dy = -1; dy <= 1; ++dy) take(dy, -way_);
    take(-way_, 0);
    std::int32_t* to = row_at(y, z);
    const auto nearest = [&](int x) {
      const auto i = static_cast<std::size_t>(x);
      return std::max({near_[i], near_[i + 1], near_[i + 2]}) - 1;
    };
    std::int32_t before = -kFarthest;
    for (int i = 0; i < size_.x; ++i) {
      const int x = way_ > 0 ? i : size_.x - 1 - i;
      if (to[x] < 0) {
        to[x] = std::max({to[x], nearest(x), before - 1, -kFarthest});
        before = to[x];
      } else {
        before = 0;
      }
    }
  }

  glm::ivec3 size_;
  std::span<std::int32_t> codes_;
  int way_;
  std::vector<std::int32_t> near_;
};

}  // namespace

void measure_empty_space(const glm::ivec3& size, std::span<std::int32_t> codes) {
  for (std::int32_t& code : codes) code = std::max(code, -kFarthest);
  for (std::int32_t& code : codes) {
    if (code < 0) code = -kFarthest;
  }
  Sweep(size, codes, 1).run();
  Sweep(size, codes, -1).run();
}

}  // namespace gridrt
