// Welding: every point once, in the order of its first occurrence.
#include <algorithm>
#include <map>
#include <random>
#include <tuple>

#include <gtest/gtest.h>

#include "host/image/weld.hpp"

namespace gridrt {
namespace {

TEST(Weld, Nothing) {
  const WeldedPoints welded = weld({});
  EXPECT_TRUE(welded.points.empty());
  EXPECT_TRUE(welded.index.empty());
}

TEST(Weld, AsAMapWould) {
  for (const unsigned spread : {1U, 3U, 40U, 0x7FFFFFFFU}) {
    std::mt19937 random(spread);
    std::vector<glm::ivec3> points(5000);
    for (glm::ivec3& p : points) {
      for (int a = 0; a < 3; ++a) p[a] = static_cast<int>(random() % spread);
    }
    const WeldedPoints welded = weld(points);
    std::map<std::tuple<int, int, int>, std::uint32_t> seen;
    ASSERT_EQ(welded.index.size(), points.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
      const std::tuple key(points[i].x, points[i].y, points[i].z);
      const auto index = seen.emplace(key, static_cast<std::uint32_t>(seen.size())).first->second;
      ASSERT_EQ(welded.index[i], index);
      ASSERT_EQ(welded.points[index], points[i]);
    }
    EXPECT_EQ(welded.points.size(), seen.size());
  }
}

TEST(Weld, PointsOnALineStayApart) {
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<glm::ivec3> points(20000, glm::ivec3{5});
    for (std::size_t i = 0; i < points.size(); ++i) points[i][axis] = static_cast<int>(i);
    EXPECT_EQ(weld(points).points, points);
  }
}

}  // namespace
}  // namespace gridrt
