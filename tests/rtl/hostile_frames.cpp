#include "tests/rtl/hostile_frames.hpp"

#include <algorithm>

#include <gtest/gtest.h>

#include "hal/crc32c.hpp"
#include "hal/frame.hpp"
#include "host/image/image_file.hpp"
#include "tests/rtl/payloads.hpp"

namespace gridrt::rtl {

using protocol::FrameType;
using protocol::SectionKind;

namespace {

constexpr std::size_t kTypeAt = 4;     ///< the header's word with version and type
constexpr std::size_t kLengthAt = 12;  ///< its word with the length

void set_header_word(std::vector<std::byte>& frame, std::size_t at, std::uint32_t word) {
  protocol::detail::put32(frame.data() + at, word);
  protocol::detail::put32(frame.data() + 16, crc32c(std::span(frame).first(16)));
}

bool changes_images(FrameType type) {
  return type == FrameType::kLoadSection || type == FrameType::kCommit;
}

}  // namespace

std::uint32_t HostileFrames::value() {
  constexpr std::array<std::uint32_t, 16> kEdges{
      0,       1,       3,       4,        7,         16,        0x7F,        0xFF,
      0x3FFFU, 0xA000U, 0xFFFFU, 0x10000U, 1U << 20U, 1U << 24U, 0x80000000U, ~0U};
  return below(3) == 0 ? static_cast<std::uint32_t>(random_()) : kEdges.at(below(16));
}

std::vector<std::byte> HostileFrames::bytes(std::size_t count) {
  std::vector<std::byte> out(count);
  for (std::byte& b : out) b = static_cast<std::byte>(random_());
  return out;
}

std::vector<std::byte> HostileFrames::frame(FrameType type, std::span<const std::byte> payload) {
  std::vector<std::byte> frame;
  const auto layout = static_cast<protocol::Layout>(below(8) == 0 ? below(4) : 1);
  EXPECT_TRUE(append_frame(frame, type, type == FrameType::kTrace ? layout : protocol::Layout{},
                           value(), payload));
  switch (below(12)) {
    case 0: {
      const std::size_t at = below(16) / 4 * 4;
      const std::uint32_t flip = 1U << below(32);
      if (!loads_ && at == kTypeAt) break;
      set_header_word(frame, at, protocol::detail::get32(frame.data() + at) ^ flip);
      break;
    }
    case 1:
      frame.resize(below(static_cast<std::uint32_t>(frame.size())));
      break;
    case 2:
      frame[below(static_cast<std::uint32_t>(frame.size()))] ^=
          static_cast<std::byte>(1U << below(8));
      break;
    default:
      break;
  }
  return frame;
}

FrameType HostileFrames::type(std::uint32_t first, std::uint32_t count) {
  auto type = static_cast<FrameType>(first + below(count));
  if (!loads_ && changes_images(type)) type = FrameType::kTrace;
  return type;
}

std::vector<std::byte> HostileFrames::any() { return frame(type(0, 12), bytes(4 * below(64))); }

std::vector<std::byte> HostileFrames::promise() {
  std::vector<std::byte> out;
  EXPECT_TRUE(
      append_frame(out, type(1, 5), protocol::Layout::kCompact, value(), bytes(4 * below(32))));
  set_header_word(out, kLengthAt, value());
  return out;
}

std::vector<std::byte> HostileFrames::commit() {
  return frame(FrameType::kCommit, bytes(below(4) == 0 ? 4 * below(8) : 8));
}

std::vector<std::byte> HostileFrames::load() {
  const std::uint32_t count = below(200);
  protocol::LoadHead head;
  head.kind = static_cast<std::uint8_t>(below(6) == 0 ? value() : below(8));
  head.pe = static_cast<std::uint8_t>(below(6) == 0 ? value() : below(6));
  head.offset = below(2) == 0 ? 0 : value();
  head.total = below(2) == 0 ? count : value();
  head.bytes = below(4) == 0 ? value() : count;
  return frame(FrameType::kLoadSection, load_payload(head, bytes((count + 3) / 4 * 4)));
}

/// About as many bytes as the section has, about as many as fit the memory, up to twice that.
std::uint32_t HostileFrames::size_of(const ImageSection& section) {
  constexpr std::array<std::uint32_t, 6> kStrides{0, 5, 4, 3, 7, 7};
  const auto kind = static_cast<std::size_t>(section.kind);
  if (kind >= kStrides.size()) return 0;
  const std::uint32_t most = kHolds.at(kind) * kStrides.at(kind);
  switch (below(4)) {
    case 0:
      return static_cast<std::uint32_t>(section.bytes.size()) + below(9);
    case 1:
      return most - 8 + below(24);
    case 2:
      return most + below(most);
    default:
      return below(most);
  }
}

std::vector<std::byte> HostileFrames::sections() {
  Image image = image_;
  if (below(2) == 0) {
    auto& section = image.sections.at(below(static_cast<std::uint32_t>(image.sections.size())));
    if (below(3) != 0) section.bytes.resize(size_of(section));
    for (std::uint32_t i = below(4); i > 0 && !section.bytes.empty(); --i) {
      section.bytes[below(static_cast<std::uint32_t>(section.bytes.size()))] =
          static_cast<std::byte>(random_());
    }
  }
  std::vector<std::byte> header = header_section(image);
  if (below(2) == 0) {
    protocol::detail::put32(
        header.data() + below(static_cast<std::uint32_t>(header.size() / 4)) * 4, value());
  }
  std::vector<std::byte> out;
  const auto add = [&](SectionKind kind, std::uint8_t pe, std::span<const std::byte> section) {
    for (const auto& payload : section_payloads(kind, pe, section, 2048)) {
      EXPECT_TRUE(append_frame(out, FrameType::kLoadSection, protocol::Layout::kNone, 7, payload));
    }
  };
  add(SectionKind::kHeader, 0, header);
  for (const ImageSection& section : image.sections) {
    if (section.kind == SectionKind::kIds || section.kind == SectionKind::kScene) continue;
    if (below(8) != 0) add(section.kind, section.pe, section.bytes);
  }
  return out;
}

std::vector<std::byte> HostileFrames::trace() {
  auto payload =
      trace_payload(rays_in(image_, below(20), static_cast<unsigned>(random_())), value());
  if (below(3) == 0) protocol::detail::put32(payload.data(), value());
  if (below(3) == 0) payload.resize(4 * below(80));
  for (std::uint32_t i = below(3); i > 0 && !payload.empty(); --i) {
    payload[below(static_cast<std::uint32_t>(payload.size()))] = static_cast<std::byte>(random_());
  }
  return frame(FrameType::kTrace, payload);
}

}  // namespace gridrt::rtl
