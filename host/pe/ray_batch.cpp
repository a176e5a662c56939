#include "host/pe/ray_batch.hpp"

#include <algorithm>

#include <omp.h>

namespace gridrt {
namespace {

/// A ray as it came, in either layout.
struct BatchRay {
  PeRay ray;
  bool any_hit = false;
};

struct Compact {
  static constexpr std::size_t kRayBytes = protocol::RayCompact::kBytes;
  static constexpr std::size_t kHitBytes = protocol::HitCompact::kBytes;
  static constexpr std::uint32_t kNone = protocol::kNoIdCompact;
  using HitRecord = protocol::HitCompact;
  static auto unpack(std::span<const std::byte, kRayBytes> in) {
    return protocol::unpack_ray_compact(in);
  }
};

struct Wide {
  static constexpr std::size_t kRayBytes = protocol::RayWide::kBytes;
  static constexpr std::size_t kHitBytes = protocol::HitWide::kBytes;
  static constexpr std::uint32_t kNone = protocol::kNoIdWide;
  using HitRecord = protocol::HitWide;
  static auto unpack(std::span<const std::byte, kRayBytes> in) {
    return protocol::unpack_ray_wide(in);
  }
};

/// False if a coordinate lies outside the box.
template <class LayoutTag>
bool decode_ray(const protocol::ImageHeader& header,
                std::span<const std::byte, LayoutTag::kRayBytes> bytes, BatchRay& out) {
  const auto record = LayoutTag::unpack(bytes);
  for (int a = 0; a < 3; ++a) {
    const auto i = static_cast<std::size_t>(a);
    const auto most = static_cast<std::uint32_t>(header.max_q[i] + 2);
    if (record.p0[i] > most || record.p1[i] > most) return false;
    out.ray.p0[a] = static_cast<std::int32_t>(record.p0[i]);
    out.ray.p1[a] = static_cast<std::int32_t>(record.p1[i]);
  }
  out.ray.ignore = record.ignore == LayoutTag::kNone ? kNoTriangle : record.ignore;
  out.any_hit = record.any_hit;
  return true;
}

template <class LayoutTag>
typename LayoutTag::HitRecord answer(const Engine& engine, const BatchRay& r,
                                     PeCounters& counters) {
  typename LayoutTag::HitRecord hit;
  hit.id = LayoutTag::kNone;
  if (r.ray.p0 == r.ray.p1) {
    ++counters.rays;
  } else if (r.any_hit) {
    hit.hit = engine.any_hit(r.ray, counters);
    if (hit.hit) hit.id = 0;
  } else if (const PeAnswer best = engine.closest_hit(r.ray, counters)) {
    hit.hit = true;
    hit.id = best->id;
  }
  return hit;
}

template <class LayoutTag>
Accepted<void> trace_layout(const CommittedImage& image, std::span<const std::byte> records,
                            std::span<std::byte> hits, int threads, PeCounters& counters) {
  const std::size_t count = records.size() / LayoutTag::kRayBytes;
  std::vector<BatchRay> rays(count);
  for (std::size_t i = 0; i < count; ++i) {
    const auto bytes =
        records.subspan(i * LayoutTag::kRayBytes).template first<LayoutTag::kRayBytes>();
    if (!decode_ray<LayoutTag>(image.header, bytes, rays[i])) {
      return refuse(protocol::ErrorCode::kBadRay, static_cast<std::uint32_t>(i));
    }
  }
  constexpr std::size_t kPiece = 64;  // rays that a thread takes at a time
  const auto pieces = static_cast<std::ptrdiff_t>((count + kPiece - 1) / kPiece);
#pragma omp parallel num_threads(threads) if (threads > 1)
  {
    PeCounters mine;
#pragma omp for schedule(dynamic)
    for (std::ptrdiff_t piece = 0; piece < pieces; ++piece) {
      const std::size_t first = static_cast<std::size_t>(piece) * kPiece;
      for (std::size_t i = first; i < std::min(count, first + kPiece); ++i) {
        protocol::pack(
            answer<LayoutTag>(image.engine, rays[i], mine),
            hits.subspan(i * LayoutTag::kHitBytes).template first<LayoutTag::kHitBytes>());
      }
    }
#pragma omp critical
    counters += mine;
  }
  return {};
}

}  // namespace

Accepted<void> trace_batch(const CommittedImage& image, std::span<const std::byte> records,
                           std::span<std::byte> hits, int threads, PeCounters& counters) {
  if (static_cast<protocol::Layout>(image.header.layout) == protocol::Layout::kCompact) {
    return trace_layout<Compact>(image, records, hits, threads, counters);
  }
  return trace_layout<Wide>(image, records, hits, threads, counters);
}

}  // namespace gridrt
