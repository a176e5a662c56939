#include "host/image/image_frames.hpp"

#include <algorithm>
#include <array>

#include "hal/frame.hpp"
#include "host/image/image_file.hpp"

namespace gridrt {

using protocol::FrameType;
using protocol::SectionKind;

bool is_for_device(SectionKind kind) {
  return kind != SectionKind::kIds && kind != SectionKind::kScene;
}

Result<void> append_piece(std::vector<std::byte>& out, const SectionBytes& section,
                          std::size_t offset, std::size_t count, std::uint32_t sequence) {
  protocol::LoadHead head;
  head.kind = static_cast<std::uint8_t>(section.kind);
  head.pe = section.pe;
  head.offset = static_cast<std::uint32_t>(offset);
  head.total = static_cast<std::uint32_t>(section.bytes.size());
  head.bytes = static_cast<std::uint32_t>(count);
  std::array<std::byte, protocol::LoadHead::kBytes> head_bytes{};
  protocol::store(head, head_bytes);
  FrameBuilder builder(out, FrameType::kLoadSection, protocol::Layout::kNone, sequence);
  builder.append(head_bytes);
  builder.append(section.bytes.subspan(offset, count));
  return builder.finish();
}

std::size_t piece_bytes(std::uint32_t max_payload) {
  constexpr std::size_t kMost = std::size_t{1} << 18;
  return std::min(kMost, (max_payload - protocol::LoadHead::kBytes) / 4 * 4);
}

std::vector<std::byte> commit_payload(const Image& image) {
  protocol::CommitHead head;
  head.pe_mask =
      image.header.pes >= 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << image.header.pes) - 1;
  std::vector<std::byte> payload(protocol::CommitHead::kBytes);
  protocol::store(head, std::span(payload).first<protocol::CommitHead::kBytes>());
  return payload;
}

Result<std::vector<std::byte>> image_frames(const Image& image, std::uint32_t max_payload,
                                            std::uint32_t& sequence) {
  std::vector<std::byte> out;
  const std::size_t piece = piece_bytes(max_payload);
  const auto append = [&](const SectionBytes& section) -> Result<void> {
    std::size_t offset = 0;
    do {
      const std::size_t count = std::min(piece, section.bytes.size() - offset);
      if (auto done = append_piece(out, section, offset, count, sequence++); !done) return done;
      offset += count;
    } while (offset < section.bytes.size());
    return {};
  };
  const std::vector<std::byte> header = header_section(image);
  if (auto done = append({SectionKind::kHeader, 0, header}); !done) {
    return std::unexpected(std::move(done.error()));
  }
  for (const ImageSection& section : image.sections) {
    if (!is_for_device(section.kind)) continue;
    if (auto done = append({section.kind, section.pe, section.bytes}); !done) {
      return std::unexpected(std::move(done.error()));
    }
  }
  auto done = append_frame(out, FrameType::kCommit, protocol::Layout::kNone, sequence++,
                           commit_payload(image));
  if (!done) return std::unexpected(std::move(done.error()));
  return out;
}

}  // namespace gridrt
