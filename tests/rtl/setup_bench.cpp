// gridrt_setup against the model, bit for bit, with random stalls at both ends.
#include <deque>
#include <random>

#include <Vgridrt_setup.h>
#include <gtest/gtest.h>

#include "tests/rtl/clocked.hpp"
#include "tests/rtl/march_ports.hpp"
#include "tests/rtl/march_segments.hpp"

namespace gridrt::march {
namespace {

constexpr int kBits = GRIDRT_RTL_B;

struct Ray {
  Segment segment;
  std::uint32_t ignore = 0;
  bool any_hit = false;
};

std::uint64_t packed(const glm::ivec3& p) {
  return static_cast<std::uint64_t>(p.x) | (static_cast<std::uint64_t>(p.y) << kBits) |
         (static_cast<std::uint64_t>(p.z) << (2 * kBits));
}

std::ostream& print(std::ostream& out, const Ray& r) {
  return out << "from " << r.segment.p0.x << " " << r.segment.p0.y << " " << r.segment.p0.z
             << " to " << r.segment.p1.x << " " << r.segment.p1.y << " " << r.segment.p1.z;
}

void check(Vgridrt_setup& rtl, const Grid& grid, const Ray& ray) {
  const Segment& s = ray.segment;
  ASSERT_EQ(rtl.p0_o, packed(s.p0));
  ASSERT_EQ(rtl.ignore_o, ray.ignore);
  ASSERT_EQ(rtl.any_hit_o, ray.any_hit);
  ASSERT_EQ(rtl.miss_o, s.p0 == s.p1);
  for (int a = 0; a < 3; ++a) {
    const auto d = static_cast<std::int64_t>(rtl::get_bits(rtl.d_o, a * (kBits + 1), kBits + 1));
    ASSERT_EQ((d >> kBits) != 0 ? d - (std::int64_t{2} << kBits) : d, s.p1[a] - s.p0[a]);
  }
  if (s.p0 == s.p1) return;
  const State expected = setup(grid, s.p0, s.p1);
  const State got = get_state(rtl.start_o);
  ASSERT_EQ(rtl.length_o, std::abs(s.p1[expected.axis] - s.p0[expected.axis]));
  EXPECT_EQ(got.axis, expected.axis);
  EXPECT_EQ(got.neg, expected.neg);
  EXPECT_EQ(got.block, expected.block);
  EXPECT_EQ(got.slabs, expected.slabs);
  EXPECT_EQ(got.first, expected.first);
  EXPECT_EQ(got.last, expected.last);
  EXPECT_EQ(got.enter, expected.enter);
  for (std::size_t n = 0; n < 2; ++n) {
    EXPECT_EQ(got.lateral[n].h, expected.lateral[n].h);
    EXPECT_EQ(got.lateral[n].low, expected.lateral[n].low);
    EXPECT_EQ(got.lateral[n].r, expected.lateral[n].r);
    EXPECT_EQ(got.lateral[n].m, expected.lateral[n].m);
    EXPECT_EQ(got.lateral[n].lim, expected.lateral[n].lim);
  }
}

class Setup : public testing::TestWithParam<std::pair<int, int>> {};

TEST_P(Setup, EqualsTheModel) {
  const auto [offer, take] = GetParam();  // percent of clocks
  rtl::Clocked<Vgridrt_setup> rtl;
  Random random(5);
  rtl->ray_valid_i = 0;
  rtl->out_ready_i = 0;
  rtl.reset();
  long rays = 0;
  long clocks = 0;
  for (const Case& c : hard_grids(kBits)) {
    const Grid grid = make_march_grid(c.grid);
    put_grid(rtl->grid_i, grid);
    std::deque<Ray> expected;
    int left = 300;
    bool offered = false;
    Ray ray;
    while (left > 0 || !expected.empty()) {
      if (!offered && left > 0 && random.between(0, 99) < offer) {
        ray.segment = hard_segment(random, c);
        if (random.chance(0.02)) ray.segment.p1 = ray.segment.p0;
        ray.ignore = static_cast<std::uint32_t>(random.below(1U << 20U));
        ray.any_hit = random.chance(0.5);
        offered = true;
      }
      rtl->ray_valid_i = offered;
      rtl->p0_i = packed(offered ? ray.segment.p0 : glm::ivec3{1, 2, 3});
      rtl->p1_i = packed(offered ? ray.segment.p1 : glm::ivec3{3, 1, 2});
      rtl->ignore_i = ray.ignore;
      rtl->any_hit_i = ray.any_hit;
      rtl->out_ready_i = random.between(0, 99) < take;
      rtl.settle();
      if (rtl->out_valid_o) {
        ASSERT_FALSE(expected.empty());
        check(*rtl, grid, expected.front());
        if (HasFailure()) {
          print(std::cerr, expected.front()) << "\n";
          return;
        }
        if (rtl->out_ready_i) expected.pop_front();
      }
      if (offered && rtl->ray_ready_o) {
        expected.push_back(ray);
        offered = false;
        --left;
        ++rays;
      }
      rtl.tick();
      ++clocks;
    }
  }
  if (offer == 100 && take == 100) {
    // One ray in two clocks, but for the pipeline's length once a grid.
    EXPECT_LT(clocks, 2 * rays + 40 * static_cast<long>(hard_grids(kBits).size()));
  }
}

INSTANTIATE_TEST_SUITE_P(Stalls, Setup,
                         testing::Values(std::pair{100, 100}, std::pair{60, 100}, std::pair{90, 40},
                                         std::pair{30, 80}));

}  // namespace
}  // namespace gridrt::march
