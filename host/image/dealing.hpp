// Dealings of voxels to PEs: what is to be even among them, and what each of them would hold.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "host/image/pack.hpp"
#include "host/image/ray_load.hpp"

namespace gridrt {

/// What is to be even among the PEs: the work of each group of sample rays; the references to
/// triangles that face each of 26 directions, since rays that come or go in one direction keep to
/// what faces it; and those in each of some regions, since what is near to a camera fills its
/// picture. Of one voxel, as parts of the grid's totals.
inline constexpr std::size_t kFacings = 26;
inline constexpr std::size_t kRegions = 200;
using Shares = std::array<float, kRayGroups + kFacings + kRegions>;

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

}  // namespace gridrt
