#include "host/pe/ray_batch.hpp"

#include <atomic>

#include "host/grid/parallel.hpp"

namespace gridrt {
namespace {

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
Accepted<std::vector<BatchRay>> unpack_layout(const protocol::ImageHeader& header,
                                              std::span<const std::byte> records, int threads) {
  std::vector<BatchRay> rays(records.size() / LayoutTag::kRayBytes);
  std::atomic<std::size_t> first_bad{rays.size()};
  parallel_pieces(threads, rays.size(), [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      const auto bytes =
          records.subspan(i * LayoutTag::kRayBytes).template first<LayoutTag::kRayBytes>();
      if (decode_ray<LayoutTag>(header, bytes, rays[i])) continue;
      std::size_t before = first_bad.load();
      while (i < before && !first_bad.compare_exchange_weak(before, i)) {
      }
      return;
    }
  });
  if (const std::size_t bad = first_bad.load(); bad < rays.size()) {
    return refuse(protocol::ErrorCode::kBadRay, static_cast<std::uint32_t>(bad));
  }
  return rays;
}

template <class LayoutTag>
void pack_layout(const BatchRay& ray, const PeAnswer& answer, std::size_t index,
                 std::span<std::byte> hits) {
  typename LayoutTag::HitRecord hit;
  hit.id = LayoutTag::kNone;
  hit.hit = answer.has_value();
  if (answer) hit.id = ray.any_hit ? 0 : answer->id;
  protocol::pack(hit,
                 hits.subspan(index * LayoutTag::kHitBytes).template first<LayoutTag::kHitBytes>());
}

bool is_compact(protocol::Layout layout) { return layout == protocol::Layout::kCompact; }

}  // namespace

Accepted<std::vector<BatchRay>> unpack_rays(const protocol::ImageHeader& header,
                                            std::span<const std::byte> records, int threads) {
  return is_compact(static_cast<protocol::Layout>(header.layout))
             ? unpack_layout<Compact>(header, records, threads)
             : unpack_layout<Wide>(header, records, threads);
}

void pack_answer(protocol::Layout layout, const BatchRay& ray, const PeAnswer& answer,
                 std::size_t index, std::span<std::byte> hits) {
  if (is_compact(layout)) {
    pack_layout<Compact>(ray, answer, index, hits);
  } else {
    pack_layout<Wide>(ray, answer, index, hits);
  }
}

}  // namespace gridrt
