// Which processing element owns which voxel.
#pragma once

#include <cstdint>
#include <string_view>
#include <utility>
#include <vector>

#include "hal/error.hpp"
#include "host/grid/voxel_grid.hpp"

namespace gridrt {

/// Rules that deal voxels to PEs; the answer never depends on the choice. Where there are no more
/// voxels than PEs, each voxel has a PE of its own.
enum class Mapping {
  kBoxes,       ///< balanced k-d boxes (16 a PE, by reference count) dealt in turn
  kContiguous,  ///< one balanced k-d box a PE
  kVoxel,       ///< voxel by voxel along the diagonal, (i + j + k) mod P
  /// Balanced boxes, as many as the memories allow, dealt by the work of sample rays, where a grid
  /// is chosen for the compact layout; elsewhere kBoxes.
  kMeasured,
};
inline constexpr int kMaxPes = 64;

/// Voxels lo to hi - 1.
struct VoxelBox {
  glm::ivec3 lo{0};
  glm::ivec3 hi{0};  ///< one past the last
};

/// Cuts a box of more than one voxel in two, across its longest axis, where the first of both holds
/// nearest to `share` (in (0, 1)) of its references.
std::pair<VoxelBox, VoxelBox> cut_box(const VoxelGrid& grid, const VoxelLists& lists,
                                      const VoxelBox& box, double share);

/// About `parts` boxes with about equal numbers of references; those that follow each other are
/// neighbours. Fewer where voxels are few.
std::vector<VoxelBox> balanced_boxes(const VoxelGrid& grid, const VoxelLists& lists, int parts);

/// Makes `pe` the owner of the voxels of a box.
void give_box(const VoxelGrid& grid, const VoxelBox& box, std::uint8_t pe,
              std::vector<std::uint8_t>& owners);

Result<Mapping> parse_mapping(std::string_view name);
std::string_view mapping_name(Mapping mapping);

/// The owner of each voxel, in [0, pes). Errors: kUsage for pes outside [1, kMaxPes].
Result<std::vector<std::uint8_t>> deal_voxels(const VoxelGrid& grid, const VoxelLists& lists,
                                              Mapping mapping, int pes);

}  // namespace gridrt
