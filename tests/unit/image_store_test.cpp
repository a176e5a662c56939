// A device commits no section whose bytes are not those of the image's directory, even if every
// frame on the way was good.
#include "host/pe/image_store.hpp"

#include <gtest/gtest.h>

#include "host/image/image_file.hpp"
#include "tests/adversarial/meshes.hpp"

namespace gridrt {
namespace {

using protocol::ErrorCode;
using protocol::SectionKind;

Image small_image(protocol::Layout layout) {
  adversarial::Random random(1);
  ImageOptions options;
  options.pes = 2;
  options.layout = layout;
  options.with_scene = false;
  return build_image(adversarial::soup(40, 3.0, random), options).value();
}

Accepted<void> add(ImageStore& store, SectionKind kind, std::uint8_t pe,
                   std::span<const std::byte> bytes) {
  protocol::LoadHead head;
  head.kind = static_cast<std::uint8_t>(kind);
  head.pe = pe;
  head.total = static_cast<std::uint32_t>(bytes.size());
  head.bytes = head.total;
  return store.add(head, bytes);
}

bool is_for_device(SectionKind kind) {
  return kind != SectionKind::kIds && kind != SectionKind::kScene;
}

TEST(ImageStore, CommitsAnUndamagedImage) {
  for (const auto layout : {protocol::Layout::kCompact, protocol::Layout::kWide}) {
    const Image image = small_image(layout);
    ImageStore store;
    ASSERT_TRUE(add(store, SectionKind::kHeader, 0, header_section(image)));
    for (const ImageSection& s : image.sections) {
      ASSERT_TRUE(!is_for_device(s.kind) || add(store, s.kind, s.pe, s.bytes));
    }
    EXPECT_TRUE(store.commit(3));
  }
}

TEST(ImageStore, OneFlippedBitInAnySectionIsFoundAtCommitAndMendedBySendingItAgain) {
  adversarial::Random random(2);
  std::size_t flips = 0;
  for (const auto layout : {protocol::Layout::kCompact, protocol::Layout::kWide}) {
    const Image image = small_image(layout);
    for (const ImageSection& damaged : image.sections) {
      if (!is_for_device(damaged.kind)) continue;
      ImageStore store;
      ASSERT_TRUE(add(store, SectionKind::kHeader, 0, header_section(image)));
      for (const ImageSection& s : image.sections) {
        ASSERT_TRUE(!is_for_device(s.kind) || add(store, s.kind, s.pe, s.bytes));
      }
      for (int i = 0; i < 50; ++i, ++flips) {
        std::vector<std::byte> bytes = damaged.bytes;
        bytes[random.below(bytes.size())] ^= std::byte{1} << static_cast<int>(random.below(8));
        ASSERT_TRUE(add(store, damaged.kind, damaged.pe, bytes));
        const auto refused = store.commit(3);
        ASSERT_FALSE(refused);
        EXPECT_EQ(refused.error().code, ErrorCode::kBadSectionCrc);
        EXPECT_EQ(refused.error().detail, section_detail(damaged.kind, damaged.pe));
      }
      ASSERT_TRUE(add(store, damaged.kind, damaged.pe, damaged.bytes));
      EXPECT_TRUE(store.commit(3));
    }
  }
  EXPECT_GT(flips, 500U);
}

TEST(ImageStore, AFlippedBitInTheHeaderIsFoundAtOnce) {
  const Image image = small_image(protocol::Layout::kWide);
  const std::vector<std::byte> header = header_section(image);
  for (std::size_t bit = 0; bit < 8 * header.size(); ++bit) {
    std::vector<std::byte> bytes = header;
    bytes[bit / 8] ^= std::byte{1} << static_cast<int>(bit % 8);
    ImageStore store;
    EXPECT_FALSE(add(store, SectionKind::kHeader, 0, bytes)) << "bit " << bit;
  }
}

TEST(ImageStore, RefusesWhatGoesBeyondItsLimitsByOneEntry) {
  using Report = protocol::CapabilitiesReport;
  const Image image = small_image(protocol::Layout::kCompact);
  const std::vector<ImageCounts> counts = count_image(image);
  Report exact = board_capabilities();
  exact.pes = 2;
  exact.max_cells = image.header.occupied_cells;
  const glm::ivec3 blocks = (image.grid().count + 1) / 2;
  exact.max_blocks = static_cast<std::uint32_t>(blocks.x * blocks.y * blocks.z);
  exact.max_triangles = exact.max_vertices = exact.max_references = 0;
  for (std::size_t pe = 0; pe < 2; ++pe) {
    const auto grow = [](std::uint32_t& most, std::uint64_t n) {
      most = std::max(most, static_cast<std::uint32_t>(n));
    };
    grow(exact.max_triangles, counts[pe].triangles);
    grow(exact.max_vertices, counts[pe].vertices);
    grow(exact.max_references, counts[pe].references);
  }
  const std::vector<std::byte> header = header_section(image);
  const auto accepts = [&](const Report& limits) {
    ImageStore store(limits);
    const auto added = add(store, SectionKind::kHeader, 0, header);
    return added ? ErrorCode::kNone : added.error().code;
  };
  EXPECT_EQ(accepts(exact), ErrorCode::kNone);
  for (std::uint32_t Report::* const size :
       {&Report::max_triangles, &Report::max_vertices, &Report::max_references, &Report::max_cells,
        &Report::max_blocks}) {
    Report less = exact;
    --(less.*size);
    EXPECT_EQ(accepts(less), ErrorCode::kTooLarge);
  }
  Report other = exact;
  other.pes = 1;
  EXPECT_EQ(accepts(other), ErrorCode::kBadHeader);
  other = exact;
  other.max_bits = 16;
  EXPECT_EQ(accepts(other), ErrorCode::kBadHeader);
  other = exact;
  other.layouts = 1U << static_cast<unsigned>(protocol::Layout::kWide);
  EXPECT_EQ(accepts(other), ErrorCode::kBadHeader);
}

}  // namespace
}  // namespace gridrt
