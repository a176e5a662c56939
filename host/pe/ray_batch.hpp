// The rays of one Trace frame: unpacked, traced on worker threads, packed as hits.
#pragma once

#include <span>
#include <vector>

#include "gridrt_protocol.hpp"
#include "host/pe/image_store.hpp"

namespace gridrt {

/// Traces `records` (whole ray records in the image's layout) on `threads` threads and writes a
/// hit record for each to `hits`. Refuses a ray with a coordinate outside the box (detail: its
/// index) before any is traced.
Accepted<void> trace_batch(const CommittedImage& image, std::span<const std::byte> records,
                           std::span<std::byte> hits, int threads, PeCounters& counters);

}  // namespace gridrt
