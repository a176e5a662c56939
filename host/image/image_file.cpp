#include "host/image/image_file.hpp"

#include <algorithm>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "hal/crc32c.hpp"
#include "host/grid/partition.hpp"
#include "host/image/triangles.hpp"

namespace gridrt {
namespace {

using protocol::ImageHeader;
using protocol::SectionEntry;
using protocol::SectionKind;

constexpr std::size_t kCrcBytes = 4;

std::size_t padded(std::size_t bytes) { return (bytes + 3) / 4 * 4; }

std::size_t header_bytes(std::size_t sections) {
  return ImageHeader::kBytes + sections * SectionEntry::kBytes + kCrcBytes;
}

bool all_zero(std::span<const std::byte> bytes) {
  return std::ranges::all_of(bytes, [](std::byte b) { return b == std::byte{0}; });
}

/// Checks a file from front to back.
class Parser {
 public:
  Parser(std::span<const std::byte> bytes, const std::string& name) : bytes_(bytes), name_(name) {}

  Result<Image> parse() {
    if (auto good = parse_header(); !good) return std::unexpected(std::move(good.error()));
    std::size_t at = header_bytes(image_.header.sections);
    for (std::size_t i = 0; i < image_.header.sections; ++i) {
      auto end = parse_section(i, at);
      if (!end) return std::unexpected(std::move(end.error()));
      at = *end;
    }
    if (at != bytes_.size()) {
      return bad(
          fmt::format("{} bytes behind the last section, at offset {}", bytes_.size() - at, at));
    }
    if (auto good = check_complete(); !good) return std::unexpected(std::move(good.error()));
    return std::move(image_);
  }

 private:
  [[nodiscard]] std::unexpected<Error> bad(std::string_view message) const {
    return fail(ErrorKind::kInput, fmt::format("{}: {}", name_, message),
                "write the file again with gridrt-image");
  }

  Result<void> parse_header() {
    if (bytes_.size() < header_bytes(0)) {
      return bad(fmt::format("{} bytes are too few for an image header", bytes_.size()));
    }
    const ImageHeader header = protocol::load_image_header(bytes_.first<ImageHeader::kBytes>());
    if (header.magic != protocol::kImageMagic) {
      return fail(ErrorKind::kInput, fmt::format("{}: not a .grt file (wrong magic)", name_));
    }
    if (header.version != protocol::kImageVersion) {
      return bad(fmt::format("image version {}, but this program reads {}", header.version,
                             protocol::kImageVersion));
    }
    const std::size_t end = header_bytes(header.sections) - kCrcBytes;
    if (bytes_.size() < end + kCrcBytes) {
      return bad(fmt::format("the file ends at byte {}, within its directory", bytes_.size()));
    }
    const std::uint32_t crc = protocol::detail::get32(bytes_.data() + end);
    if (crc != crc32c(bytes_.first(end))) {
      return bad(fmt::format("header: the CRC at offset {} does not match", end));
    }
    const auto layout = static_cast<protocol::Layout>(header.layout);
    if (layout != protocol::Layout::kCompact && layout != protocol::Layout::kWide) {
      return bad(fmt::format("header: layout {} is not known", header.layout));
    }
    if (header.pes < 1 || header.pes > kMaxPes) {
      return bad(fmt::format("header: {} PEs", header.pes));
    }
    if (header.reserved0 != 0 || header.reserved1 != 0 || header.reserved2 != 0 ||
        header.reserved3 != 0) {
      return bad("header: a reserved field is not zero");
    }
    image_.header = header;
    return {};
  }

  /// Parses section `index`, which must start at `at`; returns the end of its padding.
  Result<std::size_t> parse_section(std::size_t index, std::size_t at) {
    const std::size_t offset = ImageHeader::kBytes + index * SectionEntry::kBytes;
    const SectionEntry entry =
        protocol::load_section_entry(bytes_.subspan(offset).first<SectionEntry::kBytes>());
    const auto kind = static_cast<SectionKind>(entry.kind);
    if (!protocol::is_known(kind) || kind == SectionKind::kHeader || entry.reserved != 0) {
      return bad(fmt::format("directory entry {} at offset {} is not valid", index, offset));
    }
    const std::string name = section_name(kind, entry.pe);
    if (!seen_.emplace(entry.kind, entry.pe).second) return bad(name + ": it is there twice");
    if (std::size_t{entry.offset} * 4 != at) {
      return bad(fmt::format("{}: it starts at offset {}, not at {}", name,
                             std::size_t{entry.offset} * 4, at));
    }
    const std::size_t end = at + padded(entry.bytes);
    if (end > bytes_.size()) {
      return bad(
          fmt::format("{}: it ends at offset {}, but the file at {}", name, end, bytes_.size()));
    }
    const std::span<const std::byte> content = bytes_.subspan(at, entry.bytes);
    if (crc32c(content) != entry.crc) {
      return bad(fmt::format("{} at offset {}: the CRC does not match", name, at));
    }
    if (!all_zero(bytes_.subspan(at + entry.bytes, end - at - entry.bytes))) {
      return bad(fmt::format("{}: the padding at offset {} is not zero", name, at + entry.bytes));
    }
    image_.sections.push_back({kind, entry.pe, {content.begin(), content.end()}});
    return end;
  }

  /// Every section that a device or the host needs is there, and none of a PE that is not.
  Result<void> check_complete() {
    const auto needed = [&](SectionKind kind, int pe) -> Result<void> {
      if (seen_.erase({static_cast<std::uint8_t>(kind), static_cast<std::uint8_t>(pe)}) == 1) {
        return {};
      }
      return bad(section_name(kind, pe) + ": it is missing");
    };
    Result<void> good;
    for (const SectionKind kind : {SectionKind::kBlocks, SectionKind::kCells, SectionKind::kIds}) {
      if (good) good = needed(kind, 0);
    }
    for (int pe = 0; pe < image_.header.pes; ++pe) {
      for (const SectionKind kind :
           {SectionKind::kReferences, SectionKind::kTriangles, SectionKind::kVertices}) {
        if (good) good = needed(kind, pe);
      }
    }
    seen_.erase({static_cast<std::uint8_t>(SectionKind::kScene), std::uint8_t{0}});
    if (good && !seen_.empty()) {
      const auto [kind, pe] = *seen_.begin();
      return bad(fmt::format("{} (owner {}): it does not belong there",
                             section_name(static_cast<SectionKind>(kind), pe), pe));
    }
    return good;
  }

  std::span<const std::byte> bytes_;
  const std::string& name_;
  Image image_;
  std::set<std::pair<std::uint8_t, std::uint8_t>> seen_;  // kind, owner
};

}  // namespace

std::vector<std::byte> header_section(const Image& image) {
  ImageHeader header = image.header;
  header.sections = static_cast<std::uint16_t>(image.sections.size());
  std::vector<std::byte> bytes(header_bytes(image.sections.size()));
  const std::span<std::byte> out(bytes);
  store(header, out.first<ImageHeader::kBytes>());
  std::size_t at = bytes.size();
  for (std::size_t i = 0; i < image.sections.size(); ++i) {
    const ImageSection& section = image.sections[i];
    SectionEntry entry;
    entry.kind = static_cast<std::uint8_t>(section.kind);
    entry.pe = section.pe;
    entry.offset = static_cast<std::uint32_t>(at / 4);
    entry.bytes = static_cast<std::uint32_t>(section.bytes.size());
    entry.crc = crc32c(section.bytes);
    store(
        entry,
        out.subspan(ImageHeader::kBytes + i * SectionEntry::kBytes).first<SectionEntry::kBytes>());
    at += padded(section.bytes.size());
  }
  const std::size_t end = bytes.size() - kCrcBytes;
  protocol::detail::put32(bytes.data() + end, crc32c(out.first(end)));
  return bytes;
}

std::vector<std::byte> serialize_image(const Image& image) {
  std::vector<std::byte> bytes = header_section(image);
  std::size_t size = bytes.size();
  for (const ImageSection& section : image.sections) size += padded(section.bytes.size());
  bytes.reserve(size);
  for (const ImageSection& section : image.sections) {
    bytes.insert(bytes.end(), section.bytes.begin(), section.bytes.end());
    bytes.resize(padded(bytes.size()));
  }
  return bytes;
}

Result<Image> parse_image(std::span<const std::byte> bytes, const std::string& name) {
  return Parser(bytes, name).parse();
}

}  // namespace gridrt
