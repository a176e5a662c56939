#include "host/grid/octants.hpp"

#include <algorithm>
#include <array>

namespace gridrt {
namespace {

/// Where along the segment it comes to the middle of the voxel on an axis (d not 0).
Fraction middle_of(const VoxelGrid& grid, const glm::ivec3& p0, std::int64_t d, int axis,
                   int voxel) {
  const std::int64_t way =
      (2 * std::int64_t{voxel} + 1) * grid.edge[axis] - 2 * std::int64_t{p0[axis]};
  return d > 0 ? Fraction{way, 2 * d} : Fraction{-way, -2 * d};
}

}  // namespace

OctantSet triangle_octants(const TriangleBoxTest& triangle, const VoxelGrid& grid,
                           const glm::ivec3& voxel) {
  const glm::ivec3 lo = voxel * grid.edge;
  unsigned set = 0;
  for (int octant = 0; octant < 8; ++octant) {
    if (triangle.meets(quarter_octant_box(lo, lo + grid.edge, grid.margin, octant))) {
      set |= 1U << octant;
    }
  }
  return static_cast<OctantSet>(set);
}

OctantSet ray_octants(const VoxelGrid& grid, const glm::ivec3& p0, const glm::ivec3& p1,
                      const VoxelVisit& visit) {
  // Of each axis: the parts of the way on which the segment is in the lower and in the upper half.
  struct Part {
    Fraction from;
    Fraction to;
  };
  std::array<std::array<Part, 2>, 3> parts;
  std::array<unsigned, 3> halves{};
  for (int a = 0; a < 3; ++a) {
    const auto axis = static_cast<std::size_t>(a);
    const std::int64_t d = std::int64_t{p1[a]} - p0[a];
    parts[axis].fill({visit.enter, visit.leave});
    if (d == 0) {
      const std::int64_t twice = 2 * std::int64_t{p0[a]};
      const std::int64_t middle = (2 * std::int64_t{visit.voxel[a]} + 1) * grid.edge[a];
      halves[axis] = (twice <= middle ? 1U : 0U) | (twice >= middle ? 2U : 0U);
      continue;
    }
    const Fraction middle = middle_of(grid, p0, d, a, visit.voxel[a]);
    const std::size_t first = d > 0 ? 0 : 1;
    if (middle < visit.leave) parts[axis][first].to = middle;
    if (visit.enter < middle) parts[axis][1 - first].from = middle;
    for (std::size_t h = 0; h < 2; ++h) {
      if (!(parts[axis][h].to < parts[axis][h].from)) halves[axis] |= 1U << h;
    }
  }
  unsigned set = 0;
  for (unsigned octant = 0; octant < 8; ++octant) {
    Fraction from = visit.enter;
    Fraction to = visit.leave;
    bool here = true;
    for (std::size_t a = 0; a < 3; ++a) {
      const unsigned half = (octant >> a) & 1U;
      here = here && ((halves[a] >> half) & 1U) != 0;
      from = std::max(from, parts[a][half].from);
      to = std::min(to, parts[a][half].to);
    }
    if (here && !(to < from)) set |= 1U << octant;
  }
  return static_cast<OctantSet>(set);
}

}  // namespace gridrt
