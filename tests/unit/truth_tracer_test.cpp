// Pruned search equals unpruned brute force; the tie rule, any hit and ignored triangles.
#include <cstdio>
#include <random>

#include <gtest/gtest.h>

#include "tests/truth/tracer.hpp"

namespace gridrt::truth {
namespace {

/// Triangles of many sizes, some on a coarse lattice of their own so that contacts are common.
Scene soup(std::uint32_t seed, int triangles) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> unit(-1.0F, 1.0F);
  std::uniform_int_distribution<int> coarse(-8, 8);
  Scene scene;
  for (int i = 0; i < triangles; ++i) {
    const glm::vec3 centre{unit(random), unit(random), unit(random)};
    const float size = std::exp2(-6.0F * std::abs(unit(random)));
    for (int k = 0; k < 3; ++k) {
      glm::vec3 v = centre + size * glm::vec3{unit(random), unit(random), unit(random)};
      if (i % 4 == 0) {
        v = glm::vec3{coarse(random), coarse(random), coarse(random)} / 8.0F;
      }
      scene.positions.push_back(v);
    }
    const auto n = static_cast<std::uint32_t>(scene.positions.size());
    scene.triangles.push_back({n - 3, n - 2, n - 1});
  }
  return scene;
}

TEST(TruthTracer, PrunedEqualsBruteForceOn100000Rays) {
  std::size_t rays = 0;
  std::size_t hits = 0;
  for (const int bits : {6, 12, 17, 24}) {
    const Scene scene = soup(static_cast<std::uint32_t>(bits), 400);
    const Tracer all(scene, bits, Search::kAll);
    const Tracer pruned(scene, bits, Search::kPruned);
    std::mt19937 random(7);
    const Point far = all.lattice().far;
    for (int i = 0; i < 25000; ++i, ++rays) {
      Segment s;
      s.meets_box = true;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        std::uniform_int_distribution<int> any(0, far[axis]);
        s.p0[axis] = any(random);
        s.p1[axis] = any(random);
      }
      if (i % 5 == 0) s.p1[i % 3] = s.p0[i % 3];
      if (i % 7 == 0) s.p1 = all.triangles()[static_cast<std::size_t>(i) % 400].b;
      const auto a = all.closest(s);
      const auto b = pruned.closest(s);
      ASSERT_EQ(a.has_value(), b.has_value());
      ASSERT_EQ(all.count(s), pruned.count(s));
      ASSERT_EQ(all.any(s), a.has_value());
      if (!a) continue;
      ++hits;
      ASSERT_EQ(a->id, b->id);
      ASSERT_EQ(a->quotient, b->quotient);
      s.ignore = a->id;
      const auto next = pruned.closest(s);
      if (next) {
        ASSERT_NE(next->id, a->id);
        ASSERT_GE(std::tie(next->quotient, next->id), std::tie(a->quotient, a->id));
      }
    }
  }
  EXPECT_GT(hits, rays / 4);
  std::printf("pruned = brute force: %zu rays, %zu hits, 0 differences\n", rays, hits);
}

TEST(TruthTracer, EqualQuotientsGoToTheLowestId) {
  Scene scene;
  scene.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}};
  scene.triangles = {{0, 0, 1}, {1, 2, 3}, {0, 1, 2}, {2, 1, 0}, {0, 1, 3}};
  const Tracer tracer(scene, 17, Search::kAll);
  const auto at = [&](double x, double y) {
    const auto hit = tracer.closest(cut(tracer.lattice(), {{x, y, 1}, {0, 0, -1}}));
    return hit ? hit->id : kNone;
  };
  EXPECT_EQ(at(0.25, 0.25), 2);
  EXPECT_EQ(at(0.5, 0.5), 1);  // on the edge that 1 and 2 share
  EXPECT_EQ(at(0.75, 0.75), 1);
  EXPECT_EQ(at(1.5, 0.5), kNone);
}

TEST(TruthTracer, ChecksReportedParameters) {
  Scene scene;
  scene.positions = {{0, 0, 0}, {4, 0, 0}, {0, 4, 0}};
  scene.triangles = {{0, 1, 2}};
  const Tracer tracer(scene, 17, Search::kAll);
  const Segment s = cut(tracer.lattice(), {{1, 0.5, 3}, {0, 0, -2}});
  const auto hit = tracer.closest(s);
  ASSERT_TRUE(hit);
  EXPECT_EQ(check_parameters(s, hit->meeting, 1.5, 0.25, 0.125), "");
  EXPECT_NE(check_parameters(s, hit->meeting, 1.5 + 1e-11, 0.25, 0.125), "");
  EXPECT_NE(check_parameters(s, hit->meeting, 1.5, 0.25 + 1e-12, 0.125), "");
  EXPECT_NE(check_parameters(s, hit->meeting, 1.5, 0.125, 0.25), "");
}

}  // namespace
}  // namespace gridrt::truth
