// Bit records against a packer that sets one bit at a time.
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "gridrt_protocol.hpp"

namespace gridrt::protocol {
namespace {

/// Fields one after the other from bit 0, zeros to the end.
class SlowPacker {
 public:
  void add(std::uint32_t value, unsigned width) {
    for (unsigned i = 0; i < width; ++i) bits_.push_back(((value >> i) & 1U) != 0);
  }
  [[nodiscard]] std::vector<std::byte> bytes(std::size_t size) const {
    std::vector<std::byte> out(size, std::byte{0});
    for (std::size_t i = 0; i < bits_.size(); ++i) {
      if (bits_[i]) out.at(i / 8) |= static_cast<std::byte>(1U << (i % 8));
    }
    return out;
  }
  [[nodiscard]] std::size_t size() const { return bits_.size(); }

 private:
  std::vector<bool> bits_;
};

std::uint32_t random_bits(std::mt19937& random, unsigned width) {
  const std::uint32_t mask = width == 32 ? ~0U : (1U << width) - 1U;
  switch (random() % 4) {
    case 0:
      return mask;
    case 1:
      return 0;
    default:
      return static_cast<std::uint32_t>(random()) & mask;
  }
}

template <class Record>
std::vector<std::byte> packed(const Record& record) {
  std::array<std::byte, Record::kBytes> out{};
  pack(record, out);
  return {out.begin(), out.end()};
}

TEST(Records, RayCompact) {
  std::mt19937 random(1);
  for (int round = 0; round < 2000; ++round) {
    RayCompact ray;
    for (auto& c : ray.p0) c = random_bits(random, 17);
    for (auto& c : ray.p1) c = random_bits(random, 17);
    ray.ignore = random_bits(random, 20);
    ray.any_hit = random() % 2 == 0;
    ray.spare = random_bits(random, 5);
    SlowPacker slow;
    for (const auto c : ray.p0) slow.add(c, 17);
    for (const auto c : ray.p1) slow.add(c, 17);
    slow.add(ray.ignore, 20);
    slow.add(ray.any_hit ? 1 : 0, 1);
    slow.add(ray.spare, 5);
    ASSERT_EQ(slow.size(), 128U);
    ASSERT_TRUE(fits(ray));
    const std::vector<std::byte> bytes = packed(ray);
    ASSERT_EQ(bytes, slow.bytes(16));
    ASSERT_EQ(unpack_ray_compact(std::span(bytes).first<16>()), ray);
  }
}

TEST(Records, RayWide) {
  std::mt19937 random(2);
  for (int round = 0; round < 500; ++round) {
    RayWide ray;
    for (auto& c : ray.p0) c = random_bits(random, 32);
    for (auto& c : ray.p1) c = random_bits(random, 32);
    ray.ignore = random_bits(random, 32);
    ray.any_hit = random() % 2 == 0;
    SlowPacker slow;
    for (const auto c : ray.p0) slow.add(c, 32);
    for (const auto c : ray.p1) slow.add(c, 32);
    slow.add(ray.ignore, 32);
    slow.add(ray.any_hit ? 1 : 0, 1);
    const std::vector<std::byte> bytes = packed(ray);
    ASSERT_EQ(bytes, slow.bytes(32));
    ASSERT_EQ(unpack_ray_wide(std::span(bytes).first<32>()), ray);
  }
}

TEST(Records, Hits) {
  std::mt19937 random(3);
  for (int round = 0; round < 500; ++round) {
    const HitCompact compact{random_bits(random, 20), random() % 2 == 0, random() % 2 == 0,
                             random_bits(random, 10)};
    SlowPacker slow;
    slow.add(compact.id, 20);
    slow.add(compact.hit ? 1 : 0, 1);
    slow.add(compact.uncertain ? 1 : 0, 1);
    slow.add(compact.spare, 10);
    const std::vector<std::byte> bytes = packed(compact);
    ASSERT_EQ(bytes, slow.bytes(4));
    ASSERT_EQ(unpack_hit_compact(std::span(bytes).first<4>()), compact);

    const HitWide wide{random_bits(random, 32), random() % 2 == 0, random() % 2 == 0,
                       random_bits(random, 30)};
    SlowPacker slow_wide;
    slow_wide.add(wide.id, 32);
    slow_wide.add(wide.hit ? 1 : 0, 1);
    slow_wide.add(wide.uncertain ? 1 : 0, 1);
    slow_wide.add(wide.spare, 30);
    const std::vector<std::byte> wide_bytes = packed(wide);
    ASSERT_EQ(wide_bytes, slow_wide.bytes(8));
    ASSERT_EQ(unpack_hit_wide(std::span(wide_bytes).first<8>()), wide);
  }
}

TEST(Records, FitsTellsWhatPackWouldCut) {
  RayCompact ray;
  EXPECT_TRUE(fits(ray));
  ray.p1[2] = 1U << 17U;
  EXPECT_FALSE(fits(ray));
  HitCompact hit;
  hit.id = kNoIdCompact;
  EXPECT_TRUE(fits(hit));
  hit.id = kNoIdCompact + 1;
  EXPECT_FALSE(fits(hit));
  // What is cut does not spill into the neighbours.
  hit.id = 0xFFF00000U;
  const std::vector<std::byte> bytes = packed(hit);
  EXPECT_EQ(unpack_hit_compact(std::span(bytes).first<4>()), HitCompact{});
}

ImageHeader random_widths(std::mt19937& random) {
  const auto width = [&] { return static_cast<std::uint8_t>(1 + random() % 32); };
  ImageHeader h;
  h.coordinate_bits = width();
  h.vertex_index_bits = width();
  h.triangle_index_bits = width();
  h.id_bits = width();
  h.base_bits = width();
  h.first_bits = width();
  h.list_bits = width();
  h.pe_bits = width();
  return h;
}

/// Packs two records after each other and compares with the slow packer.
template <class Codec, class Record>
void expect_codec(const Codec& codec, const Record& record, const SlowPacker& slow) {
  ASSERT_TRUE(codec.valid());
  ASSERT_EQ(codec.bits(), slow.size());
  ASSERT_EQ(codec.stride(), (slow.size() + 7) / 8);
  ASSERT_TRUE(codec.fits(record));
  std::vector<std::byte> out(2 * codec.stride(), std::byte{0xFF});
  ASSERT_TRUE(codec.pack(record, out));
  ASSERT_TRUE(codec.pack(record, std::span(out).subspan(codec.stride())));
  const std::vector<std::byte> expected = slow.bytes(codec.stride());
  ASSERT_TRUE(std::equal(expected.begin(), expected.end(), out.begin()));
  ASSERT_EQ(codec.at(out, 0), record);
  ASSERT_EQ(codec.at(out, 1), record);
}

TEST(Codecs, AnyWidths) {
  std::mt19937 random(4);
  for (int round = 0; round < 2000; ++round) {
    const ImageHeader h = random_widths(random);
    BlockRecord block;
    SlowPacker slow_block;
    for (auto& j : block.jump) slow_block.add(j = random_bits(random, 3), 3);
    slow_block.add(block.occupancy = random_bits(random, 8), 8);
    slow_block.add(block.base = random_bits(random, h.base_bits), h.base_bits);
    expect_codec(BlockCodec(h), block, slow_block);

    CellRecord cell;
    SlowPacker slow_cell;
    slow_cell.add(cell.first = random_bits(random, h.first_bits), h.first_bits);
    slow_cell.add(cell.count = random_bits(random, h.list_bits), h.list_bits);
    slow_cell.add(cell.pe = random_bits(random, h.pe_bits), h.pe_bits);
    expect_codec(CellCodec(h), cell, slow_cell);

    ReferenceRecord reference;
    SlowPacker slow_reference;
    reference.triangle = random_bits(random, h.triangle_index_bits);
    slow_reference.add(reference.triangle, h.triangle_index_bits);
    slow_reference.add(reference.quarters = random_bits(random, 10), 10);
    expect_codec(ReferenceCodec(h), reference, slow_reference);

    TriangleRecord triangle;
    SlowPacker slow_triangle;
    for (auto& v : triangle.vertex) {
      slow_triangle.add(v = random_bits(random, h.vertex_index_bits), h.vertex_index_bits);
    }
    slow_triangle.add(triangle.id = random_bits(random, h.id_bits), h.id_bits);
    expect_codec(TriangleCodec(h), triangle, slow_triangle);

    VertexRecord vertex;
    SlowPacker slow_vertex;
    for (auto& q : vertex.q) {
      slow_vertex.add(q = random_bits(random, h.coordinate_bits), h.coordinate_bits);
    }
    expect_codec(VertexCodec(h), vertex, slow_vertex);
  }
}

TEST(Codecs, RefuseWhatDoesNotFit) {
  ImageHeader h;
  h.coordinate_bits = 18;
  const VertexCodec codec(h);
  std::array<std::byte, 7> out{};
  EXPECT_TRUE(codec.pack({.q = {0x3FFFF, 0, 0}}, out));
  out.fill(std::byte{0x5A});
  EXPECT_FALSE(codec.pack({.q = {0, 0x40000, 0}}, out));
  EXPECT_FALSE(codec.pack({.q = {1, 2, 3}}, std::span(out).first(6)));
  for (const std::byte b : out) EXPECT_EQ(b, std::byte{0x5A}) << "nothing may be written";
}

TEST(Codecs, WidthsOutsideOneTo32AreNotValid) {
  ImageHeader h;
  for (const int width : {0, 33, 64, 255}) {
    h.coordinate_bits = static_cast<std::uint8_t>(width);
    const VertexCodec codec(h);
    EXPECT_FALSE(codec.valid()) << width;
    EXPECT_GE(codec.stride(), 1U);
    EXPECT_LE(codec.stride(), 12U);
  }
}

TEST(Codecs, SizesOfTheBoard) {
  ImageHeader h;
  h.coordinate_bits = static_cast<std::uint8_t>(kCompactLimits.coordinate_bits);
  h.vertex_index_bits = static_cast<std::uint8_t>(kCompactLimits.vertex_index_bits);
  h.triangle_index_bits = static_cast<std::uint8_t>(kCompactLimits.triangle_index_bits);
  h.id_bits = static_cast<std::uint8_t>(kCompactLimits.id_bits);
  EXPECT_EQ(VertexCodec(h).bits(), 54U);
  EXPECT_EQ(ReferenceCodec(h).bits(), 22U);
  EXPECT_EQ(TriangleCodec(h).bits(), 56U);
}

}  // namespace
}  // namespace gridrt::protocol
