// What the schedule `rays` makes of an image at load, for vectors of any width: the triangles of
// each voxel side by side in single precision, and how far empty space reaches around each voxel.
#pragma once

#include <cstdint>
#include <vector>

#include <glm/vec3.hpp>

#include "host/pe/triangle_boxes.hpp"

namespace gridrt {

/// Widest vector, in single-precision lanes, and so the alignment of what is loaded.
inline constexpr std::size_t kMostLanes = 16;

/// Sixteen floats on a boundary of vectors.
struct alignas(64) FloatLine {
  float x[kMostLanes];
};

/// The triangles of a voxel: `blocks` groups of lanes from block `first` on.
struct LayoutCell {
  std::uint32_t first = 0;
  std::uint32_t blocks = 0;
  std::uint32_t triangles = 0;  ///< in them
  float reach = 0.0F;           ///< largest absolute component of an edge of these triangles
};

/// A block is kBlockRows rows of `lanes` floats: V0, E1, E2 (lattice steps, exact) and the normal
/// N = E1 x E2 (rounded to nearest once), x y z each. Lanes without a triangle have V0 not a
/// number, which no comparison accepts.
inline constexpr std::size_t kBlockRows = 12;

class RayLayout {
 public:
  /// True if the march in single precision (ray_march-inl.hpp) stays within the margin of this
  /// grid, and voxels can be numbered.
  static bool fits(const Engine& engine);

  /// For a lattice of `bits` and vectors of `lanes` (1 to 16, a power of two), on `threads`
  /// threads. fits() holds.
  static RayLayout build(const Engine& engine, int bits, std::size_t lanes, int threads);

  [[nodiscard]] std::size_t lanes() const { return lanes_; }
  [[nodiscard]] const glm::ivec3& edge() const { return edge_; }
  /// Voxels of the grid; the numbered ones have a border of one more on every side.
  [[nodiscard]] const glm::ivec3& count() const { return count_; }
  /// Distance of neighbours along each axis in voxel numbers.
  [[nodiscard]] const glm::ivec3& stride() const { return stride_; }
  /// No coordinate is larger.
  [[nodiscard]] int box() const { return box_; }
  [[nodiscard]] bool narrow() const { return narrow_; }  ///< 64 bits hold every product

  /// By voxel number: the index of its cell, or minus the number k > 0 of steps to the nearest
  /// voxel with triangles (steps to any of 26 neighbours): all that are nearer are empty. A voxel
  /// of the border is like the one of the grid beside it.
  [[nodiscard]] const std::int32_t* codes() const { return codes_.data(); }
  [[nodiscard]] const LayoutCell& cell(std::int32_t code) const {
    return cells_[boxes_.voxel(static_cast<std::uint32_t>(code))[1]];
  }
  [[nodiscard]] const float* block(std::size_t number) const {
    return lines_.data()->x + number * kBlockRows * lanes_;
  }
  /// Local ids of a block's lanes.
  [[nodiscard]] const std::uint32_t* ids(std::size_t block) const {
    return ids_.data() + block * lanes_;
  }
  [[nodiscard]] const TriangleBoxes& boxes() const { return boxes_; }

 private:
  std::size_t lanes_ = 1;
  glm::ivec3 edge_{1};
  glm::ivec3 count_{1};
  glm::ivec3 stride_{1};
  int box_ = 0;
  bool narrow_ = true;
  LargeVector<std::int32_t> codes_;
  LargeVector<LayoutCell> cells_;
  LargeVector<FloatLine> lines_;
  LargeVector<std::uint32_t> ids_;
  TriangleBoxes boxes_;
};

}  // namespace gridrt
