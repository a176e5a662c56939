// Cases 8, 9, 10, 17 and 18: degenerate, coincident and coplanar triangles; flat and empty scenes.
#include "tests/adversarial/cases.hpp"

namespace gridrt::adversarial {
namespace {

TEST(Case08, DegenerateTrianglesAreNeverHitAndKeepTheirNumber) {
  Tally tally;
  Random random(8);
  for (int round = 0; round < 20; ++round) {
    Scene scene;
    const Scene solid = soup(60, 4.0, random);
    std::vector<bool> degenerate;
    for (std::size_t i = 0; i < solid.triangles.size(); ++i) {
      const auto p = [&](std::size_t k) { return solid.positions[solid.triangles[i][k]]; };
      const glm::vec3 step = (p(1) - p(0)) * 1e-9F;
      switch (random.below(4)) {
        case 0:  // a point
          add_triangle(scene, p(0), p(0), p(0));
          break;
        case 1:  // a segment
          add_triangle(scene, p(0), p(1), p(0));
          break;
        case 2:  // too small for the lattice
          add_triangle(scene, p(0), p(0) + step, p(0) - step);
          break;
        default:
          add_triangle(scene, p(0), p(1), p(2));
      }
    }
    with_bench(scene, random_configuration(random, random.between(8, 20)), [&](const Bench& bench) {
      std::vector<Hit> hits = bench.check_rays(aimed_rays(scene, 600, random), tally);
      const auto more = bench.check_segments(exact_segments(bench.truth(), 600, random), tally);
      hits.insert(hits.end(), more.begin(), more.end());
      for (const Hit& hit : hits) {
        if (hit.id < 0) continue;
        const auto& t = bench.truth().triangles()[static_cast<std::size_t>(hit.id)];
        EXPECT_NE(truth::normal_of(t), (std::array<truth::Wide, 3>{}));
      }
    });
  }
  report("case 08, degenerate triangles", tally);
}

TEST(Case08, DegenerateTrianglesAreCounted) {
  Scene scene;
  add_triangle(scene, {0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  add_triangle(scene, {0, 0, 0}, {1, 1, 1}, {0, 0, 0});
  add_triangle(scene, {1, 1, 1}, {1, 1, 1}, {1, 1, 1});
  const auto image = build_image(scene, plain_configuration().image);
  ASSERT_TRUE(image) << image.error().message;
  EXPECT_EQ(image->header.triangles, 3U);
  EXPECT_EQ(image->header.degenerate, 2U);
  EXPECT_EQ(image->header.local_ids, 1U);
}

TEST(Case09, OfCoincidentTrianglesTheLowestIdWins) {
  Tally tally;
  Random random(9);
  for (int round = 0; round < 20; ++round) {
    const Scene once = round % 2 == 0 ? soup(40, 3.0, random) : sphere(6, 8, {0, 0, 0}, 1.0F);
    const std::size_t n = once.triangles.size();
    Scene scene;
    const std::size_t copies = 2 + random.below(3);
    for (std::size_t c = 0; c < copies; ++c) {
      for (std::size_t i = 0; i < n; ++i) {
        const std::size_t turn = random.below(3);  // each copy starts at another corner
        const auto p = [&](std::size_t k) {
          return once.positions[once.triangles[i][(k + turn) % 3]];
        };
        add_triangle(scene, p(0), p(1), p(2));
      }
    }
    with_bench(scene, random_configuration(random, kDefaultBits), [&](const Bench& bench) {
      const auto hits = bench.check_rays(aimed_rays(scene, 1000, random), tally);
      for (const Hit& hit : hits) EXPECT_LT(hit.id, static_cast<std::int32_t>(n));
    });
  }
  report("case 09, coincident triangles", tally);
}

TEST(Case10, OverlappingCoplanarTrianglesOfDifferentPes) {
  Tally tally;
  Random random(10);
  for (int round = 0; round < 24; ++round) {
    Scene scene;
    const bool tilted = round % 2 == 1;
    for (int i = 0; i < 80; ++i) {
      std::array<glm::vec3, 3> v;
      for (auto& p : v) {
        p = {random.between(0, 16), random.between(0, 16), 0};
        if (tilted) p.z = p.x + 2 * p.y;
      }
      add_triangle(scene, v[0], v[1], v[2]);
    }
    Configuration configuration = random_configuration(random, random.between(8, 17));
    configuration.image.pes = 4 << random.below(2);
    configuration.image.layout = protocol::Layout::kWide;
    configuration.image.mapping = Mapping::kVoxel;
    with_bench(scene, configuration, [&](const Bench& bench) {
      bench.check_rays(aimed_rays(scene, 600, random), tally);
      bench.check_segments(exact_segments(bench.truth(), 600, random), tally);
    });
  }
  report("case 10, coplanar overlaps", tally);
}

TEST(Case17, PlanarScenes) {
  Tally tally;
  Random random(17);
  for (int round = 0; round < 30; ++round) {
    const int axis = round % 3;
    Scene scene;
    const int kind = static_cast<int>(random.below(3));
    if (kind == 0) {
      Random same(round);
      scene = sheet(random.between(1, 5), 0.2, same);
    } else if (kind == 1) {  // a quad
      add_triangle(scene, {0, 0, 0}, {3, 0, 0}, {3, 2, 0});
      add_triangle(scene, {0, 0, 0}, {3, 2, 0}, {0, 2, 0});
    } else {  // a box without thickness
      scene = box(2, {0, 0, 0}, {1, 1, 0});
    }
    for (auto& p : scene.positions) {
      p.z = 0.7F;
      p = {p[axis], p[(axis + 1) % 3], p[(axis + 2) % 3]};
    }
    with_bench(scene, random_configuration(random, random.between(6, 24)), [&](const Bench& bench) {
      bench.check_rays(any_rays(scene, bench.truth().lattice(), bench.grid(), 800, random), tally);
      bench.check_segments(exact_segments(bench.truth(), 300, random), tally);
    });
  }
  report("case 17, planar scenes", tally);
}

TEST(Case18, OneTriangleNoneAndOnlyDegenerateOnes) {
  Tally tally;
  Random random(18);
  Scene one;
  add_triangle(one, {0.3F, -1, 2}, {4, 5, 6}, {-7, 8, 9.5F});
  Scene none;
  none.materials.emplace_back();
  Scene points;
  add_triangle(points, {1, 2, 3}, {1, 2, 3}, {1, 2, 3});
  add_triangle(points, {1, 2, 3}, {4, 5, 6}, {1, 2, 3});
  Scene point;
  add_triangle(point, {1, 2, 3}, {1, 2, 3}, {1, 2, 3});
  Scene unused = one;  // a vertex that no triangle uses does not count
  add_vertex(unused, {1e30F, 0, 0});
  for (int round = 0; round < 6; ++round) {
    for (const Scene& scene : {one, none, points, point, unused}) {
      const Configuration configuration = random_configuration(random, random.between(5, 24));
      with_bench(scene, configuration, [&](const Bench& bench) {
        std::vector<Ray> rays = any_rays(scene, bench.truth().lattice(), bench.grid(), 400, random);
        bench.check_rays(rays, tally);
        bench.check_segments(exact_segments(bench.truth(), 200, random), tally);
      });
    }
  }
  report("case 18, one triangle, none, only degenerate ones", tally);
}

}  // namespace
}  // namespace gridrt::adversarial
