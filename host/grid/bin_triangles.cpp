// Triangles into voxels, by a counting sort.
#include <algorithm>
#include <cstdint>

#include <omp.h>

#include "host/grid/quarters.hpp"
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

/// Entries of some triangles, ascending, by the range of cells that they fall into.
using Shelves = std::vector<std::vector<Entry>>;

/// Cells that one shelf holds; shelves are filled and emptied independently.
struct Ranges {
  std::size_t cells = 0;
  std::size_t width = 1;  ///< cells of a shelf
  [[nodiscard]] std::size_t count() const { return (cells + width - 1) / width; }
};

void shelve(const VoxelGrid& grid, const Ranges& ranges, const LatticeTriangle& triangle,
            std::uint32_t number, Shelves& shelves) {
  if (is_degenerate(triangle)) return;
  const TriangleBoxTest test(triangle);
  const CellRange range = bounding_cells(grid, triangle);
  for (int z = range.first.z; z <= range.last.z; ++z) {
    for (int y = range.first.y; y <= range.last.y; ++y) {
      for (int x = range.first.x; x <= range.last.x; ++x) {
        const glm::ivec3 cell{x, y, z};
        const glm::ivec3 lo = cell * grid.edge;
        const glm::ivec3 hi = lo + grid.edge;
        if (!test.meets(eighth_box(lo, hi, grid.margin))) continue;
        const QuarterMasks quarters = triangle_quarters(test, grid, cell);
        const std::size_t index = grid.index(cell);
        shelves[index / ranges.width].push_back(
            {static_cast<std::uint32_t>(index), {number, quarters}});
      }
    }
  }
}

}  // namespace

VoxelLists bin_triangles(const VoxelGrid& grid, std::span<const LatticeTriangle> triangles,
                         int threads) {
  const int workers = threads > 0 ? threads : omp_get_max_threads();
  constexpr std::size_t kShelves = 64;
  constexpr std::size_t kFewest = 1024;  // triangles of a piece
  const Ranges ranges{grid.cells(), grid.cells() / kShelves + 1};
  const std::size_t most = static_cast<std::size_t>(workers) * 8;
  const std::size_t size = std::max(kFewest, (triangles.size() + most - 1) / most);
  const auto pieces = static_cast<std::ptrdiff_t>((triangles.size() + size - 1) / size);
  std::vector<Shelves> shelved(static_cast<std::size_t>(pieces), Shelves(ranges.count()));
#pragma omp parallel for num_threads(workers) if (workers > 1 && pieces > 1) schedule(dynamic)
  for (std::ptrdiff_t piece = 0; piece < pieces; ++piece) {
    const auto p = static_cast<std::size_t>(piece);
    for (std::size_t i = p * size; i < std::min((p + 1) * size, triangles.size()); ++i) {
      shelve(grid, ranges, triangles[i], static_cast<std::uint32_t>(i), shelved[p]);
    }
  }

  VoxelLists lists;
  lists.first.assign(grid.cells() + 1, 0);
  std::vector<std::uint64_t> begins(ranges.count() + 1, 0);
  for (std::size_t shelf = 0; shelf < ranges.count(); ++shelf) {
    begins[shelf + 1] = begins[shelf];
    for (const Shelves& piece : shelved) begins[shelf + 1] += piece[shelf].size();
  }
  lists.references.resize(begins.back());
  const auto shelves = static_cast<std::ptrdiff_t>(ranges.count());
#pragma omp parallel for num_threads(workers) if (workers > 1 && pieces > 1) schedule(dynamic)
  for (std::ptrdiff_t shelf = 0; shelf < shelves; ++shelf) {
    const auto s = static_cast<std::size_t>(shelf);
    // Counts, then where each cell begins; pieces in their order, so that triangles ascend.
    const std::size_t first = s * ranges.width;
    const std::size_t last = std::min(first + ranges.width, grid.cells());
    std::vector<std::uint64_t> next(last - first, 0);
    for (const Shelves& piece : shelved) {
      for (const Entry& e : piece[s]) ++next[e.cell - first];
    }
    std::uint64_t at = begins[s];
    for (std::size_t i = 0; i < next.size(); ++i) {
      const std::uint64_t count = next[i];
      next[i] = at;
      at += count;
      lists.first[first + i + 1] = at;
    }
    for (const Shelves& piece : shelved) {
      for (const Entry& e : piece[s]) lists.references[next[e.cell - first]++] = e.reference;
    }
  }
  return lists;
}

}  // namespace gridrt
