// Case 24 with empty space skipped: the skip field of an image may leave out empty voxels, never
// one with references that the segment meets.
#include <algorithm>
#include <cstdio>
#include <vector>

#include <glm/common.hpp>
#include <gtest/gtest.h>

#include "host/grid/traversal.hpp"
#include "host/image/image.hpp"
#include "host/pe/traversal_memory.hpp"
#include "tests/adversarial/bridge.hpp"
#include "tests/adversarial/meshes.hpp"
#include "tests/adversarial/voxel_truth.hpp"

namespace gridrt::adversarial {
namespace {

/// A few small clusters in much empty space.
Scene clusters(Random& random) {
  Scene scene;
  for (int i = random.between(1, 6); i > 0; --i) {
    const glm::vec3 at{random.in_box(glm::dvec3{0.0}, glm::dvec3{1.0})};
    add_scene(scene, soup(random.between(1, 12), 3.0, random),
              static_cast<float>(random.uniform(0.01, 0.15)), at);
  }
  return scene;
}

/// Anywhere, at a cluster, through the corners of blocks along diagonals, or along axes.
Segment skipping_segment(const VoxelGrid& grid, const glm::ivec3& box,
                         const std::vector<glm::ivec3>& occupied, Random& random) {
  Segment s;
  for (int i = 0; i < 3; ++i) {
    const auto face = [&] {
      return std::min(box[i], random.between(0, grid.count[i]) * grid.edge[i]);
    };
    s.p0[i] = random.chance(0.4) ? face() : random.between(0, box[i]);
    s.p1[i] = random.chance(0.4) ? face() : random.between(0, box[i]);
    if (random.chance(0.15)) s.p1[i] = s.p0[i];
  }
  if (random.chance(0.5) && !occupied.empty()) {  // ends at a corner of an occupied voxel
    const glm::ivec3 v = occupied[random.below(occupied.size())];
    const int x = random.between(0, 1);
    const int y = random.between(0, 1);
    s.p1 = glm::min((v + glm::ivec3{x, y, random.between(0, 1)}) * grid.edge, box);
  }
  if (random.chance(0.3)) {  // a diagonal of the cells through p1
    glm::ivec3 way;
    int cells = 1 << 20;
    for (int i = 0; i < 3; ++i) {
      way[i] = random.between(-1, 1) * grid.edge[i];
      if (way[i] > 0) cells = std::min(cells, (box[i] - s.p1[i]) / way[i]);
      if (way[i] < 0) cells = std::min(cells, s.p1[i] / -way[i]);
    }
    if (way != glm::ivec3{0}) s.p0 = s.p1 + way * cells;
  }
  return s;
}

TEST(Case24, SkippingLeavesOutNoVoxelWithReferences) {
  Random random(241);
  std::size_t rays = 0;
  std::size_t slabs = 0;
  std::size_t bare = 0;
  std::size_t met = 0;
  for (int round = 0; round < 100; ++round) {
    const Scene scene = clusters(random);
    ImageOptions options;
    options.bits = random.between(9, 20);
    options.with_scene = false;
    const int x = random.between(1, 40);
    const int y = random.between(1, 40);
    options.grid = glm::ivec3{x, y, random.between(1, 40)};
    const auto image = build_image(scene, options);
    ASSERT_TRUE(image) << image.error().message;
    const auto memory =
        TraversalMemory::decode(image->header, image->find(protocol::SectionKind::kBlocks)->bytes,
                                image->find(protocol::SectionKind::kCells)->bytes);
    ASSERT_TRUE(memory);
    const VoxelGrid grid = image->grid();

    // Occupied voxels as the image has them are those that binning found.
    std::vector<LatticeTriangle> triangles;
    for (const auto& t : truth::snap_scene(scene, options.bits).triangles) {
      triangles.push_back(to_engine(t));
    }
    const VoxelLists lists = bin_triangles(grid, triangles);
    std::vector<glm::ivec3> occupied;
    for (int k = 0; k < grid.count.z; ++k) {
      for (int j = 0; j < grid.count.y; ++j) {
        for (int i = 0; i < grid.count.x; ++i) {
          const glm::ivec3 v{i, j, k};
          const auto count = lists.first[grid.index(v) + 1] - lists.first[grid.index(v)];
          const Cell* cell = memory->find(v);
          ASSERT_EQ(cell == nullptr ? 0U : cell->count, count);
          if (count > 0) occupied.push_back(v);
        }
      }
    }

    std::vector<std::size_t> seen(grid.cells(), 0);
    for (int i = 0; i < 2000; ++i) {
      const Segment s = skipping_segment(grid, image->lattice().box(), occupied, random);
      if (s.is_miss()) continue;
      ++rays;
      bool all_met = true;
      slabs += traverse(
          grid, s.p0, s.p1,
          [&](const glm::ivec3& v, int direction) { return memory->jump(v, direction); },
          [&](const VoxelVisit& v) {
            seen[grid.index(v.voxel)] = rays;
            all_met = all_met && meets(grid, v.voxel, s);
            return true;
          });
      bare += traverse(
          grid, s.p0, s.p1, [](const glm::ivec3&, int) { return 0; },
          [](const VoxelVisit&) { return true; });
      ASSERT_TRUE(all_met);
      for (const glm::ivec3& v : occupied) {
        if (!meets(grid, v, s)) continue;
        ++met;
        ASSERT_EQ(seen[grid.index(v)], rays)
            << "voxel " << v.x << " " << v.y << " " << v.z << " of " << grid.count.x << "x"
            << grid.count.y << "x" << grid.count.z << " (edges " << grid.edge.x << " "
            << grid.edge.y << " " << grid.edge.z << ") from " << s.p0.x << " " << s.p0.y << " "
            << s.p0.z << " to " << s.p1.x << " " << s.p1.y << " " << s.p1.z;
      }
    }
  }
  EXPECT_GT(met, rays / 4);
  EXPECT_LT(2 * slabs, bare);  // something is skipped
  std::printf(
      "case 24, skipping: %zu rays, %zu occupied voxels met, none left out; %zu slabs "
      "instead of %zu\n",
      rays, met, slabs, bare);
}

}  // namespace
}  // namespace gridrt::adversarial
