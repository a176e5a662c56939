// The skip field: which 2x2x2 blocks of voxels hold references, and how far a ray may jump.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "host/grid/voxel_grid.hpp"

namespace gridrt {

/// Blocks per axis: half the voxels, rounded up.
glm::ivec3 block_count(const VoxelGrid& grid);

/// Blocks in all.
std::size_t block_total(const VoxelGrid& grid);

/// The voxel of a block, in bit order x + 2 y + 4 z; it may lie outside the grid.
glm::ivec3 block_voxel(const glm::ivec3& block, int bit);

/// True if the voxel lies in the grid.
bool in_grid(const VoxelGrid& grid, const glm::ivec3& voxel);

/// Per block, x fastest: bit x + 2 y + 4 z is set where that voxel has references.
std::vector<std::uint8_t> block_occupancy(const VoxelGrid& grid, const VoxelLists& lists);

/// Blocks to skip, 0 to kMaxJump, for the directions +x -x +y -y +z -z.
using Jumps = std::array<std::uint8_t, 6>;
inline constexpr int kMaxJump = 7;

/// The jumps of every block. jump[d] of block c is the largest j in [0, 7] such that no block of
/// { c + i d + a e + b f : 0 <= i < j, |a| <= i + 1, |b| <= i + 1 } is occupied, e and f being the
/// other two axes and blocks outside the grid being empty.
///
/// Why no voxel with references is lost: let d be the axis along which the segment crosses most
/// voxels. Then it moves at most one voxel, so at most one block, sideways per voxel, or block,
/// along d. From a point in the closed block c on, until it leaves the layer i blocks ahead, it has
/// moved at most i + 1 blocks along d, so at most i + 1 sideways; every block that it meets in
/// layer i is in the set above. With j layers free it may go on at the first slab of layer j. A
/// point on a face between blocks belongs to both; the traversal takes the smallest jump of all
/// voxels that it meets in a slab, so the block on the side that the segment moves to is among
/// those asked.
std::vector<Jumps> skip_field(const glm::ivec3& blocks, std::span<const std::uint8_t> occupancy);

}  // namespace gridrt
