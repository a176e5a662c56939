// The skip field: against its definition, and against marches that skip nothing.
#include <algorithm>
#include <random>
#include <set>

#include <gtest/gtest.h>

#include "host/grid/traversal.hpp"
#include "host/image/blocks.hpp"

namespace gridrt {
namespace {

std::size_t index_of(const glm::ivec3& blocks, const glm::ivec3& b) {
  const auto row = static_cast<std::size_t>(b.z * blocks.y + b.y);
  return row * static_cast<std::size_t>(blocks.x) + static_cast<std::size_t>(b.x);
}

/// The definition in blocks.hpp, block by block.
int slow_jump(const glm::ivec3& blocks, const std::vector<std::uint8_t>& occupancy,
              const glm::ivec3& from, int direction) {
  const int axis = direction / 2;
  const int e = (axis + 1) % 3;
  const int f = (axis + 2) % 3;
  for (int i = 0; i < 7; ++i) {
    for (int a = -(i + 1); a <= i + 1; ++a) {
      for (int b = -(i + 1); b <= i + 1; ++b) {
        glm::ivec3 at = from;
        at[axis] += direction % 2 == 0 ? i : -i;
        at[e] += a;
        at[f] += b;
        const bool inside = at.x >= 0 && at.y >= 0 && at.z >= 0 && at.x < blocks.x &&
                            at.y < blocks.y && at.z < blocks.z;
        if (inside && occupancy[index_of(blocks, at)] != 0) return i;
      }
    }
  }
  return 7;
}

TEST(SkipField, IsWhatItsDefinitionSays) {
  for (unsigned seed = 0; seed < 60; ++seed) {
    std::mt19937 random(seed);
    const glm::ivec3 blocks{static_cast<int>(1 + random() % 12), static_cast<int>(1 + random() % 9),
                            static_cast<int>(1 + random() % 17)};
    std::vector<std::uint8_t> occupancy(static_cast<std::size_t>(blocks.x * blocks.y * blocks.z));
    const unsigned sparsity = 2U << (seed % 9);
    for (auto& o : occupancy) o = static_cast<std::uint8_t>(random() % sparsity == 0 ? 0x10 : 0);
    const std::vector<Jumps> jumps = skip_field(blocks, occupancy);
    for (int z = 0; z < blocks.z; ++z) {
      for (int y = 0; y < blocks.y; ++y) {
        for (int x = 0; x < blocks.x; ++x) {
          for (int d = 0; d < 6; ++d) {
            ASSERT_EQ(jumps[index_of(blocks, {x, y, z})][static_cast<std::size_t>(d)],
                      slow_jump(blocks, occupancy, {x, y, z}, d))
                << "seed " << seed << " block " << x << " " << y << " " << z << " direction " << d;
          }
        }
      }
    }
  }
}

TEST(SkipField, EmptyGridJumpsAll) {
  const std::vector<std::uint8_t> occupancy(8, 0);
  for (const Jumps& j : skip_field({2, 2, 2}, occupancy)) {
    for (const std::uint8_t jump : j) EXPECT_EQ(jump, kMaxJump);
  }
}

VoxelLists lists_of(const VoxelGrid& grid, const std::set<std::size_t>& occupied) {
  VoxelLists lists;
  lists.first.assign(grid.cells() + 1, 0);
  for (std::size_t c = 0; c < grid.cells(); ++c) {
    lists.first[c + 1] = lists.first[c] + (occupied.contains(c) ? 1 : 0);
  }
  lists.references.resize(lists.first.back(), {0, kAllQuarters});
  return lists;
}

TEST(BlockOccupancy, SetsTheBitsOfItsVoxels) {
  const VoxelGrid grid{{3, 5, 2}, {4, 4, 4}, 1};
  EXPECT_EQ(block_count(grid), glm::ivec3(2, 3, 1));
  const glm::ivec3 voxel{1, 4, 1};
  const auto occupancy = block_occupancy(grid, lists_of(grid, {grid.index(voxel)}));
  ASSERT_EQ(occupancy.size(), 6U);
  for (std::size_t i = 0; i < 6; ++i) EXPECT_EQ(occupancy[i], i == 4 ? 1U << 5U : 0U);
  EXPECT_EQ(block_voxel({0, 2, 0}, 5), voxel);
}

/// Skipping must visit every occupied voxel that the full march visits, in the same order.
TEST(SkipField, LosesNoVoxelOnAnyMarch) {
  for (unsigned seed = 0; seed < 200; ++seed) {
    std::mt19937 random(seed);
    VoxelGrid grid;
    for (int a = 0; a < 3; ++a) {
      grid.count[a] = static_cast<int>(1 + random() % 30);
      grid.edge[a] = static_cast<int>(4 + random() % 9);
    }
    const glm::ivec3 box = grid.count * grid.edge;
    std::set<std::size_t> occupied;
    for (std::size_t i = 0, n = 1 + random() % 40; i < n; ++i) {
      occupied.insert(random() % grid.cells());
    }
    const glm::ivec3 blocks = block_count(grid);
    const std::vector<Jumps> jumps =
        skip_field(blocks, block_occupancy(grid, lists_of(grid, occupied)));
    const auto coordinate = [&](int a) {
      // On faces between blocks and in corners as often as anywhere.
      const int q = static_cast<int>(random() % static_cast<unsigned>(box[a] + 1));
      return random() % 2 == 0 ? q / (2 * grid.edge[a]) * (2 * grid.edge[a]) : q;
    };
    std::uint64_t skipped_steps = 0;
    std::uint64_t all_steps = 0;
    for (int ray = 0; ray < 200; ++ray) {
      const glm::ivec3 p0{coordinate(0), coordinate(1), coordinate(2)};
      const glm::ivec3 p1{coordinate(0), coordinate(1), coordinate(2)};
      if (p0 == p1) continue;
      std::vector<std::size_t> expected;
      std::vector<std::size_t> got;
      const auto collect = [&](std::vector<std::size_t>& out) {
        return [&](const VoxelVisit& visit) {
          const std::size_t cell = grid.index(visit.voxel);
          if (occupied.contains(cell)) out.push_back(cell);
          return true;
        };
      };
      all_steps +=
          traverse(grid, p0, p1, [](const glm::ivec3&, int) { return 0; }, collect(expected));
      skipped_steps += traverse(
          grid, p0, p1,
          [&](const glm::ivec3& v, int d) {
            return int{jumps[index_of(blocks, v / 2)][static_cast<std::size_t>(d)]};
          },
          collect(got));
      ASSERT_EQ(got, expected) << "seed " << seed << " ray " << ray;
    }
    EXPECT_LE(skipped_steps, all_steps);
  }
}

}  // namespace
}  // namespace gridrt
