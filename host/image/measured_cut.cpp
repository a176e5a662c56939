#include "host/image/measured_cut.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "host/image/blocks.hpp"
#include "host/image/ray_load.hpp"

namespace gridrt {
namespace {

/// Blocks of a grid, as parts of what the device holds: finer grids mean fewer tests and more
/// steps, and which are the dearer ones depends on the scene.
constexpr std::array kBlockShares{1.0, 0.95, 0.9,  0.8,  0.68, 0.55, 0.42,
                                  0.3, 0.2,  0.12, 0.07, 0.04, 0.02, 0.01};
/// A grid has no more than this many blocks a triangle, and some: finer ones gain nothing.
constexpr std::uint64_t kBlocksPerTriangle = 8;
constexpr std::uint64_t kMoreBlocks = 64;
/// Many boxes are dealt more evenly, few need fewer copies of triangles.
constexpr std::array kBoxesPerPe{32, 24, 16, 12, 8, 6, 4, 2, 1};
constexpr double kEnough = 1.35;  ///< a grid this much dearer than the best: coarser ones are too

constexpr std::array<std::array<std::uint8_t, 4>, 24> permutations_of_four() {
  std::array<std::array<std::uint8_t, 4>, 24> all{};
  std::array<std::uint8_t, 4> p{0, 1, 2, 3};
  for (auto& one : all) {
    one = p;
    std::ranges::next_permutation(p);
  }
  return all;
}

/// About cubic voxels in scene units, two by two, as many as `blocks` allows.
glm::ivec3 counts_for(const Lattice& lattice, double blocks) {
  glm::dvec3 extent{0.0};
  glm::ivec3 most{1};
  for (int a = 0; a < 3; ++a) {
    extent[a] = std::ldexp(static_cast<double>(lattice.box()[a]), -lattice.scale[a]);
    most[a] = std::clamp((lattice.box()[a] + 1) / kMinVoxelEdge / 2, 0, 256);  // blocks
  }
  glm::ivec3 count{1};  // blocks
  for (;;) {
    const double now = static_cast<double>(count.x) * count.y * count.z;
    int grow = -1;
    for (int a = 0; a < 3; ++a) {
      if (count[a] >= most[a] || now / count[a] * (count[a] + 1) > blocks) continue;
      if (grow < 0 || extent[a] / count[a] > extent[grow] / count[grow]) grow = a;
    }
    if (grow < 0) break;
    // What is left of the blocks must not make voxels flat.
    const double longest = std::max({extent.x / count.x, extent.y / count.y, extent.z / count.z});
    if (extent[grow] / count[grow] < 0.8 * longest) break;
    ++count[grow];
  }
  for (int a = 0; a < 3; ++a) count[a] = most[a] == 0 ? 1 : 2 * count[a];
  return count;
}

using ViewSums = std::array<double, kViews>;

ViewSums work_of(const VoxelGrid& grid, const GridLoad& load, const VoxelBox& box) {
  ViewSums sums{};
  for (int z = box.lo.z; z < box.hi.z; ++z) {
    for (int y = box.lo.y; y < box.hi.y; ++y) {
      const std::size_t first = grid.index({box.lo.x, y, z});
      const auto length = static_cast<std::size_t>(box.hi.x - box.lo.x);
      for (std::size_t v = 0; v < kViews; ++v) {
        for (std::size_t i = first; i < first + length; ++i) sums[v] += load.work[v][i];
      }
    }
  }
  return sums;
}

/// Boxes that follow each other are neighbours, so each run of `pes` boxes goes to all PEs, in the
/// order that keeps the PEs' work most even in every view.
std::vector<std::uint8_t> deal_by_work(const VoxelGrid& grid, const GridLoad& load,
                                       std::span<const VoxelBox> boxes, int pes) {
  static constexpr auto kOrders = permutations_of_four();
  const auto width = static_cast<std::size_t>(pes);
  std::vector<ViewSums> work(boxes.size());
  for (std::size_t i = 0; i < boxes.size(); ++i) work[i] = work_of(grid, load, boxes[i]);
  std::vector<ViewSums> held(width, ViewSums{});
  std::vector<std::uint8_t> owners(grid.cells(), 0);
  for (std::size_t first = 0; first < boxes.size(); first += width) {
    const std::size_t count = std::min(width, boxes.size() - first);
    const std::array<std::uint8_t, 4>* best = nullptr;
    double least = 0.0;
    for (const auto& order : kOrders) {
      if (std::any_of(order.begin(), order.begin() + pes, [&](int p) { return p >= pes; })) {
        continue;
      }
      double squares = 0.0;
      for (std::size_t i = 0; i < count; ++i) {
        for (std::size_t v = 0; v < kViews; ++v) squares += held[order[i]][v] * work[first + i][v];
      }
      if (best == nullptr || squares < least) {
        best = &order;
        least = squares;
      }
    }
    for (std::size_t i = 0; i < count; ++i) {
      const std::uint8_t pe = (*best)[i];
      for (std::size_t v = 0; v < kViews; ++v) held[pe][v] += work[first + i][v];
      give_box(grid, boxes[first + i], pe, owners);
    }
  }
  return owners;
}

struct Candidate {
  std::size_t grid = 0;  ///< index of its grid and lists
  std::vector<std::uint8_t> owners;
  Mapping mapping = Mapping::kMeasured;
  double clocks = 0.0;
};

struct GridLists {
  VoxelGrid grid;
  VoxelLists lists;
};

bool may_fit(const Cut& cut, const GridLists& g) {
  std::uint64_t cells = 0;
  for (std::size_t i = 0; i < g.grid.cells(); ++i) {
    if (g.lists.first[i + 1] > g.lists.first[i]) ++cells;
  }
  return block_total(g.grid) <= cut.memory.blocks && cells <= cut.memory.cells &&
         g.lists.references.size() <=
             static_cast<std::uint64_t>(cut.pes) * std::uint64_t{cut.memory.references};
}

/// Adds the dealings of a grid to be tried; returns the cheapest one's clocks.
Result<double> add_dealings(const Cut& cut, const GridLists& g, const GridLoad& load,
                            std::size_t index, std::vector<Candidate>& out) {
  double least = std::numeric_limits<double>::infinity();
  const auto add = [&](std::vector<std::uint8_t> owners, Mapping mapping) {
    const double clocks = estimate_clocks(load, owners, cut.pes);
    least = std::min(least, clocks);
    out.push_back({index, std::move(owners), mapping, clocks});
  };
  if (cut.mapping != Mapping::kMeasured || g.grid.cells() <= static_cast<std::size_t>(cut.pes)) {
    const Mapping mapping = cut.mapping == Mapping::kMeasured ? Mapping::kBoxes : cut.mapping;
    auto owners = deal_voxels(g.grid, g.lists, mapping, cut.pes);
    if (!owners) return std::unexpected(std::move(owners.error()));
    add(std::move(*owners), mapping);
    return least;
  }
  for (const int boxes : kBoxesPerPe) {
    if (cut.pes == 1 && boxes > 1) continue;
    const std::vector<VoxelBox> cuts = balanced_boxes(g.grid, g.lists, boxes * cut.pes);
    add(deal_by_work(g.grid, load, cuts, cut.pes), Mapping::kMeasured);
  }
  return least;
}

}  // namespace

Result<Image> pack_measured(const LatticeScene& scene) {
  const Cut& cut = scene.cut;
  const std::span<const LatticeTriangle> triangles = scene.local.triangles;
  RaySample sample(cut.lattice, triangles);
  std::vector<GridLists> grids;
  std::vector<Candidate> candidates;
  double best = std::numeric_limits<double>::infinity();
  const auto most = static_cast<double>(std::min<std::uint64_t>(
      cut.memory.blocks, kBlocksPerTriangle * triangles.size() + kMoreBlocks));
  glm::ivec3 before{0};
  for (const double share : kBlockShares) {
    const glm::ivec3 count = counts_for(cut.lattice, share * most);
    if (count == before) continue;
    before = count;
    const auto grid = make_grid(cut.lattice, triangles.size(), count);
    if (!grid) continue;
    GridLists g{*grid, bin_triangles(*grid, triangles)};
    if (!may_fit(cut, g)) continue;
    const GridLoad load = sample.measure(g.grid, g.lists);
    const auto clocks = add_dealings(cut, g, load, grids.size(), candidates);
    if (!clocks) return std::unexpected(clocks.error());
    grids.push_back(std::move(g));
    if (*clocks > kEnough * best) break;
    best = std::min(best, *clocks);
  }
  std::ranges::stable_sort(candidates, {}, &Candidate::clocks);
  Result<Image> image = fail(ErrorKind::kLimit, "no grid that was measured fits");
  for (Candidate& c : candidates) {
    Cut one = cut;
    one.grid = grids[c.grid].grid;
    one.lists = grids[c.grid].lists;
    one.owners = std::move(c.owners);
    one.mapping = c.mapping;
    image = pack_image(scene.local, one);
    if (image || image.error().kind != ErrorKind::kLimit) break;
  }
  return image;
}

}  // namespace gridrt
