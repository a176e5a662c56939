// Many rays to segments at once: the bits of one ray after the other, from every kind of vectors.
#include <bit>
#include <cstdint>

#include <gtest/gtest.h>

#include "host/grid/segments.hpp"
#include "host/grid/voxel_grid.hpp"
#include "tests/adversarial/meshes.hpp"
#include "tests/adversarial/rays.hpp"

namespace gridrt {
namespace {

/// Numbers at the edges of what the filter takes, and beyond.
std::vector<Ray> extreme_rays(const std::vector<Ray>& rays, adversarial::Random& random) {
  std::vector<Ray> out;
  for (Ray ray : rays) {
    const int axis = random.between(0, 2);
    switch (random.between(0, 6)) {
      case 0:
        ray.direction[axis] = 0.0;
        break;
      case 1:
        ray.direction *= 0x1p-205;
        break;
      case 2:
        ray.direction *= 0x1p205;
        break;
      case 3:
        ray.origin[axis] += random.chance(0.5) ? 0x1p190 : 0x1p-190;
        break;
      case 4:
        ray.tmin = ray.tmax = random.unit();
        break;
      case 5:
        ray.direction = {};
        ray.direction[axis] = random.chance(0.5) ? 1.0 : -0.25;
        break;
      default:
        ray.tmin = random.unit();
        ray.tmax = ray.tmin * 0x1p201;
    }
    if (validate(ray)) out.push_back(ray);
  }
  return out;
}

bool equal(const Segment& a, const Segment& b) {
  const auto bits = [](double x) { return std::bit_cast<std::uint64_t>(x); };
  return a.p0 == b.p0 && a.p1 == b.p1 && bits(a.t0) == bits(b.t0) && bits(a.t1) == bits(b.t1) &&
         a.ignore == b.ignore;
}

TEST(Segments, EveryKindOfVectorsMakesThoseOfSingleRays) {
  adversarial::Random random(17);
  std::size_t cut = 0;
  for (const int bits : {8, 17, 24}) {
    for (const Scene& scene :
         {adversarial::soup(200, 6.0, random), adversarial::sheet(6, 0.0, random),
          adversarial::box(2, {-1, -1, -1}, {1e6F, 2, 3e-6F})}) {
      const Lattice lattice = make_lattice(scene.positions, scene.triangles, bits).value();
      const truth::Tracer truth(scene, bits, truth::Search::kAll);
      const VoxelGrid grid = make_grid(lattice, scene.triangles.size(), {}).value();
      std::vector<Ray> rays = adversarial::any_rays(scene, truth.lattice(), grid, 8003, random);
      const std::vector<Ray> more = extreme_rays(rays, random);
      rays.insert(rays.end(), more.begin(), more.end());
      std::vector<Segment> expected;
      for (const Ray& ray : rays) {
        expected.push_back(make_segment(lattice, ray));
        cut += expected.back().is_miss() ? 0 : 1;
      }
      for (const SegmentKernel& kernel : segment_kernels()) {
        std::vector<Segment> got(rays.size());
        kernel.make(lattice, rays, got);
        std::size_t differ = 0;
        for (std::size_t i = 0; i < rays.size(); ++i) differ += equal(got[i], expected[i]) ? 0 : 1;
        EXPECT_EQ(differ, 0U) << kernel.name << ", " << bits << " bits";
      }
    }
  }
  EXPECT_GT(cut, 40000U);
}

TEST(Segments, KindsAreTheWidestFirstAndTheBaselineLast) {
  const auto kernels = segment_kernels();
  ASSERT_FALSE(kernels.empty());
  EXPECT_EQ(kernels.back().name, "baseline");
}

}  // namespace
}  // namespace gridrt
