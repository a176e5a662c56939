// The control points of Martin Newell's teapot (1975, public domain).
#pragma once

#include <cstddef>
#include <vector>

#include <glm/vec3.hpp>

namespace gridrt::scene_detail {

/// Bicubic Bezier patches in a strip that closes upon itself: `rows` control rows (3 a strip of
/// patches, and one) of `columns` points (3 a patch; the first follows upon the last again).
/// z is up; (d/dcolumn) x (d/drow) points outward.
struct ControlTube {
  std::size_t rows = 0;
  std::size_t columns = 0;
  std::vector<glm::dvec3> points;  ///< row by row
  bool first_row_is_pole = false;  ///< its points are one
  bool last_row_is_pole = false;
  glm::dvec3 pole_normal{0.0};  ///< where a row is one

  const glm::dvec3& at(std::size_t row, std::size_t column) const {
    return points[row * columns + column % columns];
  }
};

/// The 32 patches with Newell's coordinates, standing on z = 0, spout along +x: rim, body and
/// bottom as one tube of 16 patches, lid (8), handle (4) and spout (4).
std::vector<ControlTube> teapot_tubes();

}  // namespace gridrt::scene_detail
