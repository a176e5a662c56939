// The frames that load an image, as bytes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "hal/error.hpp"
#include "host/image/image.hpp"

namespace gridrt {

/// A section as a device receives it.
struct SectionBytes {
  protocol::SectionKind kind{};
  std::uint8_t pe = 0;
  std::span<const std::byte> bytes;
};

/// Whether a device wants sections of this kind; others are the host's own.
bool is_for_device(protocol::SectionKind kind);

/// Appends the LoadSection frame of `count` bytes of a section from `offset` on, a multiple of 4.
Result<void> append_piece(std::vector<std::byte>& out, const SectionBytes& section,
                          std::size_t offset, std::size_t count, std::uint32_t sequence);

/// Bytes of a section in one frame to a device that takes payloads of `max_payload` bytes.
std::size_t piece_bytes(std::uint32_t max_payload);

/// The payload of an image's Commit.
std::vector<std::byte> commit_payload(const Image& image);

/// All frames that load an image, Commit last, numbered from `sequence` on; `sequence` becomes the
/// number behind Commit's. Errors: kLimit as append_frame().
Result<std::vector<std::byte>> image_frames(const Image& image, std::uint32_t max_payload,
                                            std::uint32_t& sequence);

}  // namespace gridrt
