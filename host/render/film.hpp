// The picture in memory: linear RGB, row 0 on top.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <glm/vec3.hpp>

namespace gridrt {

inline constexpr int kMaxPictureSide = 65535;                    ///< pixels
inline constexpr std::uint64_t kMaxPicturePixels = 1ULL << 28U;  ///< width times height

/// width x height pixels of linear RGB, row-major from the top left.
struct Film {
  int width = 0;   ///< in [1, kMaxPictureSide]
  int height = 0;  ///< in [1, kMaxPictureSide]
  std::vector<glm::vec3> pixels;

  [[nodiscard]] const glm::vec3& at(int x, int y) const {
    return pixels[(static_cast<std::size_t>(y) * static_cast<std::size_t>(width)) +
                  static_cast<std::size_t>(x)];
  }
};

}  // namespace gridrt
