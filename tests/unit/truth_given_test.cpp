// The truth of a scene as it is given.
#include <algorithm>
#include <iterator>

#include <gtest/gtest.h>

#include "tests/adversarial/meshes.hpp"
#include "tests/adversarial/rays.hpp"
#include "tests/truth/given.hpp"

namespace gridrt::truth {
namespace {

using Ids = std::vector<std::int64_t>;

/// The unit square in the plane z = 0, cut along its diagonal, and a third triangle behind it.
Scene square() {
  Scene scene;
  adversarial::add_triangle(scene, {0, 0, 0}, {1, 0, 0}, {1, 1, 0});
  adversarial::add_triangle(scene, {0, 0, 0}, {1, 1, 0}, {0, 1, 0});
  adversarial::add_triangle(scene, {-3, -3, -1}, {3, -3, -1}, {0, 3, -1});
  return scene;
}

TEST(GivenTruth, NamesAllTrianglesThatAreEquallyNear) {
  const Scene scene = square();
  const GivenTracer tracer(scene, Search::kAll);
  EXPECT_EQ(tracer.closest({{0.75, 0.25, 1}, {0, 0, -1}}), Ids{0});
  EXPECT_EQ(tracer.closest({{0.25, 0.75, 1}, {0, 0, -1}}), Ids{1});
  EXPECT_EQ(tracer.closest({{0.5, 0.5, 1}, {0, 0, -1}}), (Ids{0, 1}));        // the diagonal
  EXPECT_EQ(tracer.closest({{0.375, 0.375, -0.5}, {0, 0, 3}}), (Ids{0, 1}));  // from below
  EXPECT_EQ(tracer.closest({{1.25, 0.25, 1}, {0, 0, -1}}), Ids{2});           // beside it
  EXPECT_EQ(tracer.closest({{0.75, 0.25, -0.5}, {0, 0, -1}}), Ids{2});        // already past it
  EXPECT_EQ(tracer.closest({{0.75, 0.25, 1}, {0, 0, 1}}), Ids{});             // the other way
  EXPECT_EQ(tracer.closest({{-1, 0.5, 0}, {1, 0, 0}}), Ids{});                // in its plane
}

TEST(GivenTruth, DecidesWhatDoublesCannot) {
  const Scene scene = square();
  const GivenTracer tracer(scene, Search::kAll);
  // Past the diagonal by less than a double's rounding of any product here.
  const double slight = 0x1p-60;
  EXPECT_EQ(tracer.closest({{0.5, 0.5, 1}, {slight, 0, -1}}), Ids{0});
  EXPECT_EQ(tracer.closest({{0.5, 0.5, 1}, {-slight, 0, -1}}), Ids{1});
  EXPECT_EQ(tracer.closest({{1.0, 0.5, 1}, {slight, 0, -1}}), Ids{2});
  EXPECT_EQ(tracer.closest({{1.0, 0.5, 1}, {-slight, 0, -1}}), Ids{0});
}

TEST(GivenTruth, KeepsToTheRaysParameters) {
  const Scene scene = square();
  const GivenTracer tracer(scene, Search::kAll);
  EXPECT_EQ(tracer.closest({{0.75, 0.25, 1}, {0, 0, -1}, 1.0, 1.0}), Ids{0});
  EXPECT_EQ(tracer.closest({{0.75, 0.25, 1}, {0, 0, -1}, 1.5, 3.0}), Ids{2});
  EXPECT_EQ(tracer.closest({{0.75, 0.25, 1}, {0, 0, -1}, 0.0, 0.5}), Ids{});
}

TEST(GivenTruth, PrunedEqualsBruteForceOn100000Rays) {
  adversarial::Random random(3);
  std::size_t hits = 0;
  for (const double octaves : {0.5, 8.0}) {
    Scene scene = adversarial::soup(60, octaves, random);
    adversarial::add_scene(scene, adversarial::sheet(4, 0.3, random));  // rays at shared edges
    const GivenTracer all(scene, Search::kAll);
    const GivenTracer pruned(scene, Search::kPruned);
    std::vector<gridrt::Ray> rays = adversarial::aimed_rays(scene, 25000, random);
    std::ranges::copy(adversarial::random_rays(adversarial::bounds_of(scene), 25000, random),
                      std::back_inserter(rays));
    for (const gridrt::Ray& r : rays) {
      const Ray ray{{r.origin.x, r.origin.y, r.origin.z},
                    {r.direction.x, r.direction.y, r.direction.z},
                    r.tmin,
                    r.tmax};
      const Ids ids = pruned.closest(ray);
      ASSERT_EQ(ids, all.closest(ray));
      hits += ids.empty() ? 0 : 1;
    }
  }
  EXPECT_GT(hits, 30000U);
}

}  // namespace
}  // namespace gridrt::truth
