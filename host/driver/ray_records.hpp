// Segments and answers as records of either layout.
#pragma once

#include <cstdint>
#include <limits>
#include <span>

#include "gridrt_protocol.hpp"
#include "hal/record_sizes.hpp"
#include "host/driver/device.hpp"

namespace gridrt {

/// A hit record in either layout.
struct DeviceHit {
  std::uint32_t id = 0;  ///< local
  bool hit = false;
};

/// Fills a ray record; `ignore` is a local id or kNoTriangle.
template <class Record>
Record make_record(const Segment& s, std::uint32_t ignore, Query query) {
  Record record;
  for (int a = 0; a < 3; ++a) {
    const auto i = static_cast<std::size_t>(a);
    record.p0[i] = static_cast<std::uint32_t>(s.p0[a]);
    record.p1[i] = static_cast<std::uint32_t>(s.p1[a]);
  }
  record.ignore = ignore;
  record.any_hit = query == Query::kAnyHit;
  return record;
}

/// kNoTriangle is all ones, so that it becomes the layout's own "none" when cut to its field.
inline void pack_ray(protocol::Layout layout, const Segment& s, std::uint32_t ignore, Query query,
                     std::span<std::byte> out) {
  if (layout == protocol::Layout::kCompact) {
    protocol::pack(make_record<protocol::RayCompact>(s, ignore, query),
                   out.first<protocol::RayCompact::kBytes>());
  } else {
    protocol::pack(make_record<protocol::RayWide>(s, ignore, query),
                   out.first<protocol::RayWide::kBytes>());
  }
}

inline DeviceHit unpack_hit(protocol::Layout layout, std::span<const std::byte> in) {
  if (layout == protocol::Layout::kCompact) {
    const auto r = protocol::unpack_hit_compact(in.first<protocol::HitCompact::kBytes>());
    return {r.id, r.hit};
  }
  const auto r = protocol::unpack_hit_wide(in.first<protocol::HitWide::kBytes>());
  return {r.id, r.hit};
}

/// What an any-hit query reports.
inline Hit any_hit_answer(bool hit) {
  constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();
  return {hit ? 0 : -1, kNothing, kNothing, kNothing};
}

}  // namespace gridrt
