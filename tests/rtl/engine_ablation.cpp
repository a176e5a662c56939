// Traces primary rays of a scene of 10,000 triangles on an engine as it was built and prints one
// line: rays, tests, rays that seq answers otherwise, clocks. ablation_test.py compares engines.
#include <cstdio>
#include <random>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "host/driver/device.hpp"
#include "tests/adversarial/meshes.hpp"
#include "tests/contract/awkward.hpp"
#include "tests/rtl/engine_harness.hpp"

namespace gridrt::rtl {
namespace {

constexpr int kBits = GRIDRT_RTL_B;
constexpr std::size_t kRays = 4000;

/// Segments through the whole box from points on a sphere around it, aimed at the middle.
std::vector<Segment> crossing_segments(const Lattice& lattice) {
  std::mt19937_64 random(11);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  const glm::dvec3 middle(4.0);
  std::vector<Segment> out;
  while (out.size() < kRays) {
    const glm::dvec3 direction(unit(random), unit(random), unit(random));
    const double length = glm::length(direction);
    if (length > 1.0 || length < 0.1) continue;
    const glm::dvec3 aim = middle + 2.5 * glm::dvec3(unit(random), unit(random), unit(random));
    Ray ray;
    ray.origin = middle - 10.0 / length * direction;
    ray.direction = aim - ray.origin;
    out.push_back(make_segment(lattice, ray));
  }
  return out;
}

int run() {
  // Two shells: whatever enters meets four surfaces.
  Scene scene = adversarial::sphere(50, 52, {4, 4, 4}, 3.0F);
  adversarial::add_scene(scene, adversarial::sphere(50, 52, {4, 4, 4}, 2.0F));
  ImageOptions options;
  options.bits = kBits;
  options.pes = GRIDRT_RTL_PES;
  options.layout = protocol::Layout::kCompact;
  options.with_scene = false;
  const Result<Image> image = build_image(scene, options);
  if (!image) {
    fmt::print(stderr, "{}\n", image.error().message);
    return 1;
  }
  const std::vector<Segment> segments = crossing_segments(image->lattice());
  const std::vector<std::uint32_t> ids = decode_triangles(*image).value().global_ids;
  const std::vector<Hit> expected = contract::reference(scene, kBits, segments, Query::kClosestHit);
  std::vector<protocol::RayCompact> rays;
  rays.reserve(segments.size());
  for (const Segment& s : segments) rays.push_back(engine_ray(s, ~std::uint32_t{0}, false));
  EngineHarness engine;
  engine.load(*image);
  const EngineAnswers got = engine.trace(rays);
  if (got.hits.size() != rays.size()) {
    fmt::print(stderr, "the engine hangs after {} of {} rays\n", got.hits.size(), rays.size());
    return 1;
  }
  std::size_t wrong = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const std::int32_t id =
        got.hits[i].hit != 0 ? static_cast<std::int32_t>(ids.at(got.hits[i].id)) : -1;
    wrong += id != expected[i].id ? 1 : 0;
  }
  fmt::print("rays {} tests {} wrong {} clocks {} triangles {}\n", rays.size(), got.counts.tests,
             wrong, got.clocks, scene.triangles.size());
  return 0;
}

}  // namespace
}  // namespace gridrt::rtl

int main() { return gridrt::rtl::run(); }
