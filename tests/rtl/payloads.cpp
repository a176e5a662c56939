#include "tests/rtl/payloads.hpp"

#include <algorithm>
#include <random>

namespace gridrt::rtl {

std::vector<std::byte> load_payload(const protocol::LoadHead& head,
                                    std::span<const std::byte> bytes) {
  std::vector<std::byte> payload(protocol::LoadHead::kBytes + bytes.size());
  protocol::store(head, std::span(payload).first<protocol::LoadHead::kBytes>());
  std::ranges::copy(bytes, payload.begin() + protocol::LoadHead::kBytes);
  return payload;
}

std::vector<std::vector<std::byte>> section_payloads(protocol::SectionKind kind, std::uint8_t pe,
                                                     std::span<const std::byte> section,
                                                     std::size_t piece) {
  std::vector<std::vector<std::byte>> payloads;
  for (std::size_t at = 0; at == 0 || at < section.size(); at += piece) {
    const std::size_t count = std::min(piece, section.size() - at);
    protocol::LoadHead head;
    head.kind = static_cast<std::uint8_t>(kind);
    head.pe = pe;
    head.offset = static_cast<std::uint32_t>(at);
    head.total = static_cast<std::uint32_t>(section.size());
    head.bytes = static_cast<std::uint32_t>(count);
    payloads.push_back(load_payload(head, section.subspan(at, count)));
  }
  return payloads;
}

std::vector<std::byte> commit_payload(std::uint64_t mask) {
  std::vector<std::byte> payload(protocol::CommitHead::kBytes);
  protocol::store(protocol::CommitHead{mask},
                  std::span(payload).first<protocol::CommitHead::kBytes>());
  return payload;
}

std::vector<std::byte> trace_payload(std::span<const protocol::RayCompact> rays,
                                     std::uint32_t tag) {
  constexpr std::size_t kRay = protocol::RayCompact::kBytes;
  std::vector<std::byte> payload(protocol::TraceHead::kBytes + kRay * rays.size());
  protocol::store(protocol::TraceHead{static_cast<std::uint32_t>(rays.size()), tag},
                  std::span(payload).first<protocol::TraceHead::kBytes>());
  for (std::size_t i = 0; i < rays.size(); ++i) {
    protocol::pack(rays[i], std::span(payload)
                                .subspan(protocol::TraceHead::kBytes + i * kRay)
                                .first<protocol::RayCompact::kBytes>());
  }
  return payload;
}

std::vector<protocol::RayCompact> rays_in(const Image& image, std::size_t count, unsigned seed) {
  std::mt19937 source(seed);
  const auto random = [&] { return static_cast<std::uint32_t>(source()); };
  std::vector<protocol::RayCompact> rays(count);
  for (protocol::RayCompact& ray : rays) {
    for (std::size_t a = 0; a < 3; ++a) {
      const auto box = static_cast<std::uint32_t>(image.header.max_q[a]) + 2U;
      ray.p0[a] = random() % 8 == 0 ? box : random() % (box + 1);
      ray.p1[a] = random() % 8 == 0 ? 0 : random() % (box + 1);
    }
    ray.ignore = random() % 2 == 0 ? protocol::kNoIdCompact : random() & 0xFFFFU;
    ray.any_hit = random() % 2 == 0;
  }
  return rays;
}

}  // namespace gridrt::rtl
