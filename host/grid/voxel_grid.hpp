// The uniform grid over the lattice box and the list of triangles that each voxel refers to.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "hal/error.hpp"
#include "host/grid/lattice.hpp"

namespace gridrt {

/// Fewest lattice steps of a voxel on an axis with more than one: the margin must stay small
/// against it.
inline constexpr int kMinVoxelEdge = 4;

/// Voxel (i, j, k) is the closed lattice box [i edge.x, (i + 1) edge.x] x ...; together they cover
/// the lattice box.
struct VoxelGrid {
  glm::ivec3 count{1};  ///< voxels per axis, >= 1
  glm::ivec3 edge{1};   ///< lattice steps per voxel, >= 4 (1 where the count is 1)
  int margin = 1;       ///< a triangle is referenced by every voxel within this many lattice steps

  [[nodiscard]] std::size_t cells() const {
    return static_cast<std::size_t>(count.x) * static_cast<std::size_t>(count.y) *
           static_cast<std::size_t>(count.z);
  }
  [[nodiscard]] std::size_t index(const glm::ivec3& c) const {
    return (static_cast<std::size_t>(c.z) * static_cast<std::size_t>(count.y) +
            static_cast<std::size_t>(c.y)) *
               static_cast<std::size_t>(count.x) +
           static_cast<std::size_t>(c.x);
  }
};

/// Quarters of a voxel on each axis, bit 0 the lowest one: x in bits 0 to 3, y in 4 to 7, z in 8
/// to 11.
using QuarterMasks = std::uint16_t;
inline constexpr QuarterMasks kAllQuarters = 0xFFF;

/// One triangle in one voxel.
struct VoxelReference {
  std::uint32_t triangle;  ///< index into the triangles the grid was built from
  QuarterMasks quarters;   ///< that it touches, margin included: an interval on each axis
};

/// References by voxel: those of voxel i are references[first[i] .. first[i + 1]), ascending.
struct VoxelLists {
  std::vector<std::uint64_t> first;  ///< cells() + 1 offsets
  std::vector<VoxelReference> references;
};

/// Chooses voxels so that there are about `density` voxels a triangle, by the extent of the box in
/// scene units; or takes `wanted`. Errors: kLimit for a grid too fine for the lattice (edge < 4
/// steps on an axis with more than one voxel) or of more than 2^28 voxels, kUsage for counts < 1.
Result<VoxelGrid> make_grid(const Lattice& lattice, std::size_t triangles,
                            std::optional<glm::ivec3> wanted, double density = 4.0);

/// Puts every triangle into every voxel whose box, grown by the margin, it meets (a separating
/// axis test in integers, so none is lost), by a counting sort. Degenerate triangles are left out.
/// On `threads` threads (0: one a core); the lists do not depend on their number.
VoxelLists bin_triangles(const VoxelGrid& grid, std::span<const LatticeTriangle> triangles,
                         int threads = 0);

}  // namespace gridrt
