#include "host/pe/schedule_rays.hpp"

#include <algorithm>

#include <omp.h>

namespace gridrt {
namespace {

PeAnswer answer(const Engine& engine, const BatchRay& r, PeCounters& counters) {
  if (r.ray.p0 == r.ray.p1) {
    ++counters.rays;
    return std::nullopt;
  }
  if (!r.any_hit) return engine.closest_hit(r.ray, counters);
  if (engine.any_hit(r.ray, counters)) return HitKey{0, 0};
  return std::nullopt;
}

}  // namespace

void trace_rays(const CommittedImage& image, std::span<const BatchRay> rays,
                std::span<std::byte> hits, int threads, PeCounters& counters) {
  const auto layout = static_cast<protocol::Layout>(image.header.layout);
  constexpr std::size_t kPiece = 64;  // rays that a thread takes at a time
  const auto pieces = static_cast<std::ptrdiff_t>((rays.size() + kPiece - 1) / kPiece);
#pragma omp parallel num_threads(threads) if (threads > 1)
  {
    PeCounters mine;
#pragma omp for schedule(dynamic)
    for (std::ptrdiff_t piece = 0; piece < pieces; ++piece) {
      const std::size_t first = static_cast<std::size_t>(piece) * kPiece;
      for (std::size_t i = first; i < std::min(rays.size(), first + kPiece); ++i) {
        pack_answer(layout, rays[i], answer(image.engine, rays[i], mine), i, hits);
      }
    }
#pragma omp critical
    counters += mine;
  }
}

}  // namespace gridrt
