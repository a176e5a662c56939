// Quarters of a voxel: those that a triangle touches on each axis, and the cells, a quarter of the
// voxel wide, that a ray touches. What shares no cell cannot meet.
#pragma once

#include <cstdint>

#include "host/grid/traversal.hpp"
#include "host/grid/triangle_box.hpp"
#include "host/grid/voxel_grid.hpp"

namespace gridrt {

/// A voxel's 64 cells: bit x + 4 y + 16 z, each a quarter's number on its axis.
using CellSet = std::uint64_t;

/// The cells whose quarters all lie in `quarters`.
constexpr CellSet cells_of(QuarterMasks quarters) {
  const CellSet x = (quarters & 0xFU) * CellSet{0x1111111111111111};
  // Bit q of y's mask to the bits 4 q to 4 q + 3, of z's to 16 q to 16 q + 15.
  const CellSet y = quarters >> 4U & 0xFU;
  const CellSet z = quarters >> 8U & 0xFU;
  const CellSet rows = (y & 1U) | (y & 2U) << 3U | (y & 4U) << 6U | (y & 8U) << 9U;
  const CellSet slabs = (z & 1U) | (z & 2U) << 15U | (z & 4U) << 30U | (z & 8U) << 45U;
  return x & rows * CellSet{0x000F000F000F000F} & slabs * CellSet{0xFFFF};
}

/// The quarters of each axis, grown by the grid's margin, that the triangle meets within the voxel;
/// `voxel` is one that it meets.
QuarterMasks triangle_quarters(const TriangleBoxTest& triangle, const VoxelGrid& grid,
                               const glm::ivec3& voxel);

/// The closed cells that the visit's part of the segment touches: exactly those.
CellSet ray_cells(const VoxelGrid& grid, const glm::ivec3& p0, const glm::ivec3& p1,
                  const VoxelVisit& visit);

}  // namespace gridrt
