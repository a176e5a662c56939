#include "host/image/measured_cut.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "host/image/blocks.hpp"
#include "host/image/dealing.hpp"
#include "host/image/even_out.hpp"
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
/// Many boxes are even as they are dealt.
constexpr int kManyBoxes = 512;  // a PE
/// Where copies of triangles do not let them fit: fewer boxes, which are then evened out.
constexpr std::array kFewBoxes{48, 24};
constexpr double kEnough = 1.35;  ///< a grid this much dearer than the best: coarser ones are too

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

struct Candidate {
  std::size_t grid = 0;  ///< index of its grid
  std::vector<std::uint8_t> owners;
  Mapping mapping = Mapping::kMeasured;
  double clocks = 0.0;
};

bool may_fit(const Cut& cut, const VoxelGrid& grid, const VoxelLists& lists) {
  std::uint64_t cells = 0;
  for (std::size_t i = 0; i < grid.cells(); ++i) {
    if (lists.first[i + 1] > lists.first[i]) ++cells;
  }
  return block_total(grid) <= cut.memory.blocks && cells <= cut.memory.cells &&
         lists.references.size() <=
             static_cast<std::uint64_t>(cut.pes) * std::uint64_t{cut.memory.references};
}

/// Finds the grids worth trying and, for each, the dealings that fit.
class Search {
 public:
  explicit Search(const LatticeScene& scene)
      : scene_(scene), sample_(scene.cut.lattice, scene.local.triangles, scene.lights) {}

  Result<void> run();
  Result<Image> pack() const;

 private:
  Result<void> deal(const MeasuredGrid& measured);
  /// Whether it fits; then it is a candidate.
  bool add(const MeasuredGrid& measured, std::vector<std::uint8_t> owners, Mapping mapping);

  const LatticeScene& scene_;
  RaySample sample_;
  std::vector<MeasuredGrid> grids_;
  std::vector<Candidate> candidates_;
  double best_ = std::numeric_limits<double>::infinity();
  double least_ = 0.0;  ///< of the grid at hand, whether it fits or not
};

bool Search::add(const MeasuredGrid& measured, std::vector<std::uint8_t> owners, Mapping mapping) {
  const Cut& cut = scene_.cut;
  const double clocks = estimate_clocks(measured.load, owners, cut.pes);
  least_ = std::min(least_, clocks);
  if (!dealing_fits(scene_.local, cut, measured, owners)) return false;
  candidates_.push_back({grids_.size(), std::move(owners), mapping, clocks});
  return true;
}

Result<void> Search::deal(const MeasuredGrid& measured) {
  const Cut& cut = scene_.cut;
  const auto pes = static_cast<std::size_t>(cut.pes);
  if (cut.mapping != Mapping::kMeasured || measured.grid.cells() <= pes) {
    const Mapping mapping = cut.mapping == Mapping::kMeasured ? Mapping::kBoxes : cut.mapping;
    auto owners = deal_voxels(measured.grid, measured.lists, mapping, cut.pes);
    if (!owners) return std::unexpected(std::move(owners.error()));
    add(measured, std::move(*owners), mapping);
    return {};
  }
  const auto deal_boxes = [&](int boxes) {
    const std::vector<VoxelBox> cuts =
        balanced_boxes(measured.grid, measured.lists, boxes * cut.pes);
    return deal_by_work(measured, cuts, cut.pes);
  };
  if (add(measured, deal_boxes(cut.pes == 1 ? 1 : kManyBoxes), Mapping::kMeasured)) return {};
  if (cut.pes == 1) return {};
  for (const int boxes : kFewBoxes) {
    std::vector<std::uint8_t> owners = deal_boxes(boxes);
    even_out(scene_.local, cut, measured, owners);
    add(measured, std::move(owners), Mapping::kMeasured);
  }
  return {};
}

Result<void> Search::run() {
  const Cut& cut = scene_.cut;
  const std::span<const LatticeTriangle> triangles = scene_.local.triangles;
  const auto most = static_cast<double>(std::min<std::uint64_t>(
      cut.memory.blocks, kBlocksPerTriangle * triangles.size() + kMoreBlocks));
  glm::ivec3 before{0};
  for (const double share : kBlockShares) {
    const glm::ivec3 count = counts_for(cut.lattice, share * most);
    if (count == before) continue;
    before = count;
    const auto grid = make_grid(cut.lattice, triangles.size(), count);
    if (!grid) continue;
    MeasuredGrid measured{*grid, bin_triangles(*grid, triangles, cut.threads), {}, {}};
    if (!may_fit(cut, measured.grid, measured.lists)) continue;
    measured.load = sample_.measure(measured.grid, measured.lists);
    find_shares(triangles, cut.lattice, measured);
    least_ = std::numeric_limits<double>::infinity();
    if (auto dealt = deal(measured); !dealt) return dealt;
    measured.load = {};
    measured.shares = {};
    grids_.push_back(std::move(measured));
    if (least_ > kEnough * best_) break;
    best_ = std::min(best_, least_);
  }
  return {};
}

Result<Image> Search::pack() const {
  const auto best = std::ranges::min_element(candidates_, {}, &Candidate::clocks);
  if (best == candidates_.end()) {
    return fail(ErrorKind::kLimit, "no grid that was measured fits");
  }
  Cut cut = scene_.cut;
  cut.grid = grids_[best->grid].grid;
  cut.lists = grids_[best->grid].lists;
  cut.owners = best->owners;
  cut.mapping = best->mapping;
  return pack_image(scene_.local, cut);
}

}  // namespace

Result<Image> pack_measured(const LatticeScene& scene) {
  Search search(scene);
  if (auto found = search.run(); !found) return std::unexpected(std::move(found.error()));
  return search.pack();
}

}  // namespace gridrt
