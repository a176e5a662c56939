#include "host/pe/image_store.hpp"

#include <algorithm>

#include "hal/crc32c.hpp"
#include "host/grid/lattice.hpp"
#include "host/grid/partition.hpp"

namespace gridrt {
namespace {

using protocol::ErrorCode;
using protocol::SectionKind;

constexpr std::size_t kCrcBytes = 4;

/// Appends or overwrites; false if the piece would leave a gap.
bool place(std::vector<std::byte>& store, std::size_t offset, std::span<const std::byte> bytes) {
  if (offset > store.size()) return false;
  if (offset + bytes.size() > store.size()) store.resize(offset + bytes.size());
  std::ranges::copy(bytes, store.begin() + static_cast<std::ptrdiff_t>(offset));
  return true;
}

bool is_device_section(std::uint8_t kind) {
  return kind >= static_cast<std::uint8_t>(SectionKind::kBlocks) &&
         kind <= static_cast<std::uint8_t>(SectionKind::kVertices);
}

/// Checks the fields that neither the grid nor the sections check later.
Accepted<void> check(const protocol::ImageHeader& header,
                     const protocol::CapabilitiesReport& limits) {
  if (header.magic != protocol::kImageMagic) return refuse(ErrorCode::kBadHeader, 0);
  if (header.version != protocol::kImageVersion) return refuse(ErrorCode::kBadHeader, 4);
  const auto layout = static_cast<protocol::Layout>(header.layout);
  const bool compact = layout == protocol::Layout::kCompact;
  if (!compact && layout != protocol::Layout::kWide) return refuse(ErrorCode::kBadHeader, 6);
  if (((limits.layouts >> header.layout) & 1U) == 0) return refuse(ErrorCode::kBadHeader, 6);
  if (header.pes < 1 || header.pes > limits.pes) return refuse(ErrorCode::kBadHeader, 7);
  const int most_bits = std::min<int>(limits.max_bits, compact ? kMaxCompactBits : kMaxBits);
  if (header.bits < kMinBits || header.bits > most_bits) return refuse(ErrorCode::kBadHeader, 8);
  for (std::size_t a = 0; a < 3; ++a) {
    if (header.max_q[a] >= (1 << header.bits) - 2) {
      return refuse(ErrorCode::kBadHeader, static_cast<std::uint32_t>(52 + 4 * a));
    }
  }
  if (compact && header.local_ids > protocol::kNoIdCompact) {
    return refuse(ErrorCode::kBadHeader, 100);
  }
  return {};
}

}  // namespace

void ImageStore::clear() { *this = ImageStore(limits_); }

Accepted<void> ImageStore::add(const protocol::LoadHead& head, std::span<const std::byte> bytes) {
  const std::uint32_t where = head.kind + 256U * head.pe;
  if (bytes.size() > head.total || head.offset > head.total - bytes.size()) {
    return refuse(ErrorCode::kBadSection, where);
  }
  if (head.kind == static_cast<std::uint8_t>(SectionKind::kHeader)) return add_header(head, bytes);
  if (!is_device_section(head.kind)) return refuse(ErrorCode::kBadSection, where);
  if (!header_complete_) {
    return refuse(ErrorCode::kMissingSection, section_detail(SectionKind::kHeader));
  }
  const Key key{head.kind, head.pe};
  const auto entry = directory_.find(key);
  if (entry == directory_.end() || entry->second.bytes != head.total) {
    return refuse(ErrorCode::kBadSection, where);
  }
  if (!place(sections_[key], head.offset, bytes)) {
    return refuse(ErrorCode::kMissingSection, where);
  }
  return {};
}

Accepted<void> ImageStore::add_header(const protocol::LoadHead& head,
                                      std::span<const std::byte> bytes) {
  // No directory is larger: 3 sections a PE and 5 shared ones.
  constexpr std::size_t kMost = protocol::ImageHeader::kBytes + kCrcBytes +
                                protocol::SectionEntry::kBytes * (3 * kMaxPes + 5);
  if (head.total > kMost) return refuse(ErrorCode::kTooLarge, section_detail(SectionKind::kHeader));
  const bool repeated =
      head.offset + bytes.size() <= header_bytes_.size() &&
      std::equal(bytes.begin(), bytes.end(),
                 header_bytes_.begin() + static_cast<std::ptrdiff_t>(head.offset));
  if (repeated) return {};
  if (head.offset == 0) clear();
  if (!place(header_bytes_, head.offset, bytes)) {
    return refuse(ErrorCode::kMissingSection, section_detail(SectionKind::kHeader));
  }
  if (header_bytes_.size() < head.total) return {};
  Accepted<void> parsed = parse_header();
  if (!parsed) clear();
  return parsed;
}

Accepted<void> ImageStore::parse_header() {
  constexpr std::size_t kHead = protocol::ImageHeader::kBytes;
  if (header_bytes_.size() < kHead + kCrcBytes) {
    return refuse(ErrorCode::kMissingSection, section_detail(SectionKind::kHeader));
  }
  const std::span bytes(header_bytes_);
  header_ = protocol::load_image_header(bytes.first<kHead>());
  const std::size_t end = kHead + std::size_t{header_.sections} * protocol::SectionEntry::kBytes;
  if (bytes.size() != end + kCrcBytes) return refuse(ErrorCode::kBadHeader, 14);
  if (crc32c(bytes.first(end)) != protocol::detail::get32(bytes.data() + end)) {
    return refuse(ErrorCode::kBadSectionCrc, section_detail(SectionKind::kHeader));
  }
  if (Accepted<void> good = check(header_, limits_); !good) return good;
  for (std::size_t i = 0; i < header_.sections; ++i) {
    const auto raw = bytes.subspan(kHead + i * protocol::SectionEntry::kBytes)
                         .first<protocol::SectionEntry::kBytes>();
    const protocol::SectionEntry entry = protocol::load_section_entry(raw);
    if (!is_device_section(entry.kind)) continue;
    if (Accepted<void> good = check_size(entry); !good) return good;
    if (!directory_.emplace(Key{entry.kind, entry.pe}, entry).second) {
      return refuse(ErrorCode::kBadHeader, static_cast<std::uint32_t>(kHead + i * 16));
    }
  }
  header_complete_ = true;
  return {};
}

Accepted<void> ImageStore::check_size(const protocol::SectionEntry& entry) const {
  const auto kind = static_cast<SectionKind>(entry.kind);
  const auto fits = [&](const auto& codec, std::uint32_t most) {
    // Widths that are not valid are refused at Commit.
    return !codec.valid() || entry.bytes <= std::uint64_t{most} * codec.stride();
  };
  const auto fits_memory = [&] {
    switch (kind) {
      case SectionKind::kBlocks:
        return fits(protocol::BlockCodec(header_), limits_.max_blocks);
      case SectionKind::kCells:
        return fits(protocol::CellCodec(header_), limits_.max_cells);
      case SectionKind::kReferences:
        return fits(protocol::ReferenceCodec(header_), limits_.max_references);
      case SectionKind::kTriangles:
        return fits(protocol::TriangleCodec(header_), limits_.max_triangles);
      case SectionKind::kVertices:
        return fits(protocol::VertexCodec(header_), limits_.max_vertices);
      default:
        return true;
    }
  };
  if (!fits_memory()) return refuse(ErrorCode::kTooLarge, section_detail(kind, entry.pe));
  return {};
}

Accepted<std::span<const std::byte>> ImageStore::section(SectionKind kind, std::uint8_t pe) const {
  const Key key{static_cast<std::uint8_t>(kind), pe};
  const auto entry = directory_.find(key);
  if (entry == directory_.end()) return refuse(ErrorCode::kBadHeader, section_detail(kind, pe));
  const auto stored = sections_.find(key);
  const std::span<const std::byte> bytes =
      stored == sections_.end() ? std::span<const std::byte>{} : std::span(stored->second);
  if (bytes.size() != entry->second.bytes) {
    return refuse(ErrorCode::kMissingSection, section_detail(kind, pe));
  }
  if (crc32c(bytes) != entry->second.crc) {
    return refuse(ErrorCode::kBadSectionCrc, section_detail(kind, pe));
  }
  return bytes;
}

Accepted<std::unique_ptr<CommittedImage>> ImageStore::commit(std::uint64_t pe_mask) const {
  if (!header_complete_) {
    return refuse(ErrorCode::kMissingSection, section_detail(SectionKind::kHeader));
  }
  const auto blocks = section(SectionKind::kBlocks, 0);
  if (!blocks) return std::unexpected(blocks.error());
  const auto cells = section(SectionKind::kCells, 0);
  if (!cells) return std::unexpected(cells.error());
  Accepted<TraversalMemory> traversal = TraversalMemory::decode(header_, *blocks, *cells);
  if (!traversal) return std::unexpected(traversal.error());

  std::vector<std::optional<Pe>> pes(header_.pes);
  for (std::uint8_t p = 0; p < header_.pes; ++p) {
    if (((pe_mask >> p) & 1U) == 0) continue;
    const auto references = section(SectionKind::kReferences, p);
    if (!references) return std::unexpected(references.error());
    const auto triangles = section(SectionKind::kTriangles, p);
    if (!triangles) return std::unexpected(triangles.error());
    const auto vertices = section(SectionKind::kVertices, p);
    if (!vertices) return std::unexpected(vertices.error());
    Accepted<Pe> pe = Pe::decode(header_, p, *references, *triangles, *vertices);
    if (!pe) return std::unexpected(pe.error());
    pes[p] = std::move(*pe);
  }
  Accepted<Engine> engine = Engine::assemble(std::move(*traversal), std::move(pes));
  if (!engine) return std::unexpected(engine.error());
  return std::make_unique<CommittedImage>(
      CommittedImage{header_, std::move(*engine), std::nullopt});
}

}  // namespace gridrt
