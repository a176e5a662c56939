#include "host/image/dealing.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <glm/geometric.hpp>

#include "host/grid/partition.hpp"

namespace gridrt {
namespace {

constexpr int kRounds = 4;

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

template <class Visit>
void for_each_voxel(const VoxelGrid& grid, const VoxelBox& box, const Visit& visit) {
  for (int z = box.lo.z; z < box.hi.z; ++z) {
    for (int y = box.lo.y; y < box.hi.y; ++y) {
      for (int x = box.lo.x; x < box.hi.x; ++x) visit(grid.index({x, y, z}));
    }
  }
}

Shares shares_of(const MeasuredGrid& measured, const VoxelBox& box) {
  Shares sums{};
  for_each_voxel(measured.grid, box, [&](std::size_t i) {
    if (measured.lists.first[i + 1] > measured.lists.first[i]) add(sums, measured.shares[i]);
  });
  return sums;
}

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
  }
  const std::vector<VoxelBox> regions =
      balanced_boxes(measured.grid, measured.lists, static_cast<int>(kRegions));
  for (std::size_t r = 0; r < std::min(regions.size(), kRegions); ++r) {
    for_each_voxel(measured.grid, regions[r], [&](std::size_t i) {
      measured.shares[i][kRayGroups + kFacings + r] = static_cast<float>(first[i + 1] - first[i]);
    });
  }
  for (const Shares& share : measured.shares) add(total, share);
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

}  // namespace gridrt
