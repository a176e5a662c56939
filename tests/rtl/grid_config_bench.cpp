// gridrt_grid_config: all constants of a grid, for random and for extreme counts and edges.
#include <random>

#include <Vgridrt_grid_config.h>
#include <gtest/gtest.h>

#include "tests/rtl/clocked.hpp"
#include "tests/rtl/march_ports.hpp"
#include "tests/rtl/march_segments.hpp"

namespace gridrt::march {
namespace {

TEST(GridConfig, ComputesAllConstants) {
  rtl::Clocked<Vgridrt_grid_config> rtl;
  Random random(3);
  rtl->start_i = 0;
  rtl.reset();
  EXPECT_EQ(rtl->done_o, 0);
  std::vector<VoxelGrid> grids;
  for (const int bits : {12, 14, 17}) {
    for (const Case& c : hard_grids(bits)) grids.push_back(c.grid);
  }
  VoxelGrid widest;
  widest.edge = glm::ivec3{1 << 17};
  grids.push_back(widest);
  for (int i = 0; i < 1000; ++i) {
    VoxelGrid g;
    g.count = {random.between(1, 40), random.between(1, 40), random.between(1, 20)};
    g.edge = {random.between(1, 3000), random.between(1, 3000), random.between(1, 3000)};
    grids.push_back(g);
  }
  for (const VoxelGrid& g : grids) {
    const Grid expected = make_march_grid(g);
    rtl->count_i = 0;
    for (int a = 0; a < 3; ++a) rtl->count_i |= static_cast<unsigned>(g.count[a]) << (10 * a);
    rtl->edge_i = 0;
    for (int a = 0; a < 3; ++a) rtl->edge_i |= static_cast<std::uint64_t>(g.edge[a]) << (18 * a);
    rtl->start_i = 1;
    rtl.tick();
    rtl->start_i = 0;
    rtl.settle();
    EXPECT_EQ(rtl->done_o, 0);
    int clocks = 0;
    while (!rtl->done_o && clocks < 40) {
      rtl.tick();
      ++clocks;
    }
    ASSERT_EQ(rtl->done_o, 1) << "still computing after 40 clocks";
    auto words = rtl->grid_o;
    put_grid(words, expected);
    for (std::size_t i = 0; i < 6; ++i) {
      ASSERT_EQ(rtl->grid_o[i], words[i])
          << "grid " << g.count.x << "x" << g.count.y << "x" << g.count.z;
    }
    for (int wait = random.between(0, 3); wait > 0; --wait) rtl.tick();
  }
}

}  // namespace
}  // namespace gridrt::march
