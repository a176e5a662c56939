#include "host/image/dealing.hpp"

#include <algorithm>
#include <array>

#include "host/grid/partition.hpp"

namespace gridrt {
namespace {

constexpr int kPasses = 6;
/// A PE may get this much more than its share of a group's work by taking a voxel.
constexpr double kUneven = 1.05;

using GroupSums = std::array<double, kRayGroups>;
using Order = std::array<std::uint8_t, 4>;

constexpr std::array<Order, 24> orders_of_four() {
  std::array<Order, 24> all{};
  Order p{0, 1, 2, 3};
  for (Order& one : all) {
    one = p;
    std::ranges::next_permutation(p);
  }
  return all;
}

GroupSums work_of(const MeasuredGrid& measured, std::size_t first, std::size_t last) {
  GroupSums sums{};
  for (std::size_t g = 0; g < kRayGroups; ++g) {
    for (std::size_t i = first; i < last; ++i) sums[g] += measured.load.work[g][i];
  }
  return sums;
}

void add(GroupSums& sum, const GroupSums& part, double sign = 1.0) {
  for (std::size_t g = 0; g < kRayGroups; ++g) sum[g] += sign * part[g];
}

GroupSums work_of(const MeasuredGrid& measured, const VoxelBox& box) {
  GroupSums sums{};
  for (int z = box.lo.z; z < box.hi.z; ++z) {
    for (int y = box.lo.y; y < box.hi.y; ++y) {
      const std::size_t first = measured.grid.index({box.lo.x, y, z});
      add(sums, work_of(measured, first, first + static_cast<std::size_t>(box.hi.x - box.lo.x)));
    }
  }
  return sums;
}

/// How many voxels of each PE refer to each triangle, and what follows.
class Holdings {
 public:
  Holdings(const MeasuredGrid& measured, std::size_t triangles, int pes,
           std::vector<std::uint8_t>& owners)
      : measured_(measured),
        owners_(owners),
        held_(triangles),
        work_(static_cast<std::size_t>(pes)) {
    for (std::size_t i = 0; i < owners.size(); ++i) {
      for (const VoxelReference& r : list(i)) ++held_[r.triangle][owners[i]];
      const GroupSums work = work_of(measured, i, i + 1);
      add(work_[owners[i]], work);
      add(total_, work);
    }
  }

  /// Moves the voxel where it spares most copies, if anywhere; true if it has been moved.
  bool move(std::size_t voxel) {
    const std::span<const VoxelReference> references = list(voxel);
    if (references.empty()) return false;
    const std::uint8_t from = owners_[voxel];
    int spared = 0;
    for (const VoxelReference& r : references) spared += held_[r.triangle][from] == 1 ? 1 : 0;
    if (spared == 0) return false;
    const GroupSums work = work_of(measured_, voxel, voxel + 1);
    int least = spared;
    std::uint8_t best = from;
    for (std::uint8_t to = 0; to < work_.size(); ++to) {
      if (to == from) continue;
      int made = 0;
      for (const VoxelReference& r : references) made += held_[r.triangle][to] == 0 ? 1 : 0;
      if (made < least && stays_even(from, to, work)) {
        least = made;
        best = to;
      }
    }
    if (best == from) return false;
    for (const VoxelReference& r : references) {
      --held_[r.triangle][from];
      ++held_[r.triangle][best];
    }
    add(work_[from], work, -1.0);
    add(work_[best], work);
    owners_[voxel] = best;
    return true;
  }

 private:
  [[nodiscard]] std::span<const VoxelReference> list(std::size_t voxel) const {
    const auto& first = measured_.lists.first;
    return std::span(measured_.lists.references)
        .subspan(first[voxel], first[voxel + 1] - first[voxel]);
  }

  [[nodiscard]] bool stays_even(std::uint8_t from, std::uint8_t to, const GroupSums& work) const {
    for (std::size_t g = 0; g < kRayGroups; ++g) {
      const double after = work_[to][g] + work[g];
      const double share = total_[g] / static_cast<double>(work_.size());
      if (after > kUneven * share && after > work_[from][g]) return false;
    }
    return true;
  }

  const MeasuredGrid& measured_;
  std::vector<std::uint8_t>& owners_;
  std::vector<std::array<std::uint32_t, 4>> held_;  ///< voxels by triangle and PE
  std::vector<GroupSums> work_;                     ///< by PE
  GroupSums total_{};
};

}  // namespace

bool dealing_fits(const LocalTriangles& local, const Cut& cut, const MeasuredGrid& measured,
                  std::span<const std::uint8_t> owners) {
  std::vector<std::uint8_t> triangle_in(local.triangles.size(), 0);  // a bit for each PE
  std::vector<std::uint8_t> vertex_in(local.vertices.size(), 0);
  std::vector<std::uint64_t> references(static_cast<std::size_t>(cut.pes), 0);
  std::vector<std::uint64_t> triangles = references;
  std::vector<std::uint64_t> vertices = references;
  const auto& first = measured.lists.first;
  for (std::size_t i = 0; i < owners.size(); ++i) {
    const std::uint8_t pe = owners[i];
    const auto bit = static_cast<std::uint8_t>(1U << pe);
    references[pe] += first[i + 1] - first[i];
    for (std::uint64_t k = first[i]; k < first[i + 1]; ++k) {
      const std::uint32_t t = measured.lists.references[k].triangle;
      if ((triangle_in[t] & bit) != 0) continue;
      triangle_in[t] |= bit;
      ++triangles[pe];
      for (const std::uint32_t v : local.corners[t]) {
        if ((vertex_in[v] & bit) == 0) ++vertices[pe];
        vertex_in[v] |= bit;
      }
    }
  }
  return std::ranges::max(references) <= cut.memory.references &&
         std::ranges::max(triangles) <= cut.memory.triangles &&
         std::ranges::max(vertices) <= cut.memory.vertices;
}

std::vector<std::uint8_t> deal_by_work(const MeasuredGrid& measured,
                                       std::span<const VoxelBox> boxes, int pes) {
  static constexpr std::array<Order, 24> kOrders = orders_of_four();
  const auto width = static_cast<std::size_t>(pes);
  std::vector<GroupSums> held(width, GroupSums{});
  std::vector<std::uint8_t> owners(measured.grid.cells(), 0);
  for (std::size_t first = 0; first < boxes.size(); first += width) {
    const std::size_t count = std::min(width, boxes.size() - first);
    std::array<GroupSums, 4> work{};
    for (std::size_t i = 0; i < count; ++i) work[i] = work_of(measured, boxes[first + i]);
    const Order* best = nullptr;
    double least = 0.0;
    for (const Order& order : kOrders) {
      if (std::any_of(order.begin(), order.begin() + pes, [&](int p) { return p >= pes; })) {
        continue;
      }
      double uneven = 0.0;
      for (std::size_t i = 0; i < count; ++i) {
        for (std::size_t g = 0; g < kRayGroups; ++g) uneven += held[order[i]][g] * work[i][g];
      }
      if (best == nullptr || uneven < least) {
        best = &order;
        least = uneven;
      }
    }
    for (std::size_t i = 0; i < count; ++i) {
      add(held[(*best)[i]], work[i]);
      give_box(measured.grid, boxes[first + i], (*best)[i], owners);
    }
  }
  return owners;
}

bool spare_copies(const LocalTriangles& local, const Cut& cut, const MeasuredGrid& measured,
                  std::vector<std::uint8_t>& owners) {
  Holdings holdings(measured, local.triangles.size(), cut.pes, owners);
  for (int pass = 0; pass < kPasses; ++pass) {
    bool moved = false;
    for (std::size_t i = 0; i < owners.size(); ++i) moved = holdings.move(i) || moved;
    if (dealing_fits(local, cut, measured, owners)) return true;
    if (!moved) return false;
  }
  return false;
}

}  // namespace gridrt
