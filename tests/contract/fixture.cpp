#include "tests/contract/fixture.hpp"

#include <algorithm>
#include <bit>
#include <cstdlib>

#include "host/driver/image_options.hpp"
#include "tests/adversarial/bench.hpp"
#include "tests/adversarial/devices.hpp"
#include "tests/adversarial/meshes.hpp"
#include "tests/adversarial/rays.hpp"

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

bool same(const Hit& a, const Hit& b) {
  const auto bits = [](double x) { return std::bit_cast<std::uint64_t>(x); };
  return a.id == b.id && bits(a.t) == bits(b.t) && bits(a.u) == bits(b.u) && bits(a.v) == bits(b.v);
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

std::vector<std::string> contract_devices() {
  std::vector<std::string> names = adversarial::devices_under_test();
  for (const std::string& name : adversarial::devices_under_test()) {
    if (name == "omp") names.insert(names.end(), {"omp+pes", "omp+paper"});
    if (name == "mpi") names.emplace_back("mpi+paper");
  }
  return names;
}

std::unique_ptr<Device> Contract::open(DeviceOptions options) {
  const std::string& name = GetParam();
  const std::size_t cut = name.find('+');
  options.name = name.substr(0, cut);
  if (cut != std::string::npos) options.schedule = name.substr(cut + 1);
  auto device = open_device(options);
  if (!device) {
    ADD_FAILURE() << device.error().message;
    return nullptr;
  }
  EXPECT_EQ((*device)->name(), options.name);
  return std::move(*device);
}

ImageOptions Contract::plain(int bits, int pes) {
  ImageOptions options;
  options.bits = bits;
  options.with_scene = false;
  const auto device = open();
  if (!device) return options;
  options.pes = pes == 0 ? std::min<int>(4, device->capabilities().pes) : pes;
  return options_for(options, device->capabilities());
}

bool Contract::loads(Device& device, const Image& image) {
  const auto loaded = device.load(image);
  if (loaded) return true;
  const Error& error = loaded.error();
  if (adversarial::is_beyond(image, device.capabilities())) {
    [&] { GTEST_SKIP() << error.message; }();
  } else {
    ADD_FAILURE() << error.message;
  }
  return false;
}

std::vector<Hit> Contract::answers(const DeviceOptions& options, const Image& image,
                                   std::span<const Segment> segments, Query query,
                                   std::string& refused) {
  refused.clear();
  const auto device = open(options);
  if (!device) return {};
  const auto loaded = device->load(image);
  if (!loaded) {
    const ErrorKind kind = loaded.error().kind;
    EXPECT_TRUE(kind == ErrorKind::kLimit || kind == ErrorKind::kUnsupported)
        << loaded.error().message;
    EXPECT_TRUE(adversarial::is_beyond(image, device->capabilities())) << loaded.error().message;
    const auto counters = device->counters();
    EXPECT_TRUE(counters && counters->bytes_out == 0) << "something was sent";
    refused = loaded.error().message;
    return {};
  }
  return trace(*device, segments, query);
}

void expect_same(std::span<const Hit> got, std::span<const Hit> expected, const std::string& what) {
  ASSERT_EQ(got.size(), expected.size()) << what;
  for (std::size_t i = 0; i < got.size(); ++i) {
    ASSERT_TRUE(same(got[i], expected[i]))
        << what << ": ray " << i << ": id " << got[i].id << ", t " << got[i].t << ", u " << got[i].u
        << ", v " << got[i].v << "; seq: id " << expected[i].id << ", t " << expected[i].t << ", u "
        << expected[i].u << ", v " << expected[i].v;
  }
}

}  // namespace gridrt::contract
