#include "host/image/even_out.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "host/image/uniform.hpp"

namespace gridrt {
namespace {

constexpr std::size_t kPes = 4;
constexpr int kSweeps = 120;
/// Costs that a move may add, at the first sweep and at the last one. A dealing in which a PE has
/// a tenth more than its share of everything costs 0.1, a voxel more 1e-3 or so.
constexpr double kHot = 1e-3;
constexpr double kCold = 1e-6;
/// What a memory that is too full costs, by the part of it that lacks; against shares that are
/// uneven.
constexpr double kOverfull = 4.0;
constexpr double kFull = 0.998;  ///< some room, so that the end of the way fits
/// If it does not fit by then: what that costs in further sweeps, as long as they help within a
/// few.
constexpr double kMendOverfull = 64.0;
constexpr int kMends = 40;
constexpr int kFewMends = 6;
/// A group of rays against a facing or a region; regions are many, each of few voxels and so
/// uneven.
constexpr float kRayWeight = 60.0F;
constexpr double kFar = 0.05;  ///< part of the moves that go to any PE

struct Load {
  double references = 0.0;
  double triangles = 0.0;
  double vertices = 0.0;
};

class Annealer {
 public:
  Annealer(const LocalTriangles& local, const Cut& cut, const MeasuredGrid& measured,
           std::vector<std::uint8_t>& owners)
      : local_(local),
        cut_(cut),
        measured_(measured),
        owners_(owners),
        triangle_voxels_(local.triangles.size()),
        vertex_triangles_(local.vertices.size()) {
    for (std::size_t i = 0; i < owners.size(); ++i) {
      if (list(i).empty()) continue;
      voxels_.push_back(i);
      put(i, owners[i]);
    }
  }

  void run() {
    const double cooling = std::pow(kCold / kHot, 1.0 / (kSweeps - 1));
    double heat = kHot;
    for (int i = 0; i < kSweeps; ++i, heat *= cooling) sweep(heat);
    mend();
  }

 private:
  [[nodiscard]] std::span<const VoxelReference> list(std::size_t voxel) const {
    const auto& first = measured_.lists.first;
    return std::span(measured_.lists.references)
        .subspan(first[voxel], first[voxel + 1] - first[voxel]);
  }

  void sweep(double heat) {
    for (std::size_t n = 0; n < voxels_.size(); ++n) {
      const auto pick = static_cast<std::size_t>(uniform_() * static_cast<double>(voxels_.size()));
      const std::size_t voxel = voxels_[pick];
      const std::optional<std::size_t> to = target(voxel);
      if (to) try_move(voxel, *to, -heat * std::log(1.0 - uniform_()));
    }
  }

  void mend() {
    overfull_cost_ = kMendOverfull;
    double least = std::numeric_limits<double>::infinity();
    for (int i = 0, since = 0; i < kMends && since < kFewMends && !fits(); ++i, ++since) {
      sweep(kCold);
      double over = 0.0;
      for (std::size_t pe = 0; pe < kPes; ++pe) over += overfull(pe);
      if (over < least) since = 0;
      least = std::min(least, over);
    }
  }

  [[nodiscard]] bool fits() const {
    return std::ranges::all_of(load_, [this](const Load& l) {
      return l.references <= cut_.memory.references && l.triangles <= cut_.memory.triangles &&
             l.vertices <= cut_.memory.vertices;
    });
  }

  /// A PE to which the voxel may go.
  std::optional<std::size_t> target(std::size_t voxel) {
    const std::optional<std::size_t> to =
        uniform_() < kFar ? static_cast<std::size_t>(uniform_() * cut_.pes) : neighbour(voxel);
    return to == owners_[voxel] ? std::nullopt : to;
  }

  /// The PE of a voxel beside it, on a side picked at random.
  std::optional<std::size_t> neighbour(std::size_t voxel) {
    const glm::ivec3 count = measured_.grid.count;
    const std::array<std::size_t, 3> stride{
        1, static_cast<std::size_t>(count.x),
        static_cast<std::size_t>(count.x) * static_cast<std::size_t>(count.y)};
    const auto side = static_cast<std::size_t>(uniform_() * 6.0);
    const std::size_t axis = side / 2;
    const auto size = static_cast<std::size_t>(count[static_cast<int>(axis)]);
    const std::size_t at = voxel / stride[axis] % size;
    if (side % 2 == 0 ? at == 0 : at + 1 == size) return {};
    const std::size_t next = side % 2 == 0 ? voxel - stride[axis] : voxel + stride[axis];
    if (list(next).empty()) return {};
    return owners_[next];
  }

  [[nodiscard]] double overfull(std::size_t pe) const {
    const auto over = [](double held, double most) {
      return std::max(0.0, held / (kFull * most) - 1.0);
    };
    const Load& l = load_[pe];
    return overfull_cost_ *
           (over(l.references, cut_.memory.references) + over(l.triangles, cut_.memory.triangles) +
            over(l.vertices, cut_.memory.vertices));
  }

  /// How much less even the shares get: the weighted sum of their squares.
  [[nodiscard]] double unevenness(std::size_t voxel, std::size_t from, std::size_t to) const {
    const Shares& v = measured_.shares[voxel];
    const auto sum_of = [&](std::size_t first, std::size_t end) {
      float sum = 0.0F;
      for (std::size_t g = first; g < end; ++g) {
        sum += v[g] * (shares_[to][g] - shares_[from][g] + v[g]);
      }
      return sum;
    };
    const float sum = kRayWeight * sum_of(0, kRayGroups) + sum_of(kRayGroups, v.size());
    return 2.0 * static_cast<double>(sum) * static_cast<double>(cut_.pes) /
           static_cast<double>(v.size());
  }

  void put(std::size_t voxel, std::size_t pe) {
    Load& load = load_[pe];
    for (const VoxelReference& r : list(voxel)) {
      load.references += 1.0;
      if (triangle_voxels_[r.triangle][pe]++ != 0) continue;
      load.triangles += 1.0;
      for (const std::uint32_t v : local_.corners[r.triangle]) {
        if (vertex_triangles_[v][pe]++ == 0) load.vertices += 1.0;
      }
    }
    for (std::size_t g = 0; g < shares_[pe].size(); ++g) {
      shares_[pe][g] += measured_.shares[voxel][g];
    }
  }

  void take(std::size_t voxel, std::size_t pe) {
    Load& load = load_[pe];
    for (const VoxelReference& r : list(voxel)) {
      load.references -= 1.0;
      if (--triangle_voxels_[r.triangle][pe] != 0) continue;
      load.triangles -= 1.0;
      for (const std::uint32_t v : local_.corners[r.triangle]) {
        if (--vertex_triangles_[v][pe] == 0) load.vertices -= 1.0;
      }
    }
    for (std::size_t g = 0; g < shares_[pe].size(); ++g) {
      shares_[pe][g] -= measured_.shares[voxel][g];
    }
  }

  void try_move(std::size_t voxel, std::size_t to, double allowance) {
    const std::size_t from = owners_[voxel];
    const double uneven = unevenness(voxel, from, to);
    const double before = overfull(from) + overfull(to);
    // Memories that have room can only get fuller.
    if (before == 0.0 && uneven > allowance) return;
    take(voxel, from);
    put(voxel, to);
    if (uneven + overfull(from) + overfull(to) - before <= allowance) {
      owners_[voxel] = static_cast<std::uint8_t>(to);
      return;
    }
    take(voxel, to);
    put(voxel, from);
  }

  const LocalTriangles& local_;
  const Cut& cut_;
  const MeasuredGrid& measured_;
  std::vector<std::uint8_t>& owners_;
  std::vector<std::size_t> voxels_;                                ///< with references
  std::vector<std::array<std::uint16_t, kPes>> triangle_voxels_;   ///< that refer to it, by PE
  std::vector<std::array<std::uint16_t, kPes>> vertex_triangles_;  ///< with this corner, by PE
  std::array<Load, kPes> load_{};
  double overfull_cost_ = kOverfull;
  std::array<Shares, kPes> shares_{};
  Uniform uniform_;
};

}  // namespace

void even_out(const LocalTriangles& local, const Cut& cut, const MeasuredGrid& measured,
              std::vector<std::uint8_t>& owners) {
  Annealer(local, cut, measured, owners).run();
}

}  // namespace gridrt
