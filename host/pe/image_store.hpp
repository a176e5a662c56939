// Collects the pieces of an image as LoadSection frames bring them, and makes an engine of them at
// Commit.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "gridrt_protocol.hpp"
#include "host/pe/capabilities.hpp"
#include "host/pe/engine.hpp"
#include "host/pe/ray_stream.hpp"
#include "host/pe/refusal.hpp"

namespace gridrt {

/// An image that answers rays.
struct CommittedImage {
  protocol::ImageHeader header{};
  Engine engine;
  std::optional<StreamImage> stream;  ///< of the schedule rays, unless plain
};

/// True for pieces that may begin a new image.
inline bool begins_image(const protocol::LoadHead& head) {
  return head.kind == static_cast<std::uint8_t>(protocol::SectionKind::kHeader);
}

/// Memory grows with the bytes that have arrived, never with what a header promises.
class ImageStore {
 public:
  /// Refuses images beyond `limits`.
  explicit ImageStore(const protocol::CapabilitiesReport& limits = software_capabilities())
      : limits_(limits) {}

  /// Takes one piece. A header piece at offset 0 that differs from the header in store starts a
  /// new image. Pieces of a section may be repeated; one that leaves a gap is dropped (Commit will
  /// name the section as missing).
  Accepted<void> add(const protocol::LoadHead& head, std::span<const std::byte> bytes);

  /// Checks sizes and CRCs of the sections of the PEs in `pe_mask` and decodes them.
  [[nodiscard]] Accepted<std::unique_ptr<CommittedImage>> commit(std::uint64_t pe_mask) const;

  void clear();

 private:
  using Key = std::pair<std::uint8_t, std::uint8_t>;  ///< section kind, PE

  Accepted<void> add_header(const protocol::LoadHead& head, std::span<const std::byte> bytes);
  Accepted<void> parse_header();
  [[nodiscard]] Accepted<std::span<const std::byte>> section(protocol::SectionKind kind,
                                                             std::uint8_t pe) const;

  [[nodiscard]] Accepted<void> check_size(const protocol::SectionEntry& entry) const;

  protocol::CapabilitiesReport limits_;
  std::vector<std::byte> header_bytes_;
  bool header_complete_ = false;
  protocol::ImageHeader header_{};
  std::map<Key, protocol::SectionEntry> directory_;
  std::map<Key, std::vector<std::byte>> sections_;
};

}  // namespace gridrt
