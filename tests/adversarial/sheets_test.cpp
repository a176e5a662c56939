// Cases 1, 7 and 11: closed sheets from above, at grazing angles, and two of them almost in one.
#include <algorithm>
#include <cmath>
#include <iterator>

#include "tests/adversarial/cases.hpp"
#include "tests/adversarial/devices.hpp"

namespace gridrt::adversarial {
namespace {

/// side x side rays from one jittered origin to a jittered raster inside the unit square.
std::vector<Ray> raster(int side, Random& random) {
  const glm::dvec3 origin = random.in_box({-0.5, -0.5, 0.5}, {1.5, 1.5, 2.0});
  std::vector<Ray> rays;
  for (int y = 0; y < side; ++y) {
    for (int x = 0; x < side; ++x) {
      const glm::dvec3 target{(x + random.uniform(0.01, 0.99)) / side,
                              (y + random.uniform(0.01, 0.99)) / side, 0.0};
      rays.push_back(
          {origin, 0.98 * (target - glm::dvec3{0.5, 0.5, 0}) + glm::dvec3{0.5, 0.5, 0} - origin});
    }
  }
  return rays;
}

TEST(Case01, ClosedSheetsLetNothingThroughAndNothingTwice) {
  Tally all;
  std::size_t missed = 0;
  for (const int n : {1, 4, 16, 64, 128}) {
    Tally tally;
    // A board in simulation takes longer to load a large sheet than to trace its part of the rays.
    const bool few_loads = rays_per_traced_one() > 1 && n >= 64;
    const std::uint64_t sheets = few_loads ? 3 : 10;
    const int rasters = few_loads ? 4 : 1;
    for (std::uint64_t seed = 0; seed < sheets; ++seed) {
      Random random(1000 * static_cast<std::uint64_t>(n) + seed);
      const Scene scene = sheet(n, 0.3, random);
      Configuration configuration = random_configuration(random, kDefaultBits);
      if (n > 16) configuration.image.grid.reset();  // a coarse grid would only take time
      with_bench(scene, configuration, [&](const Bench& bench) {
        std::vector<Ray> rays;
        for (int i = 0; i < rasters; ++i)
          std::ranges::copy(raster(64, random), std::back_inserter(rays));
        const auto hits = bench.check_rays(rays, tally);  // chunks are loaded once for all of them
        for (const Hit& hit : hits) missed += hit.id < 0 ? 1 : 0;
      });
    }
    report("case 01, sheets of " + std::to_string(4 * n * n) + " triangles", tally);
    all += tally;
  }
  EXPECT_EQ(missed, 0U);
  EXPECT_EQ(all.hits, all.rays);
}

TEST(Case07, GrazingRaysAndRaysInThePlane) {
  Tally tally;
  Random random(7);
  for (int round = 0; round < 24; ++round) {
    const double jitter = round % 3 == 0 ? 0.0 : std::pow(10.0, -random.uniform(0.0, 5.0));
    const Scene scene = sheet(random.between(1, 12), jitter, random);
    with_bench(scene, random_configuration(random, random.between(12, 20)),
               [&](const Bench& bench) {
                 std::vector<Ray> rays;
                 for (int i = 0; i < 1500; ++i) {
                   const double angle =
                       std::pow(10.0, random.uniform(-6.0, -2.06));  // up to half a degree
                   const double turn = random.uniform(0.0, 6.3);
                   const glm::dvec3 way{std::cos(turn), std::sin(turn), -std::tan(angle)};
                   const glm::dvec3 target = random.in_box({0, 0, 0}, {1, 1, 0});
                   rays.push_back({target - way * random.uniform(0.0, 3.0), way});
                   if (i % 5 == 0)
                     rays.back().direction.z = 0.0;  // in the plane, where the sheet is flat
                   if (i % 5 == 0) rays.back().origin.z = 0.0;
                 }
                 bench.check_rays(rays, tally);
                 bench.check_segments(exact_segments(bench.truth(), 500, random), tally);
               });
  }
  report("case 07, grazing and in the plane", tally);
}

TEST(Case07, TheNeighboursOfATriangleSeenEdgeOnStillCloseTheMesh) {
  // A ridge: the wall is seen edge-on from straight above, its neighbours meet at its edges.
  Scene scene;
  const glm::vec3 a{0, 0, 0};
  const glm::vec3 b{1, 0, 0};
  const glm::vec3 c{0, 0.5F, 0};
  const glm::vec3 d{1, 0.5F, 0};
  const glm::vec3 low{0, 0, -0.5F};
  const glm::vec3 low_end{1, 0, -0.5F};
  const glm::vec3 far{0, -0.5F, -0.5F};
  const glm::vec3 far_end{1, -0.5F, -0.5F};
  add_triangle(scene, a, b, low);  // the wall y = 0
  add_triangle(scene, b, low_end, low);
  add_triangle(scene, a, b, c);  // the upper floor y > 0
  add_triangle(scene, b, d, c);
  add_triangle(scene, low, low_end, far);  // the lower floor y < 0
  add_triangle(scene, low_end, far_end, far);
  Tally tally;
  with_bench(scene, plain_configuration(), [&](const Bench& bench) {
    std::vector<Ray> rays;
    for (int i = 0; i <= 2000; ++i) rays.push_back({{i / 2000.0, 0.0, 3.0}, {0.0, 0.0, -1.0}});
    const auto hits = bench.check_rays(rays, tally);
    for (const Hit& hit : hits) EXPECT_TRUE(hit.id == 2 || hit.id == 3) << hit.id;
  });
  report("case 07, along a wall seen edge-on", tally);
}

/// Two flat sheets, the first in file order `gap` below the second, with a post to give depth.
Scene two_sheets(float height, float gap) {
  Scene scene;
  Random random(11);
  const Scene flat = sheet(4, 0.0, random);
  add_scene(scene, flat, 1.0F, {0, 0, height});
  add_scene(scene, flat, 1.0F, {0, 0, height + gap});
  add_triangle(scene, {2, 0, 0}, {2, 1, 0}, {2, 0, 1});
  return scene;
}

TEST(Case11, TwoSheetsAStepHalfAStepAndAnUlpApart) {
  const std::size_t count = 64;  // triangles of the lower sheet; the upper ones follow
  Random random(12);
  Tally tally;
  // The extent along z is 1, so 16 bits of it: a step is 2^-16.
  for (const float gap : {0x1p-16F, 0x1p-17F, 0x1p-24F, 0.0F}) {
    for (const float height : {0.5F, 0.5F + 0x1p-17F, 0.25F + 0x1p-18F}) {
      const Scene scene = two_sheets(height, gap);
      with_bench(scene, random_configuration(random, kDefaultBits), [&](const Bench& bench) {
        ASSERT_EQ(bench.lattice().scale.z, 16);
        for (const double side : {1.0, -1.0}) {
          std::vector<Ray> rays;
          for (int i = 0; i < 1000; ++i) {
            const glm::dvec3 target = random.in_box({0.01, 0.01, height}, {0.99, 0.99, height});
            rays.push_back(
                {target + glm::dvec3{random.uniform(-0.3, 0.3), random.uniform(-0.3, 0.3), side},
                 glm::dvec3{0.0}});
            rays.back().direction = target - rays.back().origin;
          }
          const auto hits = bench.check_rays(rays, tally);
          const auto& triangles = bench.truth().triangles();
          const bool same = triangles[0].a[2] == triangles[count].a[2];
          for (const Hit& hit : hits) {
            // The upper sheet only from above, and only where the lattice keeps them apart.
            const bool upper = hit.id >= static_cast<std::int32_t>(count);
            EXPECT_EQ(upper, side > 0 && !same) << "gap " << gap << ", height " << height;
          }
        }
      });
    }
  }
  report("case 11, two sheets almost in one", tally);
}

}  // namespace
}  // namespace gridrt::adversarial
