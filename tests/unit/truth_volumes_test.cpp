// The truth's volumes against Cramer's rule in rationals, on small lattices where every special
// position is common.
#include <random>

#include <gtest/gtest.h>

#include "tests/truth/volumes.hpp"

namespace gridrt::truth {
namespace {

/// Solves p0 + s (p1 - p0) = a + x (b - a) + y (c - a) and applies the definition to the solution.
struct Solution {
  bool hit = false;
  Rational s, x, y;
};

Rational determinant(const std::array<std::array<Rational, 3>, 3>& m) {
  return m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
         m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
         m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
}

Solution solve(const Point& p0, const Point& p1, const Triangle& t) {
  std::array<std::array<Rational, 3>, 3> m;
  std::array<Rational, 3> right;
  for (std::size_t i = 0; i < 3; ++i) {
    m[i] = {Rational(p0[i] - p1[i]), Rational(t.b[i] - t.a[i]), Rational(t.c[i] - t.a[i])};
    right[i] = p0[i] - t.a[i];
  }
  const Rational all = determinant(m);
  Solution out;
  if (all == 0) return out;
  std::array<Rational, 3> unknown;
  for (std::size_t column = 0; column < 3; ++column) {
    auto replaced = m;
    for (std::size_t i = 0; i < 3; ++i) replaced[i][column] = right[i];
    unknown[column] = determinant(replaced) / all;
  }
  out.s = unknown[0];
  out.x = unknown[1];
  out.y = unknown[2];
  out.hit = out.s >= 0 && out.s <= 1 && out.x >= 0 && out.y >= 0 && out.x + out.y <= 1;
  return out;
}

TEST(TruthVolumes, EqualsCramersRuleOnSmallAndLargeLattices) {
  std::mt19937 random(1);
  std::size_t hits = 0;
  std::size_t corners = 0;
  for (const int top : {2, 4, 9, 131070, 1 << 20, (1 << 24) - 1}) {
    std::uniform_int_distribution<int> any(0, top);
    const auto point = [&] { return Point{any(random), any(random), any(random)}; };
    for (int i = 0; i < 20000; ++i) {
      const Triangle t{point(), point(), point()};
      const Point p0 = point();
      Point p1 = point();
      if (i % 3 == 0) {  // aim at a vertex, as far as the lattice allows
        for (std::size_t k = 0; k < 3; ++k) p1[k] = std::clamp(2 * t.b[k] - p0[k], 0, top);
      }
      const Solution expected = solve(p0, p1, t);
      const auto got = meet(p0, p1, t);
      ASSERT_EQ(got.has_value(), expected.hit) << "top " << top << ", case " << i;
      if (!got) continue;
      ++hits;
      const Rational total = rational(got->before + got->after);
      ASSERT_EQ(got->before + got->after, got->weight_a + got->weight_b + got->weight_c);
      ASSERT_EQ(rational(got->before) / total, expected.s);
      ASSERT_EQ(rational(got->weight_b) / total, expected.x);
      ASSERT_EQ(rational(got->weight_c) / total, expected.y);
      ASSERT_EQ(got->quotient(), floor_of(power_of_two(24) * expected.s).get_ui());
      if (expected.x == 1 || expected.y == 1 || expected.x + expected.y == 0) ++corners;
    }
  }
  EXPECT_GT(hits, 10000U);
  EXPECT_GT(corners, 1000U);
}

TEST(TruthVolumes, ClosedTwoSidedAndBlindToDegenerateOnes) {
  const Triangle t{{0, 0, 5}, {10, 0, 5}, {0, 10, 5}};
  EXPECT_TRUE(meet({0, 0, 0}, {0, 0, 9}, t));   // vertex
  EXPECT_TRUE(meet({5, 5, 0}, {5, 5, 9}, t));   // edge
  EXPECT_TRUE(meet({5, 5, 9}, {5, 5, 0}, t));   // from behind
  EXPECT_TRUE(meet({2, 2, 5}, {2, 2, 9}, t));   // starts on it
  EXPECT_TRUE(meet({2, 2, 0}, {2, 2, 5}, t));   // ends on it
  EXPECT_FALSE(meet({6, 5, 0}, {6, 5, 9}, t));  // just outside
  EXPECT_FALSE(meet({2, 2, 0}, {2, 2, 4}, t));  // too short
  EXPECT_FALSE(meet({0, 0, 5}, {9, 9, 5}, t));  // in its plane
  EXPECT_FALSE(meet({0, 0, 0}, {9, 9, 9}, {{1, 1, 1}, {5, 5, 5}, {8, 8, 8}}));
  EXPECT_FALSE(meet({0, 0, 0}, {9, 9, 9}, {{5, 5, 5}, {5, 5, 5}, {5, 5, 5}}));
}

TEST(TruthVolumes, QuotientRunsFromZeroToTwoToThe24) {
  const Triangle t{{0, 0, 3}, {9, 0, 3}, {0, 9, 3}};
  EXPECT_EQ(meet({1, 1, 3}, {1, 1, 9}, t)->quotient(), 0U);
  EXPECT_EQ(meet({1, 1, 0}, {1, 1, 3}, t)->quotient(), 1U << 24);
  EXPECT_EQ(meet({1, 1, 0}, {1, 1, 9}, t)->quotient(), (1U << 24) / 3);
}

}  // namespace
}  // namespace gridrt::truth
