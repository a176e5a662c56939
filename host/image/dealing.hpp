// Dealings of voxels to PEs that fit small memories: what each PE would hold, and voxels moved to
// neighbours' owners until it fits.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "host/image/pack.hpp"
#include "host/image/ray_load.hpp"

namespace gridrt {

/// What is to be even among the PEs: the work of each group of sample rays and, since rays that
/// come or go in one direction keep to what faces it, the references to triangles that face each of
/// 26 directions. Of one voxel, as parts of the grid's totals.
inline constexpr std::size_t kFacings = 26;
using Shares = std::array<float, kRayGroups + kFacings>;

/// One grid over the triangles of a scene, with what its sample rays do.
struct MeasuredGrid {
  VoxelGrid grid;
  VoxelLists lists;
  GridLoad load;
  std::vector<Shares> shares;  ///< by voxel
};

/// Fills in `shares` from the rest.
void find_shares(std::span<const LatticeTriangle> triangles, const Lattice& lattice,
                 MeasuredGrid& measured);

/// Whether every PE's references, triangles and vertices fit its memories.
bool dealing_fits(const LocalTriangles& local, const Cut& cut, const MeasuredGrid& measured,
                  std::span<const std::uint8_t> owners);

/// Deals boxes, which follow each other as neighbours do: each run of `pes` (at most 4) of them
/// goes to all PEs, in the order that keeps their shares most even.
std::vector<std::uint8_t> deal_by_work(const MeasuredGrid& measured,
                                       std::span<const VoxelBox> boxes, int pes);

/// Gives voxels to PEs that hold their triangles anyway, where that spares copies and leaves the
/// shares about as even as they are; stops when the dealing fits or no voxel is left that helps.
/// Returns whether it fits.
bool spare_copies(const LocalTriangles& local, const Cut& cut, const MeasuredGrid& measured,
                  std::vector<std::uint8_t>& owners);

}  // namespace gridrt
