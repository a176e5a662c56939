// Which voxels a segment meets, in the order in which it meets them: a march over the slabs of the
// dominant axis in exact integers (a 3D-DDA, after Amanatides and Woo, "A Fast Voxel Traversal
// Algorithm for Ray Tracing", 1987, with slabs so that empty space can be skipped).
//
// Nothing is rounded, so nothing has to be bounded: the voxels visited are exactly those whose
// closed box the segment meets; a segment in a face visits both sides, one through a corner all
// that share it.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include <glm/vec3.hpp>

#include "host/grid/voxel_grid.hpp"

namespace gridrt {

/// A parameter num / den along p0 .. p1, in [0, 1]; den > 0, both below 2^25.
struct Fraction {
  std::int64_t num = 0;
  std::int64_t den = 1;

  [[nodiscard]] bool operator<(const Fraction& o) const { return num * o.den < o.num * den; }
  /// floor(2^24 num / den), comparable with HitKey::quotient.
  [[nodiscard]] std::uint32_t quotient() const {
    return static_cast<std::uint32_t>((num << 24) / den);
  }
};

/// A voxel and the part of the segment within its closed box.
struct VoxelVisit {
  glm::ivec3 voxel{0};
  Fraction enter;
  Fraction leave;
};

/// The march of one segment (p0 != p1) through a grid, a slab at a time.
class SlabMarch {
 public:
  SlabMarch(const VoxelGrid& grid, const glm::ivec3& p0, const glm::ivec3& p1);

  /// False when the last slab has been left.
  [[nodiscard]] bool has_slab() const { return slabs_left_ > 0; }

  /// The voxels of this slab that the segment meets, by entry parameter (at most 9, usually 1 to
  /// 3; in the plane of a face both sides). Valid until next() or skip().
  std::span<const VoxelVisit> voxels();

  /// Slabs between the first one and this one.
  [[nodiscard]] int step() const { return step_; }

  /// Goes on (never back) to the slab `step` slabs behind the first one.
  void seek(int step) { advance(step - step_); }

  /// Goes on to the next slab.
  void next() { advance(1); }

  /// Goes on to the first slab of the 2x2x2 block that is `blocks` (>= 1) blocks ahead.
  void skip_blocks(int blocks);

  /// Skip direction of the dominant axis: 0 to 5 for +x -x +y -y +z -z.
  [[nodiscard]] int direction() const { return 2 * axis_[0] + (sign_ > 0 ? 0 : 1); }

 private:
  struct Range {
    int first = 0;  ///< voxel where the segment is at the slab's entry
    int last = -1;  ///< and at its exit; both included, in steps of +1 or -1
  };
  [[nodiscard]] Range lateral_range(int axis, std::int64_t enter, std::int64_t leave) const;
  [[nodiscard]] VoxelVisit within(int axis, int voxel, const VoxelVisit& slab) const;
  void advance(int slabs);

  VoxelGrid grid_;
  glm::ivec3 p0_;
  glm::ivec3 d_;
  std::array<int, 3> axis_{};  ///< dominant axis first
  int sign_ = 1;
  int slab_ = 0;
  int slabs_left_ = 0;
  int step_ = 0;
  std::array<VoxelVisit, 16> visits_;
  std::size_t count_ = 0;
};

/// Calls visit(const VoxelVisit&) for every voxel that the segment meets, in order of entry, until
/// it returns false. `skip(voxel, direction)` tells how many blocks may be left out (0: none); the
/// smallest answer over the slab's voxels is taken. Returns the number of slabs looked at.
template <class Skip, class Visit>
std::uint64_t traverse(const VoxelGrid& grid, const glm::ivec3& p0, const glm::ivec3& p1,
                       Skip&& skip, Visit&& visit) {
  std::uint64_t steps = 0;
  SlabMarch march(grid, p0, p1);
  while (march.has_slab()) {
    ++steps;
    const std::span<const VoxelVisit> voxels = march.voxels();
    int jump = 7;
    for (const VoxelVisit& v : voxels) {
      const int j = skip(v.voxel, march.direction());
      jump = j < jump ? j : jump;
    }
    if (jump > 0 && !voxels.empty()) {
      march.skip_blocks(jump);
      continue;
    }
    for (const VoxelVisit& v : voxels) {
      if (!visit(v)) return steps;
    }
    march.next();
  }
  return steps;
}

}  // namespace gridrt
