// The schedule `rays`: worker threads take rays and run every PE that a ray needs themselves.
#pragma once

#include <optional>
#include <span>
#include <string_view>

#include "host/pe/ray_batch.hpp"

namespace gridrt {

/// The layout for vectors of the kind `simd` (empty: the widest there is). Nothing for an image
/// whose grid is too fine for it (RayLayout::fits) or a kind that this machine does not have.
std::optional<StreamImage> make_stream(const CommittedImage& image, std::string_view simd,
                                       int threads);

/// Answers all rays on `threads` threads (1: the caller's); a hit record each to `hits`. With the
/// image's stream, if it has one.
void trace_rays(const CommittedImage& image, std::span<const BatchRay> rays,
                std::span<std::byte> hits, int threads, PeCounters& counters);

}  // namespace gridrt
