#include "host/pe/schedule_rays.hpp"

#include <algorithm>
#include <array>

#include <omp.h>

namespace gridrt {
namespace {

PeAnswer answer_plain(const Engine& engine, const BatchRay& r, PeCounters& counters) {
  if (r.ray.p0 == r.ray.p1) {
    ++counters.rays;
    return std::nullopt;
  }
  if (!r.any_hit) return engine.closest_hit(r.ray, counters);
  if (engine.any_hit(r.ray, counters)) return HitKey{0, 0};
  return std::nullopt;
}

void answer(const CommittedImage& image, std::span<const BatchRay> rays,
            std::span<PeAnswer> answers, PeCounters& counters) {
  if (image.stream) {
    image.stream->kernel.trace(image.stream->layout, rays, answers, counters);
    return;
  }
  for (std::size_t i = 0; i < rays.size(); ++i) {
    answers[i] = answer_plain(image.engine, rays[i], counters);
  }
}

}  // namespace

std::optional<StreamImage> make_stream(const CommittedImage& image, std::string_view simd,
                                       int threads) {
  const std::optional<StreamKernel> kernel = stream_kernel(simd);
  if (!kernel || !RayLayout::fits(image.engine)) return std::nullopt;
  return StreamImage{*kernel,
                     RayLayout::build(image.engine, image.header.bits, kernel->lanes, threads)};
}

void trace_rays(const CommittedImage& image, std::span<const BatchRay> rays,
                std::span<std::byte> hits, int threads, PeCounters& counters) {
  const auto layout = static_cast<protocol::Layout>(image.header.layout);
  constexpr std::size_t kPiece = 1024;  // rays that a thread takes at a time
  const auto pieces = static_cast<std::ptrdiff_t>((rays.size() + kPiece - 1) / kPiece);
#pragma omp parallel num_threads(threads) if (threads > 1)
  {
    PeCounters mine;
#pragma omp for schedule(dynamic)
    for (std::ptrdiff_t piece = 0; piece < pieces; ++piece) {
      const std::size_t first = static_cast<std::size_t>(piece) * kPiece;
      const std::span<const BatchRay> some =
          rays.subspan(first, std::min(kPiece, rays.size() - first));
      std::array<PeAnswer, kPiece> answers;
      answer(image, some, std::span(answers).first(some.size()), mine);
      for (std::size_t i = 0; i < some.size(); ++i) {
        pack_answer(layout, some[i], answers[i], first + i, hits);
      }
    }
#pragma omp critical
    counters += mine;
  }
}

}  // namespace gridrt
