// Bytes of the records in the two layouts.
#pragma once

#include <cstddef>

#include "gridrt_protocol.hpp"

namespace gridrt {

/// Bytes of a ray record; kCompact, else kWide.
constexpr std::size_t ray_record_bytes(protocol::Layout layout) {
  return layout == protocol::Layout::kCompact ? protocol::RayCompact::kBytes
                                              : protocol::RayWide::kBytes;
}

/// Bytes of a hit record; kCompact, else kWide.
constexpr std::size_t hit_record_bytes(protocol::Layout layout) {
  return layout == protocol::Layout::kCompact ? protocol::HitCompact::kBytes
                                              : protocol::HitWide::kBytes;
}

}  // namespace gridrt
