// Triangles into voxels, by a counting sort.
#include <algorithm>
#include <cstdint>

#include "host/grid/octants.hpp"
#include "host/grid/triangle_box.hpp"
#include "host/grid/voxel_grid.hpp"

namespace gridrt {
namespace {

struct Entry {
  std::uint32_t cell;
  VoxelReference reference;
};

struct CellRange {
  glm::ivec3 first{0};
  glm::ivec3 last{0};
};

/// Voxels whose closed box, grown by the margin, meets the triangle's bounding box.
CellRange bounding_cells(const VoxelGrid& grid, const LatticeTriangle& t) {
  CellRange range;
  for (int a = 0; a < 3; ++a) {
    const int lo = std::min({t.v[0][a], t.v[1][a], t.v[2][a]}) - grid.margin;
    const int hi = std::max({t.v[0][a], t.v[1][a], t.v[2][a]}) + grid.margin;
    // A coordinate on a face belongs to the voxels on both sides.
    const int first = lo <= 0 ? 0 : (lo + grid.edge[a] - 1) / grid.edge[a] - 1;
    range.first[a] = std::clamp(first, 0, grid.count[a] - 1);
    range.last[a] = std::clamp(hi / grid.edge[a], 0, grid.count[a] - 1);
  }
  return range;
}

}  // namespace

VoxelLists bin_triangles(const VoxelGrid& grid, std::span<const LatticeTriangle> triangles) {
  VoxelLists lists;
  lists.first.assign(grid.cells() + 1, 0);
  std::vector<Entry> entries;
  entries.reserve(triangles.size() * 4);
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    if (is_degenerate(triangles[i])) continue;
    const TriangleBoxTest test(triangles[i]);
    const CellRange range = bounding_cells(grid, triangles[i]);
    for (int z = range.first.z; z <= range.last.z; ++z) {
      for (int y = range.first.y; y <= range.last.y; ++y) {
        for (int x = range.first.x; x <= range.last.x; ++x) {
          const glm::ivec3 cell{x, y, z};
          const glm::ivec3 lo = cell * grid.edge;
          const glm::ivec3 hi = lo + grid.edge;
          if (!test.meets(quarter_box(lo, hi, grid.margin))) continue;
          const OctantSet octants = triangle_octants(test, grid, cell);
          const std::size_t index = grid.index(cell);
          entries.push_back(
              {static_cast<std::uint32_t>(index), {static_cast<std::uint32_t>(i), octants}});
          ++lists.first[index + 1];
        }
      }
    }
  }
  for (std::size_t i = 0; i < grid.cells(); ++i) lists.first[i + 1] += lists.first[i];
  lists.references.resize(entries.size());
  std::vector<std::uint64_t> next(lists.first.begin(), lists.first.end() - 1);
  for (const Entry& e : entries) lists.references[next[e.cell]++] = e.reference;
  return lists;
}

}  // namespace gridrt
