// Does a lattice triangle meet a box? By separating axes, in integers.
#pragma once

#include <glm/vec3.hpp>

#include "host/grid/lattice.hpp"

namespace gridrt {

/// A closed box in eighths of a lattice step (so that the quarters of a voxel have integer
/// centres): |x - centre| <= half per axis.
struct EighthBox {
  glm::i64vec3 centre{0};
  glm::i64vec3 half{0};
};

/// The box [lo, hi] (lattice steps), or the part of it in a quarter (0 to 3) of one axis, grown by
/// `margin` lattice steps on every side.
EighthBox eighth_box(const glm::ivec3& lo, const glm::ivec3& hi, int margin);
EighthBox eighth_slab_box(const glm::ivec3& lo, const glm::ivec3& hi, int margin, int axis,
                          int quarter);

/// A triangle prepared for many boxes. Exact for bits <= 24.
/// Source of the method: Akenine-Moeller, "Fast 3D Triangle-Box Overlap Testing", 2001.
class TriangleBoxTest {
 public:
  explicit TriangleBoxTest(const LatticeTriangle& triangle);
  [[nodiscard]] bool meets(const EighthBox& box) const;

  /// The bounds of the triangle on an axis, in eighths of a step.
  [[nodiscard]] std::int64_t low(int axis) const { return low_[axis]; }
  [[nodiscard]] std::int64_t high(int axis) const { return high_[axis]; }

 private:
  template <class Scalar>
  [[nodiscard]] bool plane_meets(const EighthBox& box) const;

  std::array<glm::i64vec3, 3> v_{};     ///< eighths of a step
  std::array<glm::i64vec3, 3> edge_{};  ///< lattice steps
  glm::i64vec3 normal_{0};              ///< lattice steps squared
  glm::i64vec3 low_{0};                 ///< bounds, eighths of a step
  glm::i64vec3 high_{0};
  bool narrow_ = true;  ///< 64 bits hold the plane test
};

}  // namespace gridrt
