// Which processing element owns which voxel.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "hal/error.hpp"
#include "host/grid/voxel_grid.hpp"

namespace gridrt {

/// Rules that deal voxels to PEs; the answer never depends on the choice.
enum class Mapping {
  kBoxes,       ///< balanced k-d boxes (16 a PE, by reference count) dealt in turn: the default
  kContiguous,  ///< one balanced k-d box a PE
  kVoxel,       ///< voxel by voxel along the diagonal, (i + j + k) mod P
};
inline constexpr int kMaxPes = 64;

Result<Mapping> parse_mapping(std::string_view name);
std::string_view mapping_name(Mapping mapping);

/// The owner of each voxel, in [0, pes). Errors: kUsage for pes outside [1, kMaxPes].
Result<std::vector<std::uint8_t>> deal_voxels(const VoxelGrid& grid, const VoxelLists& lists,
                                              Mapping mapping, int pes);

}  // namespace gridrt
