#include "host/grid/voxel_grid.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace gridrt {
namespace {

constexpr std::size_t kMaxCells = std::size_t{1} << 28;

/// About `density` voxels a triangle, as cubic in scene units as the box allows.
glm::ivec3 choose_counts(const Lattice& lattice, std::size_t triangles, double density) {
  glm::dvec3 extent;
  for (int a = 0; a < 3; ++a) extent[a] = std::ldexp(lattice.box()[a], -lattice.scale[a]);
  const double largest = std::max({extent.x, extent.y, extent.z});
  // A thin box must not make the other axes explode: no axis counts for less than 1 in 2^20.
  for (int a = 0; a < 3; ++a) extent[a] = std::max(extent[a] / largest, 0x1p-20);
  const double wanted = density * static_cast<double>(std::max<std::size_t>(triangles, 1));
  // Axes thinner than a voxel count as one voxel; the others share what is left.
  double size = std::cbrt(extent.x * extent.y * extent.z / wanted);
  for (int round = 0; round < 3; ++round) {
    double volume = 1.0;
    int axes = 0;
    for (int a = 0; a < 3; ++a) {
      if (extent[a] > size) {
        volume *= extent[a];
        ++axes;
      }
    }
    if (axes == 0) break;
    size = std::pow(volume / wanted, 1.0 / axes);
  }
  glm::ivec3 count;
  for (int a = 0; a < 3; ++a) {
    const int finest = std::max(1, (lattice.box()[a] + 1) / kMinVoxelEdge);
    const double n = std::clamp(std::round(extent[a] / size), 1.0, 512.0);
    count[a] = std::min(static_cast<int>(n), finest);
  }
  return count;
}

}  // namespace

Result<VoxelGrid> make_grid(const Lattice& lattice, std::size_t triangles,
                            std::optional<glm::ivec3> wanted, double density) {
  VoxelGrid grid;
  grid.count = wanted.value_or(choose_counts(lattice, triangles, density));
  constexpr std::array<char, 3> kAxes{'x', 'y', 'z'};
  for (int a = 0; a < 3; ++a) {
    const char axis = kAxes[static_cast<std::size_t>(a)];
    const int n = grid.count[a];
    if (n < 1) {
      return fail(ErrorKind::kUsage, fmt::format("a grid of {} voxels along {}", n, axis),
                  "every axis needs at least one voxel");
    }
    // Voxels [k e, (k + 1) e] up to n e must cover [0, box].
    const int box = lattice.box()[a];
    if (n <= box) grid.edge[a] = std::max(1, (box + n - 1) / n);
    if (n > 1 && (n > box || grid.edge[a] < kMinVoxelEdge)) {
      return fail(ErrorKind::kLimit,
                  fmt::format("a grid of {} voxels along {} is too fine for a lattice of {} steps",
                              n, axis, box),
                  fmt::format("use at most {} voxels along {}, or more --bits",
                              std::max(1, box / kMinVoxelEdge), axis));
    }
  }
  // Room for a traversal in single precision, which strays by less than 2^-20 of the box; where
  // voxels are too small for it, that traversal is not for this grid.
  const glm::ivec3 box = lattice.box();
  const int wide = 1 + (std::max({box.x, box.y, box.z}) >> 20);
  grid.margin = std::min(wide, std::max(1, std::min({grid.edge.x, grid.edge.y, grid.edge.z}) / 4));
  // Each count is below 2^23 here, so that the product of two cannot wrap.
  const std::size_t layer =
      static_cast<std::size_t>(grid.count.x) * static_cast<std::size_t>(grid.count.y);
  if (layer > kMaxCells || layer * static_cast<std::size_t>(grid.count.z) > kMaxCells) {
    return fail(ErrorKind::kLimit,
                fmt::format("a grid of {}x{}x{} voxels", grid.count.x, grid.count.y, grid.count.z),
                fmt::format("use at most {} voxels in all", kMaxCells));
  }
  return grid;
}

}  // namespace gridrt
