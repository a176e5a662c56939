// Cases 4, 6 and 12: scenes scaled by powers of two, slivers, signs of zero.
#include <bit>
#include <cmath>

#include "tests/adversarial/cases.hpp"

namespace gridrt::adversarial {
namespace {

bool same_bits(const Hit& a, const Hit& b) {
  const auto bits = [](double x) { return std::bit_cast<std::uint64_t>(x); };
  return a.id == b.id && bits(a.t) == bits(b.t) && bits(a.u) == bits(b.u) && bits(a.v) == bits(b.v);
}

TEST(Case04, ScaledByPowersOfTwoTheAnswersAreTheSameBits) {
  Tally tally;
  Random random(4);
  for (int mesh = 0; mesh < 3; ++mesh) {
    Scene scene = mesh == 0   ? sphere(8, 12, {0.25F, -0.5F, 3.0F}, 1.25F)
                  : mesh == 1 ? soup(150, 6.0, random)
                              : slivers(80, 1e5, random);
    std::vector<Ray> rays;
    std::vector<Hit> reference;
    for (int step = 0; step <= 120; ++step) {
      const int k = step == 0 ? 0 : (step <= 60 ? step : 60 - step);  // 0, 1 .. 60, -1 .. -60
      Scene scaled = scene;
      for (auto& p : scaled.positions) {
        for (int i = 0; i < 3; ++i) p[i] = std::ldexp(p[i], k);
      }
      with_bench(scaled, random_configuration(random, kDefaultBits), [&](const Bench& bench) {
        if (step == 0) rays = any_rays(scene, bench.truth().lattice(), bench.grid(), 400, random);
        std::vector<Ray> larger = rays;
        for (Ray& ray : larger) {
          for (int i = 0; i < 3; ++i) {
            ray.origin[i] = std::ldexp(ray.origin[i], k);
            ray.direction[i] = std::ldexp(ray.direction[i], k);
          }
        }
        const auto hits = bench.check_rays(larger, tally);
        if (step == 0) reference = hits;
        for (std::size_t i = 0; i < hits.size(); ++i) {
          ASSERT_TRUE(same_bits(hits[i], reference[i])) << "k = " << k << ", ray " << i;
        }
      });
      if (HasFatalFailure()) return;
    }
  }
  report("case 04, scaled by 2^-60 to 2^60", tally);
}

TEST(Case06, SliversOfAspect1000To1000000000000) {
  Tally tally;
  Random random(6);
  for (int exponent = 3; exponent <= 12; ++exponent) {
    for (int round = 0; round < 3; ++round) {
      const Scene scene = slivers(200, std::pow(10.0, exponent), random);
      with_bench(scene, random_configuration(random, random.between(14, 24)),
                 [&](const Bench& bench) {
                   bench.check_rays(aimed_rays(scene, 1000, random), tally);
                   bench.check_rays(random_rays(bounds_of(scene), 300, random), tally);
                   bench.check_segments(exact_segments(bench.truth(), 1000, random), tally);
                 });
    }
  }
  report("case 06, slivers", tally);
}

TEST(Case12, SignsOfZeroDoNotMatter) {
  Tally tally;
  Random random(12);
  std::size_t flipped = 0;
  for (int round = 0; round < 10; ++round) {
    Scene scene = lattice_soup(100, 4, random);
    for (auto& p : scene.positions) p -= glm::vec3{2.0F};
    with_bench(scene, random_configuration(random, kDefaultBits), [&](const Bench& bench) {
      std::vector<Ray> plus = grid_rays(bench.truth().lattice(), bench.grid(), 500, random);
      for (Ray& ray : plus) {
        if (random.chance(0.5)) ray.origin[random.between(0, 2)] = 0.0;
        ray.tmin = 0.0;
      }
      std::vector<Ray> minus = plus;
      for (std::size_t i = 0; i < plus.size(); ++i) {
        for (int k = 0; k < 3; ++k) {
          if (plus[i].direction[k] == 0.0) {
            plus[i].direction[k] = 0.0;
            minus[i].direction[k] = -0.0;
            ++flipped;
          }
          if (plus[i].origin[k] == 0.0) minus[i].origin[k] = -0.0;
        }
        minus[i].tmin = -0.0;
      }
      const auto a = bench.check_rays(plus, tally);
      const auto b = bench.check_rays(minus, tally);
      for (std::size_t i = 0; i < a.size(); ++i) ASSERT_TRUE(same_bits(a[i], b[i]));
    });
    // The same for zeros among the vertices.
    for (auto& p : scene.positions) {
      for (int k = 0; k < 3; ++k) {
        if (p[k] == 0.0F && random.chance(0.5)) p[k] = -0.0F;
      }
    }
    with_bench(scene, random_configuration(random, kDefaultBits), [&](const Bench& bench) {
      bench.check_rays(aimed_rays(scene, 300, random), tally);
    });
  }
  EXPECT_GT(flipped, 1000U);
  report("case 12, signs of zero", tally);
}

}  // namespace
}  // namespace gridrt::adversarial
