#include "tests/rtl/board_rays.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <numeric>
#include <span>
#include <utility>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "host/driver/ray_order.hpp"
#include "host/image/image.hpp"
#include "host/render/waves.hpp"

namespace gridrt::rtl {
namespace {

constexpr double kShare = 0.95;
constexpr int kTile = 8;
constexpr std::size_t kRandomRays = 100000;
/// From the scene to the viewer.
constexpr std::array<glm::dvec3, 4> kToward{
    {{0.5, 0.35, 1.0}, {-1.0, 0.15, 0.3}, {-0.4, 1.0, -0.7}, {0.9, -0.1, -0.8}}};

/// Passes everything on to another device and keeps what it was asked.
class Recorder final : public Device {
 public:
  explicit Recorder(std::unique_ptr<Device> device) : device_(std::move(device)) {}

  Result<void> load(const Image& image) override { return device_->load(image); }
  Result<void> trace(std::span<const Segment> segments, Query query, std::span<Hit> hits) override {
    auto done = device_->trace(segments, query, hits);
    RayWave& wave = waves_.emplace_back();
    wave.query = query;
    wave.segments.assign(segments.begin(), segments.end());
    for (const Hit& hit : hits) wave.answers.push_back(hit.id);
    return done;
  }
  Result<DeviceCounters> counters() override { return device_->counters(); }
  [[nodiscard]] const protocol::CapabilitiesReport& capabilities() const override {
    return device_->capabilities();
  }
  [[nodiscard]] std::string name() const override { return device_->name(); }

  std::vector<RayWave> take() { return std::exchange(waves_, {}); }

 private:
  std::unique_ptr<Device> device_;
  std::vector<RayWave> waves_;
};

/// Indices of a picture's pixels, tile by tile.
std::vector<std::size_t> tile_order(int width, int height) {
  std::vector<std::size_t> order;
  for (int ty = 0; ty < height; ty += kTile) {
    for (int tx = 0; tx < width; tx += kTile) {
      for (int y = ty; y < std::min(ty + kTile, height); ++y) {
        for (int x = tx; x < std::min(tx + kTile, width); ++x) {
          order.push_back(static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                          static_cast<std::size_t>(x));
        }
      }
    }
  }
  return order;
}

/// The rays of one wave, in the order in which they go to a device; misses are sent to none.
std::vector<std::size_t> order_of(const RayWave& wave, const WaveOptions& options) {
  std::vector<std::size_t> order(wave.segments.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto pixels =
      static_cast<std::size_t>(options.width) * static_cast<std::size_t>(options.height);
  if (options.order == RayOrder::kTiles && order.size() == pixels) {
    order = tile_order(options.width, options.height);
  }
  std::erase_if(order, [&](std::size_t i) { return wave.segments[i].is_miss(); });
  return options.order == RayOrder::kSpread ? spread(order) : order;
}

/// Waves one after the other as one, cut to `most` rays.
RayWave arrange(std::span<const RayWave> waves, std::string name, const WaveOptions& options) {
  std::vector<std::vector<std::size_t>> orders;
  std::size_t all = 0;
  for (const RayWave& wave : waves) {
    orders.push_back(order_of(wave, options));
    all += orders.back().size();
  }
  RayWave out;
  out.name = std::move(name);
  for (std::size_t w = 0; w < waves.size(); ++w) {
    std::span<const std::size_t> order = orders[w];
    out.query = waves[w].query;
    if (options.most != 0 && options.most < all) {
      const std::size_t count = order.size() * options.most / all;
      // In the spread order any run will do; in another one a ray left out would change the order,
      // so that the run comes from the middle.
      const bool any = options.order == RayOrder::kSpread;
      order = order.subspan(any ? 0 : (order.size() - count) / 2, count);
    }
    for (const std::size_t i : order) {
      out.segments.push_back(waves[w].segments[i]);
      out.answers.push_back(waves[w].answers[i]);
    }
  }
  return out;
}

/// Between points anywhere in the box (splitmix64).
std::vector<Segment> random_segments(const glm::ivec3& box) {
  std::uint64_t state = 11;
  const auto below = [&](int bound) {
    state += 0x9E3779B97F4A7C15U;
    std::uint64_t z = state;
    z = (z ^ (z >> 30U)) * 0xBF58476D1CE4E5B9U;
    z = (z ^ (z >> 27U)) * 0x94D049BB133111EBU;
    return static_cast<int>((z ^ (z >> 31U)) % static_cast<std::uint64_t>(bound));
  };
  std::vector<Segment> segments(kRandomRays);
  for (Segment& s : segments) {
    for (int a = 0; a < 3; ++a) {
      s.p0[a] = below(box[a] + 1);
      s.p1[a] = below(box[a] + 1);
    }
    s.t1 = 1.0;
  }
  return segments;
}

/// Every surface sends a mirror ray, and light comes from somewhere.
Scene mirrored(const Scene& scene) {
  Scene out = scene;
  for (Material& m : out.materials) {
    m.mirror = glm::vec3{0.5F};
    m.transmission = glm::vec3{0.0F};
  }
  if (out.lights.empty()) {
    Light light;
    light.kind = Light::Kind::kDirectional;
    light.direction = {-0.4, -1.0, -0.5};
    out.lights.push_back(light);
  }
  return out;
}

}  // namespace

Camera fill_view(const Scene& scene, const glm::dvec3& toward, int width, int height,
                 double share) {
  constexpr double kDegrees = 40.0;
  constexpr int kRounds = 40;
  const glm::dvec3 back = glm::normalize(toward);
  Camera camera;
  camera.fov_degrees = kDegrees;
  camera.up = {0.0, 1.0, 0.0};
  const glm::dvec3 right = glm::normalize(glm::cross(camera.up, back));
  const glm::dvec3 up = glm::cross(back, right);
  glm::dvec3 lo{scene.positions[scene.triangles[0][0]]};
  glm::dvec3 hi = lo;
  for (const auto& triangle : scene.triangles) {
    for (const std::uint32_t i : triangle) {
      const glm::dvec3 p{scene.positions[i]};
      for (int a = 0; a < 3; ++a) {
        lo[a] = std::min(lo[a], p[a]);
        hi[a] = std::max(hi[a], p[a]);
      }
    }
  }
  camera.look = (lo + hi) * 0.5;
  const double size = glm::length(hi - lo);
  const double tan_y = std::tan(kDegrees * std::numbers::pi / 360.0);
  const double tan_x = tan_y * width / height;
  double distance = 3.0 * size;
  for (int round = 0; round < kRounds; ++round) {
    std::array<double, 4> bounds{1e300, -1e300, 1e300, -1e300};  // of x and y, in half pictures
    for (const auto& triangle : scene.triangles) {
      for (const std::uint32_t i : triangle) {
        const glm::dvec3 p = glm::dvec3{scene.positions[i]} - camera.look;
        const double depth = std::max(distance - glm::dot(p, back), 1e-3 * size);
        const double x = glm::dot(p, right) / (depth * tan_x);
        const double y = glm::dot(p, up) / (depth * tan_y);
        bounds = {std::min(bounds[0], x), std::max(bounds[1], x), std::min(bounds[2], y),
                  std::max(bounds[3], y)};
      }
    }
    camera.look += right * (0.5 * (bounds[0] + bounds[1]) * tan_x * distance) +
                   up * (0.5 * (bounds[2] + bounds[3]) * tan_y * distance);
    const double filled = 0.5 * std::max(bounds[1] - bounds[0], bounds[3] - bounds[2]);
    distance *= std::clamp(filled / share, 0.5, 2.0);
  }
  camera.eye = camera.look + back * distance;
  return camera;
}

Result<std::vector<RayWave>> make_waves(const Scene& scene, const WaveOptions& options) {
  if (scene.triangles.empty()) {
    return fail(ErrorKind::kInput, "a scene without triangles has no views");
  }
  const Scene shown = mirrored(scene);
  ImageOptions wide;
  wide.with_scene = false;
  const auto image = build_image(shown, wide);
  if (!image) return std::unexpected(image.error());
  const auto triangles = decode_triangles(*image);
  if (!triangles) return std::unexpected(triangles.error());
  auto software = open_device({.name = "omp"});
  if (!software) return std::unexpected(std::move(software.error()));
  Recorder recorder(std::move(*software));
  if (auto loaded = recorder.load(*image); !loaded) return std::unexpected(loaded.error());
  const Lattice lattice = image->lattice();

  std::vector<RayWave> waves;
  RenderOptions render_options;
  render_options.width = options.width;
  render_options.height = options.height;
  render_options.depth = 1;
  render_options.wave_rays =
      static_cast<std::size_t>(options.width) * static_cast<std::size_t>(options.height);
  for (int view = 0; view < options.views; ++view) {
    const Camera camera = fill_view(shown, kToward[static_cast<std::size_t>(view)], options.width,
                                    options.height, kShare);
    const auto pinhole = PinholeCamera::create(camera, options.width, options.height);
    if (!pinhole) return std::unexpected(pinhole.error());
    RenderReport report;
    const auto film =
        render({shown, lattice, *triangles, *pinhole}, render_options, recorder, report);
    if (!film) return std::unexpected(film.error());
    // Primary rays, shadow rays of each light, mirror rays, and what these cast.
    const std::vector<RayWave> traced = recorder.take();
    std::size_t mirror = 1;
    while (mirror < traced.size() && traced[mirror].query == Query::kAnyHit) ++mirror;
    waves.push_back(arrange({traced.data(), 1}, fmt::format("primary {}", view), options));
    waves.push_back(
        arrange({traced.data() + 1, mirror - 1}, fmt::format("shadow {}", view), options));
    if (mirror == traced.size()) continue;
    waves.push_back(arrange({traced.data() + mirror, 1}, fmt::format("mirror {}", view), options));
  }
  const std::vector<Segment> random = random_segments(lattice.box());
  std::vector<Hit> hits(random.size());
  if (auto done = recorder.trace(random, Query::kClosestHit, hits); !done) {
    return std::unexpected(done.error());
  }
  waves.push_back(arrange(recorder.take(), "random 0", options));
  return waves;
}

}  // namespace gridrt::rtl
