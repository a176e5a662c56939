#include "host/image/dealing.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <glm/geometric.hpp>

#include "host/grid/partition.hpp"

namespace gridrt {
namespace {

constexpr int kPasses = 6;
constexpr int kRounds = 4;
/// A PE may get this much more than an even share by taking a voxel.
constexpr float kUneven = 1.05F;

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

void add(Shares& sum, const Shares& part, float sign = 1.0F) {
  for (std::size_t g = 0; g < sum.size(); ++g) sum[g] += sign * part[g];
}

Shares shares_of(const MeasuredGrid& measured, const VoxelBox& box) {
  Shares sums{};
  for (int z = box.lo.z; z < box.hi.z; ++z) {
    for (int y = box.lo.y; y < box.hi.y; ++y) {
      for (int x = box.lo.x; x < box.hi.x; ++x) {
        const std::size_t i = measured.grid.index({x, y, z});
        if (measured.lists.first[i + 1] > measured.lists.first[i]) add(sums, measured.shares[i]);
      }
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
        shares_(static_cast<std::size_t>(pes), Shares{}) {
    for (std::size_t i = 0; i < owners.size(); ++i) {
      for (const VoxelReference& r : list(i)) ++held_[r.triangle][owners[i]];
      add(shares_[owners[i]], measured.shares[i]);
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
    const Shares& share = measured_.shares[voxel];
    int least = spared;
    std::uint8_t best = from;
    for (std::size_t pe = 0; pe < shares_.size(); ++pe) {
      const auto to = static_cast<std::uint8_t>(pe);
      if (to == from) continue;
      int made = 0;
      for (const VoxelReference& r : references) made += held_[r.triangle][to] == 0 ? 1 : 0;
      if (made < least && stays_even(from, to, share)) {
        least = made;
        best = to;
      }
    }
    if (best == from) return false;
    for (const VoxelReference& r : references) {
      --held_[r.triangle][from];
      ++held_[r.triangle][best];
    }
    add(shares_[from], share, -1.0F);
    add(shares_[best], share);
    owners_[voxel] = best;
    return true;
  }

 private:
  [[nodiscard]] std::span<const VoxelReference> list(std::size_t voxel) const {
    const auto& first = measured_.lists.first;
    return std::span(measured_.lists.references)
        .subspan(first[voxel], first[voxel + 1] - first[voxel]);
  }

  [[nodiscard]] bool stays_even(std::uint8_t from, std::uint8_t to, const Shares& share) const {
    const float even = 1.0F / static_cast<float>(shares_.size());
    for (std::size_t g = 0; g < share.size(); ++g) {
      const float after = shares_[to][g] + share[g];
      if (after > kUneven * even && after > shares_[from][g]) return false;
    }
    return true;
  }

  const MeasuredGrid& measured_;
  std::vector<std::uint8_t>& owners_;
  std::vector<std::array<std::uint32_t, 4>> held_;  ///< voxels by triangle and PE
  std::vector<Shares> shares_;                      ///< by PE
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

void find_shares(std::span<const LatticeTriangle> triangles, const Lattice& lattice,
                 MeasuredGrid& measured) {
  std::array<glm::dvec3, kFacings> directions{};
  std::size_t count = 0;
  for (int i = 0; i < 27; ++i) {
    const glm::dvec3 d{i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1};
    if (i != 13) directions[count++] = glm::normalize(d);
  }
  std::vector<std::array<float, kFacings>> facing(triangles.size());
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const auto& v = triangles[t].v;
    glm::dvec3 n = glm::cross(glm::dvec3{v[1] - v[0]}, glm::dvec3{v[2] - v[0]});
    // To the scene's own shape, but for a scale: the lattice may stretch its axes.
    for (int a = 0; a < 3; ++a) n[a] = std::ldexp(n[a], lattice.scale[a] - lattice.scale[0]);
    const double length = glm::length(n);
    for (std::size_t d = 0; d < kFacings; ++d) {
      const double cosine = length > 0.0 ? std::max(0.0, glm::dot(n, directions[d]) / length) : 0.0;
      facing[t][d] = static_cast<float>(cosine * cosine * cosine * cosine);
    }
  }
  measured.shares.assign(measured.grid.cells(), Shares{});
  Shares total{};
  const auto& first = measured.lists.first;
  for (std::size_t i = 0; i < measured.shares.size(); ++i) {
    if (first[i] == first[i + 1]) continue;
    Shares& share = measured.shares[i];
    for (std::size_t g = 0; g < kRayGroups; ++g) share[g] = measured.load.work[g][i];
    for (std::uint64_t k = first[i]; k < first[i + 1]; ++k) {
      const auto& f = facing[measured.lists.references[k].triangle];
      for (std::size_t d = 0; d < kFacings; ++d) share[kRayGroups + d] += f[d];
    }
    add(total, share);
  }
  for (float& t : total) t = t > 0.0F ? 1.0F / t : 0.0F;
  for (Shares& share : measured.shares) {
    for (std::size_t g = 0; g < share.size(); ++g) share[g] *= total[g];
  }
}

std::vector<std::uint8_t> deal_by_work(const MeasuredGrid& measured,
                                       std::span<const VoxelBox> boxes, int pes) {
  static constexpr std::array<Order, 24> kOrders = orders_of_four();
  const auto width = static_cast<std::size_t>(pes);
  std::vector<Shares> shares(boxes.size());
  for (std::size_t i = 0; i < boxes.size(); ++i) shares[i] = shares_of(measured, boxes[i]);
  std::vector<Shares> held(width, Shares{});
  std::vector<std::uint8_t> dealt(boxes.size(), 0);
  // Each run in turn, given the others; the first ones could not know the last ones.
  for (int round = 0; round < kRounds; ++round) {
    for (std::size_t first = 0; first < boxes.size(); first += width) {
      const std::size_t count = std::min(width, boxes.size() - first);
      std::array<std::array<float, 4>, 4> uneven{};  // by box and PE
      for (std::size_t i = first; i < first + count; ++i) {
        if (round > 0) add(held[dealt[i]], shares[i], -1.0F);
      }
      for (std::size_t i = 0; i < count; ++i) {
        for (std::size_t p = 0; p < width; ++p) {
          for (std::size_t g = 0; g < held[p].size(); ++g) {
            uneven[i][p] += held[p][g] * shares[first + i][g];
          }
        }
      }
      const Order* best = nullptr;
      float least = 0.0F;
      for (const Order& order : kOrders) {
        if (std::any_of(order.begin(), order.begin() + pes, [&](int p) { return p >= pes; })) {
          continue;
        }
        float sum = 0.0F;
        for (std::size_t i = 0; i < count; ++i) sum += uneven[i][order[i]];
        if (best == nullptr || sum < least) {
          best = &order;
          least = sum;
        }
      }
      for (std::size_t i = 0; i < count; ++i) {
        dealt[first + i] = (*best)[i];
        add(held[(*best)[i]], shares[first + i]);
      }
    }
  }
  std::vector<std::uint8_t> owners(measured.grid.cells(), 0);
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    give_box(measured.grid, boxes[i], dealt[i], owners);
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
