#include "tests/contract/awkward.hpp"

#include <cstdlib>

#include <gtest/gtest.h>

#include "host/image/image.hpp"
#include "tests/adversarial/meshes.hpp"
#include "tests/adversarial/rays.hpp"
#include "tests/truth/tracer.hpp"

namespace gridrt::contract {

using adversarial::Random;

Scene awkward_scene(std::uint64_t seed) {
  Random random(seed);
  Scene scene = adversarial::sphere(8, 12, {4, 4, 4}, 3.0F);
  adversarial::add_scene(scene, adversarial::lattice_soup(80, 8, random));
  adversarial::add_scene(scene, adversarial::slivers(40, 1e5, random), 8.0F);
  adversarial::add_scene(scene, adversarial::box(2, {2, 2, 2}, {6, 6, 6}));
  adversarial::add_scene(scene, adversarial::sphere(8, 12, {4, 4, 4}, 3.0F));  // duplicates
  adversarial::add_triangle(scene, {1, 1, 1}, {2, 2, 2}, {3, 3, 3});           // degenerate
  return scene;
}

std::vector<Segment> awkward_segments(const Scene& scene, int bits, std::uint64_t seed) {
  const char* wanted = std::getenv("GRIDRT_CONTRACT_RAYS");
  const std::size_t n = wanted == nullptr ? 1500 : std::strtoul(wanted, nullptr, 10);
  Random random(seed);
  const truth::Tracer tracer(scene, bits, truth::Search::kAll);
  std::vector<Segment> out = adversarial::exact_segments(tracer, n / 2, random);
  const Lattice lattice = make_lattice(scene.positions, scene.triangles, bits).value();
  const VoxelGrid grid = make_grid(lattice, scene.triangles.size(), {}).value();
  for (const Ray& ray :
       adversarial::any_rays(scene, tracer.lattice(), grid, n - out.size(), random)) {
    out.push_back(make_segment(lattice, ray));
    if (random.chance(0.1)) {
      out.back().ignore = static_cast<std::uint32_t>(random.below(scene.triangles.size()));
    }
  }
  return out;
}

std::vector<Hit> trace(Device& device, std::span<const Segment> segments, Query query) {
  // Filled with something that no device answers.
  std::vector<Hit> hits(segments.size(), Hit{-77, -1.0, -1.0, -1.0});
  const auto done = device.trace(segments, query, hits);
  EXPECT_TRUE(done) << done.error().message;
  return hits;
}

std::vector<Hit> reference(const Scene& scene, int bits, std::span<const Segment> segments,
                           Query query) {
  DeviceOptions options;
  options.name = "seq";
  auto device = open_device(options);
  ImageOptions image_options;
  image_options.bits = bits;
  image_options.pes = 1;
  image_options.with_scene = false;
  const auto image = build_image(scene, image_options);
  EXPECT_TRUE(device && image);
  if (!device || !image) return {};
  const auto loaded = (*device)->load(*image);
  EXPECT_TRUE(loaded) << loaded.error().message;
  return trace(**device, segments, query);
}

}  // namespace gridrt::contract
