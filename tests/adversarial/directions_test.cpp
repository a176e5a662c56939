// Cases 13 to 16 and 20: special directions, origins and lengths, and triangles in cell faces.
#include <algorithm>
#include <cmath>

#include <glm/common.hpp>

#include "tests/adversarial/bridge.hpp"
#include "tests/adversarial/cases.hpp"

namespace gridrt::adversarial {
namespace {

/// Scenes for special rays, on grids whose faces meet their vertices or do not.
Scene some_scene(int round, Random& random) {
  switch (round % 4) {
    case 0:
      return box(2, {0, 0, 0}, {16, 16, 16});
    case 1:
      return lattice_soup(60, 8, random);
    case 2:
      return sphere(8, 12, {1, 2, 3}, 5.0F);
    default:
      return soup(100, 4.0, random);
  }
}

TEST(Case13And14, AxesAndDiagonalsThroughFacesEdgesAndCornersOfCells) {
  Tally tally;
  Random random(13);
  for (int round = 0; round < 40; ++round) {
    const Scene scene = some_scene(round, random);
    Configuration configuration = random_configuration(random, random.between(7, 20));
    configuration.image.grid = glm::ivec3{1 << random.between(0, 4)};
    with_bench(scene, configuration, [&](const Bench& bench) {
      bench.check_rays(grid_rays(bench.truth().lattice(), bench.grid(), 3000, random), tally);
    });
  }
  report("cases 13 and 14, axes and diagonals", tally);
}

TEST(Case13And14, AllDirectionsThroughAllCornersOfASmallGrid) {
  Tally tally;
  Random random(14);
  for (int round = 0; round < 4; ++round) {
    const Scene scene = some_scene(round, random);
    with_bench(scene, plain_configuration(8, glm::ivec3{5}), [&](const Bench& bench) {
      const glm::ivec3 far = bench.lattice().box();
      std::vector<Segment> segments;
      for (int corner = 0; corner < 216; ++corner) {
        const glm::ivec3 cell{corner % 6, corner / 6 % 6, corner / 36};
        const glm::ivec3 at = glm::min(cell * bench.grid().edge, far);
        for (int way = 0; way < 125; ++way) {
          const glm::ivec3 d{way % 5 - 2, way / 5 % 5 - 2, way / 25 - 2};
          if (d == glm::ivec3{0}) continue;
          const auto reach = [&](int sign) {  // steps of sign * d that stay in the box
            int k = 1 << 20;
            for (int i = 0; i < 3; ++i) {
              const int s = sign * d[i];
              if (s > 0) k = std::min(k, (far[i] - at[i]) / s);
              if (s < 0) k = std::min(k, at[i] / -s);
            }
            return k;
          };
          Segment s;
          s.t1 = 1.0;
          s.p0 = at - d * reach(-1);
          s.p1 = at + d * reach(1);
          segments.push_back(s);
        }
      }
      bench.check_segments(segments, tally);
    });
  }
  report("cases 13 and 14, all corners", tally);
}

TEST(Case15, OriginsOnFacesTrianglesVerticesAndOutside) {
  Tally tally;
  Random random(15);
  for (int round = 0; round < 40; ++round) {
    const Scene scene = some_scene(round, random);
    with_bench(scene, random_configuration(random, random.between(7, 24)), [&](const Bench& bench) {
      bench.check_rays(origin_rays(scene, bench.truth().lattice(), bench.grid(), 2000, random),
                       tally);
    });
  }
  report("case 15, origins", tally);
}

TEST(Case16, SegmentsInsideOneCellAndOfLengthZero) {
  Tally tally;
  Random random(16);
  for (int round = 0; round < 20; ++round) {
    const Scene scene = some_scene(round, random);
    with_bench(scene, random_configuration(random, random.between(7, 17)), [&](const Bench& bench) {
      const auto& triangles = bench.truth().triangles();
      std::vector<Segment> segments;
      std::vector<Ray> rays;
      for (int i = 0; i < 1500; ++i) {
        const glm::ivec3 at = to_engine(triangles[random.below(triangles.size())].b);
        Segment s;
        s.t1 = 1.0;
        const int reach = random.between(0, 3);
        for (int k = 0; k < 3; ++k) {
          s.p0[k] = std::clamp(at[k] + random.between(-reach, reach), 0, bench.lattice().box()[k]);
          s.p1[k] = std::clamp(at[k] + random.between(-reach, reach), 0, bench.lattice().box()[k]);
        }
        if (i % 20 == 0) s.p1 = s.p0;  // a miss by definition, even on a triangle
        segments.push_back(s);
        Ray ray{in_scene(bench.truth().lattice(), glm::dvec3{s.p0}), random.direction()};
        ray.tmin = random.unit();
        ray.tmax = i % 3 == 0 ? ray.tmin : ray.tmin + std::ldexp(random.unit(), -i % 20);
        rays.push_back(ray);
      }
      const auto hits = bench.check_segments(segments, tally);
      for (std::size_t i = 0; i < hits.size(); ++i) {
        EXPECT_TRUE(segments[i].p0 != segments[i].p1 || hits[i].id == -1);
      }
      bench.check_rays(rays, tally);
    });
  }
  report("case 16, short segments", tally);
}

TEST(Case20, TrianglesInCellFacesAreFoundFromBothSides) {
  Tally tally;
  Random random(20);
  // Extent 60 at 8 bits takes s = 2: 240 steps, so the box is 244; four voxels of 61, two of 122,
  // and so on. Faces at multiples of the edge are (k edge - 2) / 4 in scene units.
  for (const int cells : {2, 4}) {
    const int edge = 244 / cells;
    Scene scene;
    add_triangle(scene, {0, 0, 0}, {0.25F, 0, 0}, {0, 0.25F, 0});  // these two fix the bounds
    add_triangle(scene, {60, 60, 60}, {59.75F, 60, 60}, {60, 59.75F, 60});
    const auto bounds = static_cast<std::int32_t>(scene.triangles.size());
    for (int axis = 0; axis < 3; ++axis) {
      for (int k = 1; k < cells; ++k) {
        const float face = static_cast<float>(k * edge - 2) / 4.0F;
        const auto point = [&](float a, float b) {
          glm::vec3 p;
          p[axis] = face;
          p[(axis + 1) % 3] = a;
          p[(axis + 2) % 3] = b;
          return p;
        };
        add_triangle(scene, point(1, 1), point(59, 2), point(3, 58));
        add_triangle(scene, point(59, 2), point(58, 58), point(3, 58));
      }
    }
    for (int round = 0; round < 8; ++round) {
      Configuration configuration = random_configuration(random, 8);
      configuration.image.grid = glm::ivec3{cells};
      with_bench(scene, configuration, [&](const Bench& bench) {
        ASSERT_EQ(bench.grid().edge, glm::ivec3{edge});
        for (std::size_t t = static_cast<std::size_t>(bounds); t < scene.triangles.size(); ++t) {
          const auto& q = bench.truth().triangles()[t];
          const bool in_face = (q.a[0] % edge == 0 && q.b[0] == q.a[0] && q.c[0] == q.a[0]) ||
                               (q.a[1] % edge == 0 && q.b[1] == q.a[1] && q.c[1] == q.a[1]) ||
                               (q.a[2] % edge == 0 && q.b[2] == q.a[2] && q.c[2] == q.a[2]);
          ASSERT_TRUE(in_face) << t;
        }
        bench.check_rays(aimed_rays(scene, 1500, random), tally);
        bench.check_segments(exact_segments(bench.truth(), 1500, random), tally);
        // Straight through each face from either side: the face is hit, whichever cell is first.
        for (int axis = 0; axis < 3; ++axis) {
          for (const double side : {1.0, -1.0}) {
            Ray ray{{25.3, 25.3, 25.3}, {0, 0, 0}};
            ray.origin[axis] = side > 0 ? -1.0 : 61.0;
            ray.direction[axis] = side;
            const auto hits = bench.check_rays(std::vector{ray}, tally);
            EXPECT_GE(hits[0].id, bounds);
          }
        }
      });
    }
  }
  report("case 20, triangles in cell faces", tally);
}

}  // namespace
}  // namespace gridrt::adversarial
