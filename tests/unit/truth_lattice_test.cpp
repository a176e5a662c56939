// The truth's lattice and segments against answers worked out by hand, and the properties that
// define them.
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "tests/truth/segment.hpp"
#include "tests/truth/volumes.hpp"

namespace gridrt::truth {
namespace {

Scene scene_of(std::vector<glm::vec3> positions) {
  Scene scene;
  scene.positions = std::move(positions);
  for (std::uint32_t i = 0; i + 2 < scene.positions.size(); i += 3) {
    scene.triangles.push_back({i, i + 1, i + 2});
  }
  return scene;
}

TEST(TruthLattice, ByHandAtFourBits) {
  // 2^4 - 5 = 11 steps: extent 5 takes s = 1 (10 steps), 1.25 takes s = 3 (10), 0 the largest, 3.
  const auto snapped = snap_scene(scene_of({{-1, 0, 7}, {4, 0.3F, 7}, {0.25F, 1.25F, 7}}), 4);
  EXPECT_EQ(snapped.lattice.shift, (std::array<int, 3>{1, 3, 3}));
  EXPECT_EQ(snapped.triangles[0].a, (Point{2, 2, 2}));
  EXPECT_EQ(snapped.triangles[0].b, (Point{12, 4, 2}));  // .3 * 8 = 2.4
  EXPECT_EQ(snapped.triangles[0].c, (Point{5, 12, 2}));  // 1.25 * 2 + 1/2 = 3
  EXPECT_EQ(snapped.lattice.far, (Point{14, 14, 4}));
}

TEST(TruthLattice, ScaleIsTheLargestThatFits) {
  std::mt19937 random(2);
  std::uniform_real_distribution<float> mantissa(-1.0F, 1.0F);
  std::uniform_int_distribution<int> exponent(-140, 120);
  for (int i = 0; i < 300; ++i) {
    std::vector<glm::vec3> p(3);
    for (auto& v : p) {
      for (int k = 0; k < 3; ++k) v[k] = std::ldexp(mantissa(random), exponent(random));
    }
    const int bits = 8 + i % 17;
    const auto snapped = snap_scene(scene_of(p), bits);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto& l = snapped.lattice;
      const Rational steps = (l.hi[axis] - l.lo[axis]) * l.step[axis];
      EXPECT_LE(steps, power_of_two(bits) - 5);
      EXPECT_GT(2 * steps, power_of_two(bits) - 5);
      EXPECT_LE(l.far[axis], 1 << bits);
    }
  }
}

TEST(TruthLattice, NoTriangleAndOnePoint) {
  EXPECT_EQ(snap_scene(Scene{}, 17).lattice.far, (Point{4, 4, 4}));
  const auto point = snap_scene(scene_of({{3, 3, 3}, {3, 3, 3}, {3, 3, 3}}), 17);
  EXPECT_EQ(point.lattice.shift, (std::array<int, 3>{0, 0, 0}));
  EXPECT_EQ(point.triangles[0].a, (Point{2, 2, 2}));
  EXPECT_EQ(point.lattice.far, (Point{4, 4, 4}));
}

class TruthSegment : public ::testing::Test {
 protected:
  // lo = 0, step 1 on x and y, z flat: the box is [0, 12]^2 x [0, 4].
  Lattice lattice_ = snap_scene(scene_of({{0, 0, 0}, {8, 0, 0}, {0, 8, 0}}), 4).lattice;
};

TEST_F(TruthSegment, CutsAtTheFacesAndRounds) {
  const auto s = cut(lattice_, {{1.25, 1.5, 10}, {0, 0, -2}, 0, 1e30});
  ASSERT_TRUE(s.meets_box);
  EXPECT_EQ(s.t0, 4);  // z = 10 lies at 12 on the lattice, the box ends at 4
  EXPECT_EQ(s.t1, 6);
  EXPECT_EQ(s.p0, (Point{3, 4, 4}));  // 3.25 and 3.5 round to 3 and 4
  EXPECT_EQ(s.p1, (Point{3, 4, 0}));
}

TEST_F(TruthSegment, TouchingCountsAndBeyondDoesNot) {
  EXPECT_TRUE(cut(lattice_, {{-2, 0, 5}, {0, 0, -1}}).meets_box);  // along a face
  EXPECT_FALSE(cut(lattice_, {{std::nextafter(-2.0, -3.0), 0, 5}, {0, 0, -1}}).meets_box);
  const auto corner = cut(lattice_, {{-2, -4, -2}, {-1, 2, 0}});
  EXPECT_FALSE(corner.meets_box);
  const auto point = cut(lattice_, {{-3, -1, 0}, {1, -1, 0}});  // through the edge x = y = -2
  EXPECT_TRUE(point.meets_box);
  EXPECT_EQ(point.t0, 1);
  EXPECT_TRUE(point.miss());                                              // a point is a miss
  EXPECT_TRUE(cut(lattice_, {{0, 0, 10}, {0, 0, 1}}).miss());             // points away
  EXPECT_TRUE(cut(lattice_, {{0, 0, 10}, {0, 0, -1}, 0, 7.999}).miss());  // stops before
  EXPECT_FALSE(cut(lattice_, {{0, 0, 10}, {0, 0, -1}, 0, 9}).miss());
}

TEST_F(TruthSegment, SecondaryStartsStrictlyOnTheSideOfItsDirection) {
  const Triangle flat{{2, 2, 2}, {10, 2, 2}, {2, 10, 2}};
  const auto start = [&](double dz) {
    return secondary_start(lattice_, {3, 3, 4}, {3, 3, 0}, flat, {1, 0, dz});
  };
  EXPECT_EQ(start(1e-300), (Point{3, 3, 3}));
  EXPECT_EQ(start(-1e-300), (Point{3, 3, 1}));
  EXPECT_EQ(start(0), (Point{3, 3, 2}));
  EXPECT_FALSE(secondary_start(lattice_, {11, 11, 4}, {11, 11, 0}, flat, {0, 0, 1}));
  const Triangle top{{2, 2, 4}, {10, 2, 4}, {2, 10, 4}};
  EXPECT_FALSE(secondary_start(lattice_, {3, 3, 0}, {3, 3, 4}, top, {0, 0, 1}));  // leaves the box
}

TEST(TruthNumbers, CloseIsRelativeWithDenormalAndInfiniteEnds) {
  EXPECT_TRUE(close(1.0, Rational(1), 1e-12));
  EXPECT_TRUE(close(1.0 + 9e-13, Rational(1), 1e-12));
  EXPECT_FALSE(close(1.0 + 2e-12, Rational(1), 1e-12));
  EXPECT_FALSE(close(1e-30, Rational(0), 1e-12));
  EXPECT_TRUE(close(0.0, Rational(0), 1e-12));
  EXPECT_TRUE(close(0.0, power_of_two(-1080), 1e-12));
  EXPECT_TRUE(close(std::numeric_limits<double>::infinity(), power_of_two(1025), 1e-12));
  EXPECT_FALSE(close(std::numeric_limits<double>::infinity(), power_of_two(1000), 1e-12));
  EXPECT_FALSE(close(std::numeric_limits<double>::quiet_NaN(), Rational(1), 1e-12));
  EXPECT_EQ(floor_of(Rational(-1, 2)), -1);
  EXPECT_EQ(nearest(Rational(-1, 2)), 0);
  EXPECT_EQ(nearest(Rational(1, 2)), 1);
  EXPECT_EQ(rational(-(Wide{1} << 100)), -power_of_two(100));
}

}  // namespace
}  // namespace gridrt::truth
