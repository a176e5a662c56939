// Payloads of frames to a board, and rays to put into them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "gridrt_protocol.hpp"
#include "host/image/image.hpp"

namespace gridrt::rtl {

std::vector<std::byte> load_payload(const protocol::LoadHead& head,
                                    std::span<const std::byte> bytes);
/// Those of the LoadSection frames that load a section in pieces of at most so many bytes, at least
/// one.
std::vector<std::vector<std::byte>> section_payloads(protocol::SectionKind kind, std::uint8_t pe,
                                                     std::span<const std::byte> section,
                                                     std::size_t piece);
std::vector<std::byte> commit_payload(std::uint64_t mask);
std::vector<std::byte> trace_payload(std::span<const protocol::RayCompact> rays, std::uint32_t tag);

/// Rays within the box of an image.
std::vector<protocol::RayCompact> rays_in(const Image& image, std::size_t count, unsigned seed);

}  // namespace gridrt::rtl
