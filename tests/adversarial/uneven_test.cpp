// Cases 19 and 21 to 23: big triangles among small ones, a teapot in a stadium, thin boxes,
// clusters far apart; and the meshes that people trace.
#include <filesystem>

#include "host/scene/load.hpp"
#include "tests/adversarial/cases.hpp"

namespace gridrt::adversarial {
namespace {

void check_all_kinds(const Scene& scene, int bits, std::size_t rays, Random& random, Tally& tally) {
  with_bench(scene, random_configuration(random, bits), [&](const Bench& bench) {
    const auto any = any_rays(scene, bench.truth().lattice(), bench.grid(), rays, random);
    bench.check_rays(any, tally, exact_segments(bench.truth(), rays / 2, random));
  });
}

TEST(Case19, ATriangleThroughEveryCellAmongSmallOnes) {
  Tally tally;
  Random random(19);
  for (int round = 0; round < 24; ++round) {
    Scene scene;
    const int big = random.between(1, 12);
    const Scene small = soup(300, 7.0, random);
    const Scene large = soup(big, 0.0, random);
    if (round % 2 == 0) add_scene(scene, large, 1.6F, glm::vec3{-0.3F});
    add_scene(scene, small);
    if (round % 2 == 1) add_scene(scene, large, 1.6F, glm::vec3{-0.3F});
    check_all_kinds(scene, random.between(10, 20), 1200, random, tally);
  }
  report("case 19, big among small", tally);
}

TEST(Case21, ATeapotInAStadium) {
  Tally tally;
  Random random(21);
  auto teapot = load_scene("builtin:teapot");
  ASSERT_TRUE(teapot) << teapot.error().message;
  const Bounds own = bounds_of(*teapot);
  const float size = 1e-4F / static_cast<float>(own.extent().x);
  for (int round = 0; round < 3; ++round) {
    Scene scene = box(4, glm::vec3{0.0F}, {1.0F, 0.3F, 1.0F});
    const glm::vec3 at{0.31F + 0.2F * static_cast<float>(round), 0.11F, 0.47F};
    add_scene(scene, *teapot, size, at);
    // Rays at the teapot in particular: most of any_rays go past it.
    with_bench(scene, random_configuration(random, round == 0 ? 17 : 24), [&](const Bench& bench) {
      bench.check_rays(any_rays(scene, bench.truth().lattice(), bench.grid(), 4000, random), tally);
      std::vector<Ray> rays = random_rays({at, at + 1e-4F}, 4000, random);
      for (Ray& ray : rays) ray.origin = random.in_box({0, 0, 0}, {1, 0.3, 1});
      bench.check_rays(rays, tally);
      bench.check_segments(exact_segments(bench.truth(), 2000, random), tally);
    });
  }
  report("case 21, a teapot in a stadium", tally);
}

TEST(Case22, BoxesOf1To1000To1000) {
  Tally tally;
  Random random(22);
  for (int round = 0; round < 12; ++round) {
    Scene scene = round % 2 == 0 ? box(3, {0, 0, 0}, {1, 1, 1}) : soup(200, 3.0, random);
    for (auto& p : scene.positions) {
      p[round % 3] *= 1000.0F;
      if (round % 4 < 2) p[(round + 1) % 3] *= 1000.0F;
    }
    check_all_kinds(scene, random.between(10, 24), 1500, random, tally);
  }
  report("case 22, boxes of 1 : 1000 : 1000", tally);
}

TEST(Case23, ClustersFarApartAndAStrayVertex) {
  Tally tally;
  Random random(23);
  const Scene part = sphere(12, 16, {0, 0, 0}, 1.0F);
  for (int round = 0; round < 8; ++round) {
    Scene scene;
    for (int i = 0; i < 18; ++i) {
      const glm::vec3 at{random.in_box(glm::dvec3{-1000.0}, glm::dvec3{1000.0})};
      add_scene(scene, part, static_cast<float>(random.uniform(0.5, 4.0)), at);
    }
    if (round % 2 == 1) add_triangle(scene, {0, 0, 0}, {1, 0, 0}, {3e5F, 7e4F, -2e5F});
    check_all_kinds(scene, random.between(14, 24), 2000, random, tally);
  }
  report("case 23, clusters and a stray vertex", tally);
}

TEST(Meshes, ThatPeopleTrace) {
  Tally tally;
  Random random(90);
  const std::filesystem::path folder = GRIDRT_SCENES;
  std::vector<std::string> specs{"builtin:teapot", "builtin:teapots", "builtin:room"};
  for (const char* name : {"suzanne.obj", "teapot.obj", "stanford-bunny.obj"}) {
    if (std::filesystem::exists(folder / name)) {
      specs.push_back((folder / name).string());
    } else {
      std::printf("%s is not there: left out\n", name);
    }
  }
  for (const std::string& spec : specs) {
    const auto scene = load_scene(spec);
    ASSERT_TRUE(scene) << scene.error().message;
    Tally one;
    check_all_kinds(*scene, kDefaultBits, 8000, random, one);
    report(std::filesystem::path(spec).filename().string(), one);
    tally += one;
  }
  report("meshes that people trace", tally);
}

}  // namespace
}  // namespace gridrt::adversarial
