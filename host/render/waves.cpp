#include "host/render/waves.hpp"

#include <algorithm>
#include <chrono>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "host/grid/parallel.hpp"
#include "host/grid/segments.hpp"
#include "host/render/shading.hpp"
#include "host/render/surface.hpp"

namespace gridrt {
namespace {

/// A ray of a wave, and where its light goes.
struct Path {
  Ray ray;
  Segment segment;
  glm::dvec3 weight{1.0};
  std::uint32_t sample = 0;  ///< index into the band's samples
};
using Wave = std::vector<Path>;

class WaveTracer {
 public:
  WaveTracer(const RenderInput& input, const RenderOptions& options, Device& device,
             const SurfaceTable& surfaces, RenderReport& report)
      : input_(input), options_(options), device_(device), surfaces_(surfaces), report_(report) {}

  /// Renders `pixels` pixels from `first` on into the film. Every ray of a sample adds its light in
  /// the order depth, place in the wave, light source: the same however waves are cut.
  Result<void> band(Film& film, std::size_t first, std::size_t pixels, const PrimarySink& sink);

 private:
  Result<void> trace(std::span<const Segment> segments, Query query, std::span<Hit> hits);
  Result<void> run(Wave wave, int depth, const PrimarySink& sink);
  Result<Wave> shade(const Wave& wave, std::span<const Hit> hits, int depth);
  Result<void> add_light(const Wave& wave, std::span<const Hit> hits,
                         std::span<const Surface> surfaces, const Light& light);
  Wave bounce_all(const Wave& wave, std::span<const Hit> hits, std::span<const Surface> surfaces);
  [[nodiscard]] Segment secondary(const Path& path, const Hit& hit, const Ray& ray) const;

  const RenderInput& input_;
  const RenderOptions& options_;
  Device& device_;
  const SurfaceTable& surfaces_;
  RenderReport& report_;
  std::vector<glm::dvec3> light_;  ///< collected by each sample of the band
};

Result<void> WaveTracer::trace(std::span<const Segment> segments, Query query,
                               std::span<Hit> hits) {
  if (segments.empty()) return {};
  report_.outside += static_cast<std::uint64_t>(
      std::ranges::count_if(segments, [](const Segment& segment) { return segment.is_miss(); }));
  const auto start = std::chrono::steady_clock::now();
  auto result = device_.trace(segments, query, hits);
  report_.trace_seconds +=
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return result;
}

Segment WaveTracer::secondary(const Path& path, const Hit& hit, const Ray& ray) const {
  const LatticeTriangle& left = surfaces_.triangle(hit.id);
  const auto origin = secondary_origin(input_.lattice, path.segment, left, ray.direction);
  if (!origin) return {};  // it leaves the box: a miss
  return make_secondary_segment(input_.lattice, ray, *origin, left,
                                static_cast<std::uint32_t>(hit.id));
}

Result<void> WaveTracer::band(Film& film, std::size_t first, std::size_t pixels,
                              const PrimarySink& sink) {
  const auto samples = static_cast<std::size_t>(options_.samples);
  const auto width = static_cast<std::size_t>(options_.width);
  Wave wave(pixels * samples);
  light_.assign(wave.size(), glm::dvec3(0.0));
  parallel_pieces(options_.threads, wave.size(), [&](std::size_t from, std::size_t to) {
    std::vector<Ray> rays;
    for (std::size_t i = from; i < to; ++i) {
      const std::size_t pixel = first + (i / samples);
      rays.push_back(
          input_.camera.ray(static_cast<int>(pixel % width), static_cast<int>(pixel / width),
                            sample_position(static_cast<int>(i % samples), options_.samples)));
    }
    std::vector<Segment> segments(rays.size());
    make_segments(input_.lattice, rays, segments);
    for (std::size_t i = from; i < to; ++i) {
      wave[i].ray = rays[i - from];
      wave[i].segment = segments[i - from];
      wave[i].sample = static_cast<std::uint32_t>(i);
    }
  });
  report_.primary += wave.size();
  if (auto done = run(std::move(wave), 0, sink); !done) return done;
  parallel_for(options_.threads, pixels, [&](std::size_t i) {
    glm::dvec3 sum(0.0);
    for (std::size_t j = 0; j < samples; ++j) sum += light_[(i * samples) + j];
    film.pixels[first + i] = glm::vec3(sum / static_cast<double>(samples));
  });
  return {};
}

Result<void> WaveTracer::run(Wave wave, int depth, const PrimarySink& sink) {
  Wave next;
  {
    std::vector<Segment> segments(wave.size());
    for (std::size_t i = 0; i < wave.size(); ++i) segments[i] = wave[i].segment;
    std::vector<Hit> hits(wave.size());
    if (auto traced = trace(segments, Query::kClosestHit, hits); !traced) return traced;
    if (depth == 0 && sink) {
      std::vector<Ray> rays(wave.size());
      for (std::size_t i = 0; i < wave.size(); ++i) rays[i] = wave[i].ray;
      if (auto heard = sink(rays, segments, hits); !heard) return heard;
    }
    auto children = shade(wave, hits, depth);
    if (!children) return std::unexpected(children.error());
    next = std::move(*children);
  }
  Wave().swap(wave);
  if (next.empty()) return {};
  report_.deepest = std::max(report_.deepest, depth + 1);
  // Cut between samples only, so that the order of a sample's sums never depends on the cut.
  for (std::size_t first = 0; first < next.size();) {
    std::size_t last = std::min(next.size(), first + options_.wave_rays);
    std::size_t last_sample = last - 1;  // where the last sample begins
    while (last < next.size() && next[last].sample == next[last_sample].sample) ++last;
    while (last_sample > first && next[last_sample - 1].sample == next[last_sample].sample) {
      --last_sample;
    }
    if (last - last_sample > options_.sample_rays) {
      return fail(ErrorKind::kLimit,
                  fmt::format("a single pixel sample needs {} rays of depth {}", last - last_sample,
                              depth + 1),
                  "use a smaller --depth: mirror and glass double the rays at every bounce");
    }
    if (first == 0 && last == next.size()) return run(std::move(next), depth + 1, sink);
    const auto begin = next.begin();
    Wave part(begin + static_cast<std::ptrdiff_t>(first),
              begin + static_cast<std::ptrdiff_t>(last));
    if (auto done = run(std::move(part), depth + 1, sink); !done) return done;
    first = last;
  }
  return {};
}

Result<Wave> WaveTracer::shade(const Wave& wave, std::span<const Hit> hits, int depth) {
  const Scene& scene = input_.scene;
  for (const Hit& hit : hits) {
    if (hit.id != -1 && !surfaces_.knows(hit.id)) {
      return fail(ErrorKind::kDevice, fmt::format("the device {} answered triangle {}, which the "
                                                  "scene does not have",
                                                  device_.name(), hit.id));
    }
  }
  std::vector<Surface> surfaces(wave.size());
  std::vector<glm::dvec3> parts(wave.size());
  parallel_for(options_.threads, wave.size(), [&](std::size_t i) {
    const Path& path = wave[i];
    if (hits[i].id < 0) {
      parts[i] = path.weight * glm::dvec3(scene.background);
      return;
    }
    surfaces[i] = surfaces_.at(path.ray, path.segment, hits[i]);
    parts[i] = path.weight * unlit_part(surfaces[i], scene.ambient_light);
  });
  for (std::size_t i = 0; i < wave.size(); ++i) light_[wave[i].sample] += parts[i];
  for (const Light& light : scene.lights) {
    if (auto added = add_light(wave, hits, surfaces, light); !added) {
      return std::unexpected(added.error());
    }
  }
  if (depth >= options_.depth) return Wave{};
  return bounce_all(wave, hits, surfaces);
}

Result<void> WaveTracer::add_light(const Wave& wave, std::span<const Hit> hits,
                                   std::span<const Surface> surfaces, const Light& light) {
  struct Request {
    bool wanted = false;
    Segment segment;
    glm::dvec3 radiance{0.0};
  };
  std::vector<Request> requests(wave.size());
  parallel_for(options_.threads, wave.size(), [&](std::size_t i) {
    if (hits[i].id < 0) return;
    const auto sample = sample_light(surfaces[i], wave[i].ray.direction, light);
    if (!sample) return;
    requests[i].wanted = true;
    requests[i].segment = secondary(wave[i], hits[i], sample->shadow);
    requests[i].radiance = wave[i].weight * sample->radiance;
  });
  std::vector<Segment> segments;
  for (const Request& request : requests) {
    if (request.wanted) segments.push_back(request.segment);
  }
  report_.shadow += segments.size();
  std::vector<Hit> shadows(segments.size());
  if (auto traced = trace(segments, Query::kAnyHit, shadows); !traced) return traced;
  std::size_t next = 0;
  for (std::size_t i = 0; i < wave.size(); ++i) {
    if (requests[i].wanted && shadows[next++].id < 0)
      light_[wave[i].sample] += requests[i].radiance;
  }
  return {};
}

Wave WaveTracer::bounce_all(const Wave& wave, std::span<const Hit> hits,
                            std::span<const Surface> surfaces) {
  const auto sends_rays = [](const Material& material) {
    return material.mirror != glm::vec3(0.0F) || material.transmission != glm::vec3(0.0F);
  };
  if (std::ranges::none_of(input_.scene.materials, sends_rays)) return {};
  struct Pair {
    bool mirror = false;
    bool glass = false;
  };
  std::vector<Pair> wanted(wave.size());
  std::vector<std::size_t> first(wave.size() + 1, 0);
  const auto is_zero = [](const glm::dvec3& w) { return w == glm::dvec3(0.0); };
  const auto bounces_at = [&](std::size_t i) {
    Bounces bounces;
    if (hits[i].id < 0) return bounces;
    bounces = bounce(surfaces[i], wave[i].ray.direction);
    if (bounces.mirror && is_zero(bounces.mirror->weight * wave[i].weight)) bounces.mirror.reset();
    if (bounces.glass && is_zero(bounces.glass->weight * wave[i].weight)) bounces.glass.reset();
    return bounces;
  };
  parallel_for(options_.threads, wave.size(), [&](std::size_t i) {
    const Bounces bounces = bounces_at(i);
    wanted[i] = {bounces.mirror.has_value(), bounces.glass.has_value()};
  });
  for (std::size_t i = 0; i < wave.size(); ++i) {
    first[i + 1] = first[i] + (wanted[i].mirror ? 1U : 0U) + (wanted[i].glass ? 1U : 0U);
    report_.mirror += wanted[i].mirror ? 1U : 0U;
    report_.refraction += wanted[i].glass ? 1U : 0U;
  }
  Wave next(first.back());
  parallel_for(options_.threads, wave.size(), [&](std::size_t i) {
    if (!wanted[i].mirror && !wanted[i].glass) return;
    const Bounces bounces = bounces_at(i);
    std::size_t at = first[i];
    for (const auto* sent : {&bounces.mirror, &bounces.glass}) {
      if (!sent->has_value()) continue;
      Path& path = next[at++];
      path.ray = (*sent)->ray;
      path.segment = secondary(wave[i], hits[i], path.ray);
      path.weight = wave[i].weight * (*sent)->weight;
      path.sample = wave[i].sample;
    }
  });
  return next;
}

Result<void> check(const RenderOptions& options) {
  const auto refuse = [](std::string message) {
    return fail(ErrorKind::kUsage, std::move(message));
  };
  if (options.width < 1 || options.height < 1 || options.width > kMaxPictureSide ||
      options.height > kMaxPictureSide ||
      static_cast<std::uint64_t>(options.width) * static_cast<std::uint64_t>(options.height) >
          kMaxPicturePixels) {
    return refuse(
        fmt::format("a picture of {}x{} is out of range: sides 1 to {}, at most {} pixels",
                    options.width, options.height, kMaxPictureSide, kMaxPicturePixels));
  }
  if (options.samples < 1 || options.samples > kMaxSamples) {
    return refuse(
        fmt::format("{} samples a pixel are out of range: 1 to {}", options.samples, kMaxSamples));
  }
  if (options.depth < 0 || options.depth > kMaxDepth) {
    return refuse(fmt::format("a depth of {} is out of range: 0 to {}", options.depth, kMaxDepth));
  }
  if (options.wave_rays < 1) return refuse("a wave needs at least one ray");
  return {};
}

}  // namespace

Result<Film> render(const RenderInput& input, const RenderOptions& options, Device& device,
                    RenderReport& report, const PrimarySink& primary_sink,
                    const ProgressSink& progress) {
  if (auto fine = check(options); !fine) return std::unexpected(fine.error());
  const auto start = std::chrono::steady_clock::now();
  const double traced_before = report.trace_seconds;
  auto surfaces = SurfaceTable::create(input.scene, input.lattice, input.triangles);
  if (!surfaces) return std::unexpected(surfaces.error());
  Film film{options.width, options.height, {}};
  const std::size_t pixels =
      static_cast<std::size_t>(options.width) * static_cast<std::size_t>(options.height);
  film.pixels.resize(pixels);
  const auto samples = static_cast<std::size_t>(options.samples);
  const std::size_t step = std::max<std::size_t>(1, options.wave_rays / samples);
  WaveTracer tracer(input, options, device, *surfaces, report);
  for (std::size_t first = 0; first < pixels; first += step) {
    const std::size_t count = std::min(step, pixels - first);
    if (auto done = tracer.band(film, first, count, primary_sink); !done) {
      return std::unexpected(done.error());
    }
    if (progress) progress((first + count) * samples, pixels * samples);
  }
  const double elapsed =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  report.shade_seconds += elapsed - (report.trace_seconds - traced_before);
  return film;
}

}  // namespace gridrt
