// The schedule `rays`: worker threads take rays and run every PE that a ray needs themselves.
#pragma once

#include <span>

#include "host/pe/ray_batch.hpp"

namespace gridrt {

/// Answers all rays on `threads` threads (1: the caller's); a hit record each to `hits`.
void trace_rays(const CommittedImage& image, std::span<const BatchRay> rays,
                std::span<std::byte> hits, int threads, PeCounters& counters);

}  // namespace gridrt
