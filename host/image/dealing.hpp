// Dealings of voxels to PEs that fit small memories: what each PE would hold, and voxels moved to
// neighbours' owners until it fits.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "host/image/pack.hpp"
#include "host/image/ray_load.hpp"

namespace gridrt {

/// One grid over the triangles of a scene, with what its sample rays do.
struct MeasuredGrid {
  VoxelGrid grid;
  VoxelLists lists;
  GridLoad load;
};

/// Whether every PE's references, triangles and vertices fit its memories.
bool dealing_fits(const LocalTriangles& local, const Cut& cut, const MeasuredGrid& measured,
                  std::span<const std::uint8_t> owners);

/// Deals boxes, which follow each other as neighbours do: each run of `pes` (at most 4) of them
/// goes to all PEs, in the order that keeps the PEs' work most even in every group of rays.
std::vector<std::uint8_t> deal_by_work(const MeasuredGrid& measured,
                                       std::span<const VoxelBox> boxes, int pes);

/// Gives voxels to PEs that hold their triangles anyway, where that spares copies and leaves the
/// work about as even as it is; stops when the dealing fits or no voxel is left that helps.
/// Returns whether it fits.
bool spare_copies(const LocalTriangles& local, const Cut& cut, const MeasuredGrid& measured,
                  std::vector<std::uint8_t>& owners);

}  // namespace gridrt
