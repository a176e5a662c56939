// The compact layout's memories: exactly full, one entry over, and grids chosen to fit.
#include <bit>

#include "host/image/image_file.hpp"
#include "host/image/limits.hpp"
#include "image_support.hpp"

namespace gridrt {
namespace {

using protocol::kCompactLimits;

ImageOptions compact(int pes) {
  ImageOptions options;
  options.layout = protocol::Layout::kCompact;
  options.pes = pes;
  options.with_scene = false;
  return options;
}

Error error_of(const Scene& scene, const ImageOptions& options) {
  const auto image = build_image(scene, options);
  EXPECT_FALSE(image);
  return image ? Error{} : image.error();
}

TEST(Limits, TriangleMemoryExactlyFull) {
  // 64 x 32 quads: 4,096 triangles, 2,145 vertices.
  const Image image = must_build(sheet_scene(64, 32), compact(1));
  EXPECT_EQ(count_image(image)[0].triangles, kCompactLimits.max_triangles);
  EXPECT_TRUE(verify_image(image)) << verify_image(image).error().message;

  Scene over = sheet_scene(64, 32);
  over.triangles.push_back({0, 5, 200});
  over.triangle_materials.push_back(0);
  const Error error = error_of(over, compact(1));
  EXPECT_EQ(error.kind, ErrorKind::kLimit);
  EXPECT_NE(error.message.find("4097 triangles"), std::string::npos) << error.message;
  EXPECT_FALSE(error.advice.empty());
}

/// A use that fills every memory of the compact layout.
ImageUse full_use() {
  ImageUse use;
  use.local_ids = 4 * kCompactLimits.max_triangles;
  use.blocks = kCompactLimits.max_blocks;
  use.cells = kCompactLimits.max_cells;
  use.longest_list = 1023;
  use.pes.assign(4, {kCompactLimits.max_triangles, kCompactLimits.max_vertices,
                     kCompactLimits.max_references});
  return use;
}

constexpr MemorySizes kBoard = memory_sizes(protocol::Layout::kCompact);

TEST(Limits, EveryMemoryIsCheckedToTheEntry) {
  EXPECT_TRUE(check_limits(protocol::Layout::kCompact, kBoard, full_use()));
  const auto expect_over = [](const ImageUse& use, std::string_view text) {
    const auto good = check_limits(protocol::Layout::kCompact, kBoard, use);
    ASSERT_FALSE(good);
    EXPECT_EQ(good.error().kind, ErrorKind::kLimit);
    EXPECT_NE(good.error().message.find(text), std::string::npos) << good.error().message;
    EXPECT_FALSE(good.error().advice.empty());
  };
  ImageUse use = full_use();
  ++use.blocks;
  expect_over(use, "4097 blocks");
  use = full_use();
  ++use.cells;
  expect_over(use, "6145 voxels");
  use = full_use();
  ++use.longest_list;
  expect_over(use, "1024 triangles in one voxel");
  use = full_use();
  ++use.pes[1].triangles;
  expect_over(use, "4097 triangles in PE 1");
  use = full_use();
  ++use.pes[3].vertices;
  expect_over(use, "2561 vertices in PE 3");
  use = full_use();
  ++use.pes[0].references;
  expect_over(use, "8193 references in PE 0");
  EXPECT_TRUE(check_limits(protocol::Layout::kWide, memory_sizes(protocol::Layout::kWide), use));
}

TEST(Limits, BitsPesAndIds) {
  using protocol::Layout;
  EXPECT_TRUE(check_widths(Layout::kCompact, 17, 4));
  EXPECT_FALSE(check_widths(Layout::kCompact, 18, 4));
  EXPECT_FALSE(check_widths(Layout::kCompact, 17, 5));
  EXPECT_TRUE(check_widths(Layout::kWide, 24, 64));
  EXPECT_TRUE(check_scene_limits(Layout::kCompact, kBoard, 4, 16384));
  EXPECT_FALSE(check_scene_limits(Layout::kCompact, kBoard, 4, 16385));
  const MemorySizes wide = memory_sizes(Layout::kWide);
  EXPECT_TRUE(check_scene_limits(Layout::kWide, wide, 64, 0x7FFFFFFF));
  EXPECT_EQ(most_pes(Layout::kCompact), 4);
  EXPECT_EQ(most_pes(Layout::kWide), 64);
  EXPECT_EQ(most_local_ids(Layout::kCompact), protocol::kNoIdCompact);
  EXPECT_EQ(most_local_ids(Layout::kWide), protocol::kNoIdWide);
}

TEST(Limits, ChosenGridIsMadeCoarserUntilItFits) {
  // At four voxels a triangle this takes more than 4,096 blocks.
  const Scene scene = sheet_scene(70, 65, 1.0F);
  const Image image = must_build(scene, compact(4));
  EXPECT_LE(image.find(protocol::SectionKind::kBlocks)->bytes.size() / 5, 4096U);
  EXPECT_TRUE(verify_image(image));
  ImageOptions wide = compact(4);
  wide.layout = protocol::Layout::kWide;
  EXPECT_GT(must_build(scene, wide).grid().cells(), image.grid().cells());
}

TEST(Limits, AskedGridIsNotChanged) {
  const Scene scene = random_scene(100, 7);
  ImageOptions options = compact(4);
  options.grid = glm::ivec3{34, 34, 34};
  const Error error = error_of(scene, options);
  EXPECT_EQ(error.kind, ErrorKind::kLimit);
  EXPECT_NE(error.message.find("4913 blocks"), std::string::npos) << error.message;
  options.grid = glm::ivec3{32, 32, 32};
  EXPECT_EQ(must_build(scene, options).grid().count, glm::ivec3(32));
}

TEST(Limits, CompactRecordsHoldSeventeenBits) {
  ImageOptions options = compact(2);
  options.bits = 17;
  const Image image = must_build(random_scene(50, 8), options);
  for (int a = 0; a < 3; ++a) EXPECT_LT(image.lattice().box()[a], 1 << 17);
  options.bits = 18;
  EXPECT_EQ(error_of(random_scene(50, 8), options).kind, ErrorKind::kLimit);
  options.layout = protocol::Layout::kWide;
  options.bits = 24;
  const Image wide = must_build(random_scene(50, 8), options);
  EXPECT_TRUE(verify_image(wide)) << verify_image(wide).error().message;
}

}  // namespace
}  // namespace gridrt
