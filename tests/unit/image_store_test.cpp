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

}  // namespace
}  // namespace gridrt
