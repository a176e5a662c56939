#include "host/render/stream.hpp"

#include <algorithm>
#include <chrono>
#include <vector>

#include "host/grid/parallel.hpp"
#include "host/grid/segments.hpp"

namespace gridrt {
namespace {

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace

Result<void> trace_stream(const Lattice& lattice, Device& device, std::uint64_t total,
                          const RaySource& source, const PrimarySink& sink,
                          const StreamOptions& options, RenderReport& report,
                          const ProgressSink& progress) {
  const auto start = std::chrono::steady_clock::now();
  const double traced_before = report.trace_seconds;
  std::vector<Ray> rays;
  std::vector<Segment> segments;
  std::vector<Hit> hits;
  std::uint64_t first = 0;
  do {  // once even without rays, so that the source can check its end
    const auto count =
        static_cast<std::size_t>(std::min<std::uint64_t>(options.chunk, total - first));
    rays.assign(count, Ray{});
    segments.assign(count, Segment{});
    hits.assign(count, Hit{});
    if (auto filled = source(first, rays); !filled) return filled;
    parallel_pieces(options.threads, count, [&](std::size_t from, std::size_t to) {
      make_segments(lattice, std::span(rays).subspan(from, to - from),
                    std::span(segments).subspan(from, to - from));
    });
    if (count > 0) {
      const auto trace_start = std::chrono::steady_clock::now();
      auto traced = device.trace(segments, options.query, hits);
      report.trace_seconds += seconds_since(trace_start);
      if (!traced) return traced;
    }
    report.primary += count;
    report.outside += static_cast<std::uint64_t>(
        std::ranges::count_if(segments, [](const Segment& segment) { return segment.is_miss(); }));
    if (sink) {
      if (auto heard = sink(rays, segments, hits); !heard) return heard;
    }
    first += count;
    if (progress && total > 0) progress(first, total);
  } while (first < total);
  report.shade_seconds += seconds_since(start) - (report.trace_seconds - traced_before);
  return {};
}

RaySource primary_rays(const PinholeCamera& camera, int width, int samples, int threads) {
  return
      [&camera, width, samples, threads](std::uint64_t first, std::span<Ray> rays) -> Result<void> {
        parallel_for(threads, rays.size(), [&](std::size_t i) {
          const std::uint64_t ray = first + i;
          const std::uint64_t pixel = ray / static_cast<std::uint64_t>(samples);
          const int sample = static_cast<int>(ray % static_cast<std::uint64_t>(samples));
          rays[i] = camera.ray(static_cast<int>(pixel % static_cast<std::uint64_t>(width)),
                               static_cast<int>(pixel / static_cast<std::uint64_t>(width)),
                               sample_position(sample, samples));
        });
        return {};
      };
}

}  // namespace gridrt
