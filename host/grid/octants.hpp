// Octants of a voxel: which of them a triangle or a ray touches, and the codes that references
// hold. What shares no octant cannot meet.
#pragma once

#include <cstdint>

#include "host/grid/traversal.hpp"
#include "host/grid/triangle_box.hpp"
#include "host/grid/voxel_grid.hpp"

namespace gridrt {

/// The octants, grown by the grid's margin, that the triangle meets; `voxel` is one that it meets.
OctantSet triangle_octants(const TriangleBoxTest& triangle, const VoxelGrid& grid,
                           const glm::ivec3& voxel);

/// The closed octants that the visit's part of the segment touches: exactly those.
OctantSet ray_octants(const VoxelGrid& grid, const glm::ivec3& p0, const glm::ivec3& p1,
                      const VoxelVisit& visit);

}  // namespace gridrt
