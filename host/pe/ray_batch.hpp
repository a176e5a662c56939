// The rays of one Trace frame: unpacked, traced on worker threads, packed as hits.
#pragma once

#include <span>
#include <vector>

#include "gridrt_protocol.hpp"
#include "host/pe/image_store.hpp"

namespace gridrt {

/// Bytes of a ray and of a hit in a layout (kCompact or kWide).
constexpr std::size_t ray_bytes(protocol::Layout layout) {
  return layout == protocol::Layout::kCompact ? protocol::RayCompact::kBytes
                                              : protocol::RayWide::kBytes;
}
constexpr std::size_t hit_bytes(protocol::Layout layout) {
  return layout == protocol::Layout::kCompact ? protocol::HitCompact::kBytes
                                              : protocol::HitWide::kBytes;
}

/// Traces `records` (whole ray records in the image's layout) on `threads` threads and writes a
/// hit record for each to `hits`. Refuses a ray with a coordinate outside the box (detail: its
/// index) before any is traced.
Accepted<void> trace_batch(const CommittedImage& image, std::span<const std::byte> records,
                           std::span<std::byte> hits, int threads, PeCounters& counters);

}  // namespace gridrt
