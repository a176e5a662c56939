// The schedule `pes` on threads: each thread is a PE, and messages go through mailboxes.
#pragma once

#include <span>

#include "host/pe/ray_batch.hpp"
#include "host/pe/schedule.hpp"

namespace gridrt {

/// Answers all rays; a hit record each to `hits`. Threads beyond the image's PEs are not started.
void trace_pes(const CommittedImage& image, std::span<const BatchRay> rays,
               std::span<std::byte> hits, const ScheduleOptions& options, PeCounters& counters);

}  // namespace gridrt
