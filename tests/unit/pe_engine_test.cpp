// The engine refuses images that would make it read outside its memories, and counts its work.
#include <gtest/gtest.h>

#include "host/pe/engine.hpp"
#include "host/pe/explain.hpp"
#include "tests/unit/pe_fixture.hpp"

namespace gridrt {
namespace {

using protocol::ErrorCode;
using protocol::SectionKind;

struct Parts {
  Image image = fixture::make_image("builtin:sphere");

  std::vector<std::byte>& bytes(SectionKind kind, int pe = 0) {
    for (ImageSection& s : image.sections) {
      if (s.kind == kind && s.pe == pe) return s.bytes;
    }
    throw std::runtime_error("no such section");
  }
  Accepted<TraversalMemory> traversal() {
    return TraversalMemory::decode(image.header, bytes(SectionKind::kBlocks),
                                   bytes(SectionKind::kCells));
  }
  Accepted<Pe> pe() {
    return Pe::decode(image.header, 0, bytes(SectionKind::kReferences),
                      bytes(SectionKind::kTriangles), bytes(SectionKind::kVertices));
  }
};

void expect_refused(const Accepted<Pe>& result, SectionKind kind) {
  ASSERT_FALSE(result.has_value());
  EXPECT_EQ(result.error().code, ErrorCode::kBadSection);
  EXPECT_EQ(result.error().detail, section_detail(kind, 0));
}

TEST(PeDecode, RefusesIndicesOutsideItsMemory) {
  Parts parts;
  ASSERT_TRUE(parts.pe().has_value());
  const std::vector<std::byte> references = parts.bytes(SectionKind::kReferences);
  std::ranges::fill(parts.bytes(SectionKind::kReferences), std::byte{0xFF});
  expect_refused(parts.pe(), SectionKind::kReferences);
  parts.bytes(SectionKind::kReferences) = references;

  const std::vector<std::byte> triangles = parts.bytes(SectionKind::kTriangles);
  std::ranges::fill(parts.bytes(SectionKind::kTriangles), std::byte{0xFF});
  expect_refused(parts.pe(), SectionKind::kTriangles);
  parts.bytes(SectionKind::kTriangles) = triangles;

  std::ranges::fill(parts.bytes(SectionKind::kVertices), std::byte{0x7F});
  expect_refused(parts.pe(), SectionKind::kVertices);
}

TEST(PeDecode, RefusesSectionsThatAreNotWholeRecords) {
  Parts parts;
  parts.bytes(SectionKind::kVertices).pop_back();
  expect_refused(parts.pe(), SectionKind::kVertices);
}

TEST(TraversalMemory, RefusesAWrongNumberOfBlocksOrCells) {
  Parts parts;
  ASSERT_TRUE(parts.traversal().has_value());
  parts.bytes(SectionKind::kCells).pop_back();
  ASSERT_FALSE(parts.traversal().has_value());
  EXPECT_EQ(parts.traversal().error().detail, section_detail(SectionKind::kCells));
}

TEST(TraversalMemory, RefusesAGridThatDoesNotCoverTheBox) {
  Parts parts;
  parts.image.header.grid_edge[1] -= 1;
  ASSERT_FALSE(parts.traversal().has_value());
  EXPECT_EQ(parts.traversal().error().code, ErrorCode::kBadHeader);
}

TEST(Engine, RefusesACellBeyondItsOwnersReferences) {
  Parts parts;
  parts.image.header.pes = 1;
  Accepted<TraversalMemory> traversal = parts.traversal();
  // With one PE in the header, cells of the other owners are refused first.
  ASSERT_FALSE(traversal.has_value());
  EXPECT_EQ(traversal.error().detail, section_detail(SectionKind::kCells));
}

TEST(Engine, MaskAndEarlyEndSaveWorkAndLoseNothing) {
  const Image image = fixture::make_image("builtin:teapot?tessellation=8");
  const std::vector<Segment> segments = fixture::random_segments(image, 500, 3);
  std::size_t hits = 0;
  std::size_t cancels = 0;
  std::size_t masked = 0;
  for (const Segment& s : segments) {
    const auto events = explain(image, s);
    ASSERT_TRUE(events.has_value());
    ASSERT_EQ(events->back().kind, ExplainEvent::Kind::kCommit);
    std::uint32_t best = kNoTriangle;
    std::uint32_t quotient = 0xFFFFFFFFU;
    std::uint32_t last_entry = 0;
    for (const ExplainEvent& e : *events) {
      if (e.kind == ExplainEvent::Kind::kVoxel) {
        EXPECT_GE(e.enter, last_entry) << "voxels come in order of entry";
        last_entry = e.enter;
      }
      if (e.kind == ExplainEvent::Kind::kMasked) ++masked;
      if (e.kind == ExplainEvent::Kind::kCancel) ++cancels;
      if (e.kind == ExplainEvent::Kind::kHit &&
          (e.quotient < quotient || (e.quotient == quotient && e.id < best))) {
        best = e.id;
        quotient = e.quotient;
      }
    }
    EXPECT_EQ(events->back().id, best);
    if (best != kNoTriangle) ++hits;
  }
  EXPECT_GT(hits, 100U);
  EXPECT_GT(cancels, 50U);
  EXPECT_GT(masked, 100U);
}

}  // namespace
}  // namespace gridrt
