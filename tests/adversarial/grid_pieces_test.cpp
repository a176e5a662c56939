// The pieces of host/grid, one by one, against the truth: lattice, snapping, segments, the exact
// test, starts of secondary rays.
#include <cmath>
#include <cstdio>
#include <limits>

#include <gtest/gtest.h>

#include "host/grid/intersect.hpp"
#include "tests/adversarial/bridge.hpp"
#include "tests/adversarial/meshes.hpp"
#include "tests/adversarial/rays.hpp"

namespace gridrt::adversarial {
namespace {

/// Vertices of any magnitude that float32 has, axes independent, some flat.
Scene extreme_scene(Random& random) {
  Scene scene;
  glm::ivec3 low;
  glm::ivec3 high;
  for (int i = 0; i < 3; ++i) {
    low[i] = random.between(-149, 126);
    high[i] = random.between(low[i], 126);
  }
  const int flat = random.between(0, 5);
  for (int k = 0; k < random.between(1, 6); ++k) {
    std::array<glm::vec3, 3> v;
    for (auto& p : v) {
      for (int i = 0; i < 3; ++i) {
        p[i] = i == flat ? 0x1.8p-3F : static_cast<float>(random.scaled(low[i], high[i]));
      }
    }
    add_triangle(scene, v[0], v[1], v[2]);
  }
  return scene;
}

void expect_same_lattice(const Scene& scene, int bits, std::size_t& vertices) {
  const auto lattice = make_lattice(scene.positions, scene.triangles, bits);
  ASSERT_TRUE(lattice) << lattice.error().message;
  const truth::SnappedScene truth = truth::snap_scene(scene, bits);
  EXPECT_EQ(to_truth(lattice->box()), truth.lattice.far);
  for (int i = 0; i < 3; ++i) {
    const auto axis = static_cast<std::size_t>(i);
    EXPECT_EQ(lattice->scale[i], truth.lattice.shift[axis]);
    EXPECT_EQ(truth::Rational(lattice->lo[i]), truth.lattice.lo[axis]);
  }
  const auto all = snap_all(*lattice, scene.positions);
  for (std::size_t t = 0; t < scene.triangles.size(); ++t) {
    const std::array<truth::Point, 3> expected{truth.triangles[t].a, truth.triangles[t].b,
                                               truth.triangles[t].c};
    for (std::size_t k = 0; k < 3; ++k, ++vertices) {
      const auto index = scene.triangles[t][k];
      ASSERT_EQ(to_truth(snap(*lattice, scene.positions[index])), expected[k])
          << "triangle " << t << ", vertex " << k << ", bits " << bits;
      ASSERT_EQ(to_truth(all[index]), expected[k]);
    }
  }
}

TEST(GridPieces, LatticeAndSnapping) {
  Random random(101);
  std::size_t vertices = 0;
  for (int i = 0; i < 1500 && !HasFatalFailure(); ++i) {
    const int bits = random.between(kMinBits, kMaxBits);
    expect_same_lattice(extreme_scene(random), bits, vertices);
    expect_same_lattice(any_scene(random, 100).scene, bits, vertices);
  }
  // Ties and points just beside them: k + 1/2 steps and one ulp to either side.
  for (int i = 0; i < 300 && !HasFatalFailure(); ++i) {
    Scene scene;
    const int bits = random.between(6, 20);
    const int steps = (1 << bits) - 5;
    for (int k = 0; k < 20; ++k) {
      const auto tie = [&] {
        const float x = static_cast<float>(random.between(0, steps - 1)) + 0.5F;
        return random.chance(0.5) ? x : std::nextafter(x, random.chance(0.5) ? 0.0F : 1e9F);
      };
      const glm::vec3 a{tie(), tie(), tie()};
      add_triangle(scene, a, glm::vec3{0.0F}, glm::vec3{static_cast<float>(steps)});
    }
    expect_same_lattice(scene, bits, vertices);
  }
  std::printf("lattice and snapping: %zu vertices, 0 differences\n", vertices);
}

void expect_same_segment(const Lattice& lattice, const truth::Lattice& truth, const Ray& ray) {
  ASSERT_TRUE(validate(ray));
  const Segment got = make_segment(lattice, ray);
  const truth::Segment expected = truth::cut(truth, to_truth(ray));
  ASSERT_EQ(got.is_miss(), expected.miss());
  if (expected.miss()) return;
  ASSERT_EQ(to_truth(got.p0), expected.p0);
  ASSERT_EQ(to_truth(got.p1), expected.p1);
  ASSERT_TRUE(truth::close(got.t0, expected.t0, 1e-13)) << got.t0 << " " << expected.t0.get_d();
  ASSERT_TRUE(truth::close(got.t1, expected.t1, 1e-13)) << got.t1 << " " << expected.t1.get_d();
}

TEST(GridPieces, SegmentsOfEveryKindOfRay) {
  Random random(102);
  std::size_t count = 0;
  for (int round = 0; round < 120; ++round) {
    const Scene scene = round % 4 == 0 ? extreme_scene(random) : any_scene(random, 60).scene;
    const int bits = random.between(kMinBits, kMaxBits);
    const auto lattice = make_lattice(scene.positions, scene.triangles, bits);
    ASSERT_TRUE(lattice);
    const auto grid = make_grid(*lattice, scene.triangles.size(), {});
    ASSERT_TRUE(grid);
    const truth::Lattice truth = truth::snap_scene(scene, bits).lattice;
    for (const Ray& ray : any_rays(scene, truth, *grid, 1000, random)) {
      const auto finite = [](const glm::dvec3& v) {
        return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
      };
      if (!finite(ray.origin) || !finite(ray.direction)) continue;
      ++count;
      expect_same_segment(*lattice, truth, ray);
      if (HasFatalFailure()) {
        const auto* names = "xyz";
        for (int i = 0; i < 3; ++i) {
          std::printf("%c: origin %a direction %a lo %a scale %d box %d\n", names[i], ray.origin[i],
                      ray.direction[i], lattice->lo[i], lattice->scale[i], lattice->box()[i]);
        }
        std::printf("tmin %a tmax %a, round %d\n", ray.tmin, ray.tmax, round);
        return;
      }
    }
  }
  std::printf("segments: %zu rays, 0 differences\n", count);
}

TEST(GridPieces, SegmentsOfRaysWithAnyExponents) {
  Random random(103);
  const Scene scene = sphere(6, 8, glm::vec3{0.25F}, 1.0F);
  const auto lattice = make_lattice(scene.positions, scene.triangles, 17);
  const truth::Lattice truth = truth::snap_scene(scene, 17).lattice;
  std::size_t cuts = 0;
  for (int i = 0; i < 40000; ++i) {
    Ray ray;
    const int span = 1 << random.between(1, 10);
    for (int k = 0; k < 3; ++k) {
      ray.origin[k] = random.chance(0.1) ? -0.0 : random.scaled(-std::min(span, 1074), 4);
      ray.direction[k] = random.chance(0.1) ? -0.0 : random.scaled(-std::min(span, 1074), span - 1);
    }
    if (ray.direction == glm::dvec3{0.0}) continue;
    if (random.chance(0.3)) ray.tmin = std::abs(random.scaled(-std::min(span, 1074), 3));
    if (random.chance(0.3)) ray.tmax = ray.tmin + std::abs(random.scaled(-60, span - 1));
    expect_same_segment(*lattice, truth, ray);
    if (HasFatalFailure()) {
      std::printf("origin %a %a %a direction %a %a %a t %a %a\n", ray.origin.x, ray.origin.y,
                  ray.origin.z, ray.direction.x, ray.direction.y, ray.direction.z, ray.tmin,
                  ray.tmax);
      return;
    }
    if (!make_segment(*lattice, ray).is_miss()) ++cuts;
  }
  EXPECT_GT(cuts, 10000U);
}

TEST(GridPieces, ExactTestKeyAndParameters) {
  Random random(104);
  std::size_t tests = 0;
  std::size_t hits = 0;
  for (int round = 0; round < 300; ++round) {
    const int bits = random.between(kMinBits, kMaxBits);
    const truth::Tracer scene(any_scene(random, 40).scene, bits, truth::Search::kAll);
    for (Segment s : exact_segments(scene, 100, random)) {
      if (s.is_miss()) continue;
      s.t0 = random.uniform(0.0, 3.0);
      s.t1 = s.t0 + random.uniform(0.0, 1e6);
      const truth::Segment as_truth = to_truth(s);
      for (const truth::Triangle& triangle : scene.triangles()) {
        ++tests;
        const auto got = intersect_exact(s.p0, s.p1, to_engine(triangle));
        const auto expected = truth::meet(as_truth.p0, as_truth.p1, triangle);
        ASSERT_EQ(got.has_value(), expected.has_value());
        if (!got) continue;
        ++hits;
        ASSERT_EQ(hit_quotient(*got), expected->quotient());
        const HitParameters p = hit_parameters(s, *got);
        ASSERT_EQ(truth::check_parameters(as_truth, *expected, p.t, p.u, p.v), "");
      }
    }
  }
  EXPECT_GT(hits, tests / 100);
  std::printf("exact test: %zu tests, %zu hits, 0 differences\n", tests, hits);
}

TEST(GridPieces, StartsOfSecondaryRays) {
  Random random(105);
  std::size_t starts = 0;
  std::size_t moved_ends = 0;
  std::size_t outside = 0;
  for (int round = 0; round < 300; ++round) {
    const int bits = random.between(kMinBits, kMaxBits);
    const Scene scene = any_scene(random, 60).scene;
    const truth::Tracer tracer(scene, bits, truth::Search::kAll);
    const auto lattice = make_lattice(scene.positions, scene.triangles, bits);
    ASSERT_TRUE(lattice);
    for (const Segment& s : exact_segments(tracer, 200, random)) {
      const auto hit = tracer.closest(to_truth(s));
      if (!hit) continue;
      const truth::Triangle& triangle = tracer.triangles()[static_cast<std::size_t>(hit->id)];
      glm::dvec3 way = random.direction();
      if (random.chance(0.3)) {  // along an edge, exactly where the scale is the same on all axes
        const glm::ivec3 edge = to_engine(triangle.b) - to_engine(triangle.a);
        for (int i = 0; i < 3; ++i) way[i] = std::ldexp(edge[i], -lattice->scale[i]);
      }
      if (random.chance(0.1)) way *= std::exp2(random.between(-900, 900));
      const auto expected = truth::secondary_start(tracer.lattice(), to_truth(s.p0), to_truth(s.p1),
                                                   triangle, {way.x, way.y, way.z});
      const auto got = secondary_origin(*lattice, s, to_engine(triangle), way);
      ++starts;
      ASSERT_EQ(got.has_value(), expected.has_value());
      if (!expected) {
        ++outside;
        continue;
      }
      ASSERT_EQ(to_truth(*got), *expected);
      // The rest of the ray: its end is the box's, its start the point, its parameter there 0.
      const auto id = static_cast<std::uint32_t>(hit->id);
      const Ray ray{in_scene(tracer.lattice(), glm::dvec3{*got}), way, 0.0};
      if (way == glm::dvec3{0.0}) continue;
      const Segment whole = make_segment(*lattice, ray);
      const Segment rest = make_secondary_segment(*lattice, ray, *got, to_engine(triangle), id);
      const truth::Segment cut = truth::cut(tracer.lattice(), to_truth(ray));
      if (!cut.meets_box) {
        ASSERT_TRUE(rest.is_miss());
        continue;
      }
      ASSERT_EQ(rest.p0, *got);
      const truth::Point end =
          truth::secondary_end(tracer.lattice(), cut.p1, triangle, {way.x, way.y, way.z});
      if (end != cut.p1) ++moved_ends;
      ASSERT_EQ(to_truth(rest.p1), end);
      ASSERT_EQ(rest.t0, 0.0);
      ASSERT_TRUE(truth::close(rest.t1, cut.t1, 1e-13));
      ASSERT_EQ(rest.ignore, id);
      ASSERT_TRUE(whole.is_miss() || whole.p1 == rest.p1 || end != cut.p1);
    }
  }
  EXPECT_GT(starts, 20000U);
  EXPECT_GT(moved_ends, 0U);
  std::printf("secondary starts: %zu, %zu outside the box; %zu ends moved; 0 differences\n", starts,
              outside, moved_ends);
}

TEST(Case28, NanAndInfinityAreRefusedWhereTheyEnter) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  const Ray good{{0, 0, 0}, {0, 0, 1}, 0.0, infinity};
  EXPECT_TRUE(validate(good));
  for (const double bad : {nan, infinity, -infinity}) {
    for (int i = 0; i < 3; ++i) {
      Ray ray = good;
      ray.origin[i] = bad;
      EXPECT_FALSE(validate(ray));
      ray = good;
      ray.direction[i] = bad;
      EXPECT_FALSE(validate(ray));
      std::vector<glm::vec3> positions{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
      positions[1][i] = static_cast<float>(bad);
      const std::vector<std::array<std::uint32_t, 3>> triangles{{0, 1, 2}};
      const auto lattice = make_lattice(positions, triangles, kDefaultBits);
      ASSERT_FALSE(lattice);
      EXPECT_EQ(lattice.error().kind, ErrorKind::kInput);
      EXPECT_NE(lattice.error().message.find("vertex 1"), std::string::npos);
    }
    Ray ray = good;
    ray.tmin = bad;
    EXPECT_FALSE(validate(ray));
  }
  for (const auto& [tmin, tmax] :
       {std::pair{-1.0, 1.0}, std::pair{2.0, 1.0}, std::pair{0.0, nan}, std::pair{-1e-300, 1.0}}) {
    EXPECT_FALSE(validate({{0, 0, 0}, {0, 0, 1}, tmin, tmax})) << tmin << " " << tmax;
  }
  EXPECT_FALSE(validate({{0, 0, 0}, {0, -0.0, 0}}));
  EXPECT_TRUE(validate({{0, 0, 0}, {0, std::numeric_limits<double>::denorm_min(), 0}}));
}

}  // namespace
}  // namespace gridrt::adversarial
