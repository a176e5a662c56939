// Cases 2, 30 and 31: rays exactly at edges and vertices; vertex orders and mesh orders; segments
// taken backwards.
#include <algorithm>
#include <numeric>

#include "tests/adversarial/bridge.hpp"
#include "tests/adversarial/cases.hpp"

namespace gridrt::adversarial {
namespace {

TEST(Case02, EdgesAndVerticesOfValence3To64) {
  Tally tally;
  Random random(2);
  for (int valence = 3; valence <= 64; ++valence) {
    for (const float bend : {0.0F, 0.3F}) {
      const Scene scene = fan(valence, bend, random);
      with_bench(scene, random_configuration(random, random.between(10, 20)),
                 [&](const Bench& bench) {
                   bench.check_rays(aimed_rays(scene, 400, random), tally);
                   bench.check_segments(exact_segments(bench.truth(), 400, random), tally);
                   // Straight at the hub, whose every triangle contains it: hit, and by the lowest
                   // id.
                   std::vector<Segment> segments;
                   const glm::ivec3 hub = to_engine(bench.truth().triangles()[0].a);
                   const glm::ivec3 far = bench.lattice().box();
                   for (int i = 0; i < 100; ++i) {
                     Segment s;
                     s.t1 = 1.0;
                     s.p0 = {random.between(0, far.x), random.between(0, far.y), 0};
                     s.p1 = 2 * hub - s.p0;
                     if (s.p1.x < 0 || s.p1.y < 0 || s.p1.z < 0) continue;
                     if (s.p1.x > far.x || s.p1.y > far.y || s.p1.z > far.z) continue;
                     segments.push_back(s);
                   }
                   const auto hits = bench.check_segments(segments, tally);
                   for (const Hit& hit : hits) {
                     EXPECT_GE(hit.id, 0);
                     EXPECT_TRUE(bend != 0.0F || hit.id == 0);
                   }
                 });
    }
  }
  report("case 02, aimed at edges and vertices", tally);
}

TEST(Case02, ClosedSurfacesFromWithinLetNothingOut) {
  Tally tally;
  Random random(22);
  std::size_t leaks = 0;
  for (int round = 0; round < 24; ++round) {
    const Scene scene = round % 2 == 0
                            ? sphere(random.between(3, 24), random.between(3, 24), {1, 2, 3}, 2.0F)
                            : box(random.between(1, 8), {0, 1, 2}, {2, 3, 4});
    const glm::dvec3 middle{1, 2, 3};
    with_bench(scene, random_configuration(random, kDefaultBits), [&](const Bench& bench) {
      std::vector<Ray> rays = aimed_rays(scene, 1500, random);
      for (Ray& ray : rays) {
        const glm::dvec3 target = ray.origin + ray.direction;
        ray.origin = middle + random.in_box(glm::dvec3{-0.3}, glm::dvec3{0.3});
        if (round % 4 < 2) ray.origin = middle;
        ray.direction = target - ray.origin;
        if (ray.direction == glm::dvec3{0.0}) ray.direction.x = 1.0;
      }
      const auto hits = bench.check_rays(rays, tally);
      for (const Hit& hit : hits) leaks += hit.id < 0 ? 1 : 0;
    });
  }
  EXPECT_EQ(leaks, 0U);
  report("case 02, closed surfaces from within", tally);
}

/// The scene with its triangles' corners and order permuted; `order[i]` was triangle i's id.
Scene permuted(const Scene& scene, Random& random, std::vector<std::size_t>& order) {
  order.resize(scene.triangles.size());
  std::iota(order.begin(), order.end(), 0U);
  for (std::size_t i = order.size(); i > 1; --i) std::swap(order[i - 1], order[random.below(i)]);
  Scene out = scene;
  for (std::size_t i = 0; i < order.size(); ++i) {
    auto t = scene.triangles[order[i]];
    for (std::size_t k = 3; k > 1; --k) std::swap(t[k - 1], t[random.below(k)]);
    out.triangles[i] = t;
  }
  return out;
}

TEST(Case30, AnyOrderOfVerticesAndTrianglesHitsTheSameGeometry) {
  Tally tally;
  Random random(30);
  std::size_t ties = 0;
  for (int round = 0; round < 20; ++round) {
    const Scene scene = any_scene(random, 300).scene;
    std::vector<Hit> reference;
    std::vector<Ray> rays;
    std::vector<truth::Closest> closest;
    for (int variant = 0; variant < 6; ++variant) {
      std::vector<std::size_t> order;
      const Scene changed = variant == 0 ? scene : permuted(scene, random, order);
      with_bench(changed, random_configuration(random, kDefaultBits), [&](const Bench& bench) {
        if (variant == 0) {
          rays = any_rays(scene, bench.truth().lattice(), bench.grid(), 1000, random);
        }
        const auto hits = bench.check_rays(rays, tally);
        if (variant == 0) {
          reference = hits;
          return;
        }
        for (std::size_t i = 0; i < hits.size(); ++i) {
          ASSERT_EQ(hits[i].id < 0, reference[i].id < 0);
          if (hits[i].id < 0) continue;
          const std::size_t was = order[static_cast<std::size_t>(hits[i].id)];
          if (was == static_cast<std::size_t>(reference[i].id)) continue;
          // Another triangle may only win a tie: equal to 2^-24 of the segment.
          ++ties;
          const truth::Segment s = truth::cut(bench.truth().lattice(), to_truth(rays[i]));
          const truth::Triangle& there = bench.truth().triangles()[static_cast<std::size_t>(
              std::ranges::find(order, static_cast<std::size_t>(reference[i].id)) - order.begin())];
          ASSERT_EQ(truth::meet(s.p0, s.p1, there)->quotient(), bench.truth().closest(s)->quotient);
        }
      });
    }
  }
  std::printf("case 30: %zu ties won by another triangle in another order\n", ties);
  report("case 30, orders", tally);
}

TEST(Case31, BackwardsMeetsTheSameTriangles) {
  Tally tally;
  Random random(31);
  std::size_t single = 0;
  for (int round = 0; round < 40; ++round) {
    const Scene scene = any_scene(random, 200).scene;
    with_bench(scene, random_configuration(random, random.between(8, 24)), [&](const Bench& bench) {
      std::vector<Segment> forth = exact_segments(bench.truth(), 600, random);
      std::vector<Segment> back = forth;
      for (Segment& s : back) std::swap(s.p0, s.p1);
      const auto a = bench.check_segments(forth, tally);
      const auto b = bench.check_segments(back, tally);
      for (std::size_t i = 0; i < a.size(); ++i) {
        ASSERT_EQ(a[i].id < 0, b[i].id < 0);
        const std::size_t met = bench.truth().count(to_truth(forth[i]));
        ASSERT_EQ(met, bench.truth().count(to_truth(back[i])));
        if (met != 1) continue;
        ++single;
        ASSERT_EQ(a[i].id, b[i].id);
      }
    });
  }
  EXPECT_GT(single, 1000U);
  report("case 31, backwards", tally);
}

}  // namespace
}  // namespace gridrt::adversarial
