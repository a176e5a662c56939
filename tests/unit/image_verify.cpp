// verify_image: corruptions whose CRCs are right again are found, and the message says where.
#include <functional>

#include "host/image/image_file.hpp"
#include "image_support.hpp"

namespace gridrt {
namespace {

using protocol::SectionKind;

ImageSection& section(Image& image, SectionKind kind, int pe = 0) {
  for (ImageSection& s : image.sections) {
    if (s.kind == kind && s.pe == pe) return s;
  }
  ADD_FAILURE() << "no section";
  return image.sections.front();
}

/// Changes one record of a section.
template <class Codec, class Change>
void change_record(Image& image, SectionKind kind, int pe, std::size_t index, Change&& change) {
  const Codec codec(image.header);
  std::vector<std::byte>& bytes = section(image, kind, pe).bytes;
  ASSERT_LT((index + 1) * codec.stride(), bytes.size() + 1);
  auto record = codec.at(bytes, index);
  change(record);
  ASSERT_TRUE(codec.pack(record, std::span(bytes).subspan(index * codec.stride())));
}

/// The first block that is empty (or not), with a jump along +x if it is.
std::size_t find_block(const Image& image, bool occupied) {
  const protocol::BlockCodec codec(image.header);
  const auto& bytes = image.find(SectionKind::kBlocks)->bytes;
  for (std::size_t i = 0; i < bytes.size() / codec.stride(); ++i) {
    const auto record = codec.at(bytes, i);
    if (occupied ? record.occupancy != 0 : record.jump[0] > 0) return i;
  }
  ADD_FAILURE() << "no such block";
  return 0;
}

struct Corruption {
  std::string name;
  std::function<void(Image&)> apply;
  std::string message;  ///< part of what verify_image (or parse_image) says
};

template <class Codec, class Record>
Corruption record(std::string name, SectionKind kind, int pe, std::size_t index,
                  std::function<void(Record&)> change, std::string message) {
  return {std::move(name),
          [=](Image& image) { change_record<Codec>(image, kind, pe, index, change); },
          std::move(message)};
}

std::vector<Corruption> record_corruptions(const Image& image) {
  using protocol::BlockRecord;
  using protocol::CellRecord;
  using protocol::ReferenceRecord;
  using protocol::TriangleRecord;
  using protocol::VertexRecord;
  const std::size_t empty = find_block(image, false);
  const std::size_t full = find_block(image, true);
  const auto block = [](std::string name, std::size_t at,
                        std::function<void(BlockRecord&)> change) {
    return record<protocol::BlockCodec, BlockRecord>(std::move(name), SectionKind::kBlocks, 0, at,
                                                     std::move(change), "section Blocks: record");
  };
  const auto cell = [](std::string name, std::function<void(CellRecord&)> change) {
    return record<protocol::CellCodec, CellRecord>(std::move(name), SectionKind::kCells, 0, 3,
                                                   std::move(change), "section Cells: record 3");
  };
  const auto reference = [](std::string name, std::function<void(ReferenceRecord&)> change) {
    return record<protocol::ReferenceCodec, ReferenceRecord>(
        std::move(name), SectionKind::kReferences, 1, 2, std::move(change),
        "section References of PE 1: record 2");
  };
  const auto triangle = [](std::string name, std::function<void(TriangleRecord&)> change,
                           std::string message) {
    return record<protocol::TriangleCodec, TriangleRecord>(
        std::move(name), SectionKind::kTriangles, 1, 2, std::move(change), std::move(message));
  };
  const auto vertex = [](std::string name, std::function<void(VertexRecord&)> change,
                         std::string message) {
    return record<protocol::VertexCodec, VertexRecord>(std::move(name), SectionKind::kVertices, 1,
                                                       4, std::move(change), std::move(message));
  };
  const std::string in_triangles = "section Triangles of PE 1: triangle 2";
  return {
      block("a jump too long", empty, [](auto& r) { r.jump[0] = r.jump[0] == 7 ? 6 : 7; }),
      block("a jump too short", empty, [](auto& r) { --r.jump[0]; }),
      block("a jump out of an occupied block", full, [](auto& r) { r.jump[3] = 1; }),
      block("an occupied voxel hidden", full, [](auto& r) { r.occupancy &= r.occupancy - 1; }),
      block("an empty voxel shown", empty, [](auto& r) { r.occupancy |= 1; }),
      block("another base", full, [](auto& r) { ++r.base; }),
      block("a base where nothing is", empty, [](auto& r) { r.base = 1; }),
      cell("another first reference", [](auto& r) { r.first ^= 1; }),
      cell("a reference more", [](auto& r) { ++r.count; }),
      cell("an empty list", [](auto& r) { r.count = 0; }),
      cell("another owner", [](auto& r) { r.pe ^= 1; }),
      cell("an owner that is not there", [](auto& r) { r.pe = 3; }),
      reference("another triangle", [](auto& r) { r.triangle ^= 1; }),
      reference("a triangle that is not there", [](auto& r) { r.triangle = 4000; }),
      reference("quarters moved", [](auto& r) { r.quarters ^= 1; }),
      reference("all but one quarter hidden",
                [](auto& r) { r.quarters = r.quarters == 0 ? 1 : 0; }),
      reference("all quarters shown", [](auto& r) { r.quarters = r.quarters == 0xFF ? 0 : 0xFF; }),
      triangle(
          "a vertex that is not there", [](auto& r) { r.vertex[1] = 4000; }, in_triangles),
      triangle(
          "two vertices swapped", [](auto& r) { std::swap(r.vertex[0], r.vertex[1]); }, ""),
      triangle(
          "degenerate", [](auto& r) { r.vertex[0] = r.vertex[1]; }, ""),
      triangle(
          "an id that is not there", [](auto& r) { r.id = 4000; }, in_triangles),
      triangle(
          "ids out of order", [](auto& r) { r.id = 0; }, in_triangles + ": id 0 after"),
      vertex(
          "another place", [](auto& r) { r.q[1] += 1; }, ""),
      vertex(
          "outside the lattice", [](auto& r) { r.q[2] = 1; }, "vertex 4: coordinate 1"),
      vertex(
          "beyond the bounds", [](auto& r) { r.q[0] = 131071; }, "vertex 4: coordinate 131071"),
  };
}

/// A change of one header field.
Corruption header(std::string name, std::function<void(protocol::ImageHeader&)> change) {
  return {std::move(name), [=](Image& image) { change(image.header); }, ""};
}

std::vector<Corruption> header_corruptions() {
  return {
      header("version", [](auto& h) { ++h.version; }),
      header("layout", [](auto& h) { h.layout ^= 3; }),
      header("layout none", [](auto& h) { h.layout = 0; }),
      header("PEs", [](auto& h) { ++h.pes; }),
      header("no PE", [](auto& h) { h.pes = 0; }),
      header("bits", [](auto& h) { --h.bits; }),
      header("bits beyond", [](auto& h) { h.bits = 99; }),
      header("mapping", [](auto& h) { h.mapping = 1; }),
      header("unknown mapping", [](auto& h) { h.mapping = 77; }),
      header("chunk", [](auto& h) { ++h.chunk; }),
      header("chunks", [](auto& h) { h.chunks = 0; }),
      header("lo", [](auto& h) { h.lo[1] -= 0.25F; }),
      header("lo is NaN", [](auto& h) { h.lo[1] = std::numeric_limits<float>::quiet_NaN(); }),
      header("hi", [](auto& h) { h.hi[0] += 0.25F; }),
      header("hi below lo", [](auto& h) { std::swap(h.hi, h.lo); }),
      header("scale", [](auto& h) { ++h.scale[2]; }),
      header("max_q", [](auto& h) { ++h.max_q[0]; }),
      header("max_q beyond", [](auto& h) { h.max_q[0] = 0x7FFFFFFF; }),
      header("grid", [](auto& h) { --h.grid_count[0]; }),
      header("grid beyond", [](auto& h) { h.grid_count = {0x7FFFFFFF, 0x7FFFFFFF, 4}; }),
      header("no grid", [](auto& h) { h.grid_count[1] = 0; }),
      header("grid below nothing", [](auto& h) { h.grid_count[1] = -1; }),
      header("edge", [](auto& h) { ++h.grid_edge[1]; }),
      header("margin", [](auto& h) { h.margin = 0; }),
      header("triangles", [](auto& h) { ++h.triangles; }),
      header("triangles beyond", [](auto& h) { h.triangles = 0xFFFFFFFF; }),
      header("degenerate", [](auto& h) { ++h.degenerate; }),
      header("local ids", [](auto& h) { --h.local_ids; }),
      header("local ids beyond", [](auto& h) { h.local_ids = 0xFFFFFFFF; }),
      header("coordinate_bits", [](auto& h) { --h.coordinate_bits; }),
      header("no coordinate_bits", [](auto& h) { h.coordinate_bits = 0; }),
      header("vertex_index_bits", [](auto& h) { h.vertex_index_bits = 33; }),
      header("triangle_index_bits", [](auto& h) { --h.triangle_index_bits; }),
      header("id_bits", [](auto& h) { h.id_bits = 255; }),
      header("base_bits", [](auto& h) { --h.base_bits; }),
      header("first_bits", [](auto& h) { --h.first_bits; }),
      header("list_bits", [](auto& h) { --h.list_bits; }),
      header("pe_bits", [](auto& h) { --h.pe_bits; }),
      header("occupied cells", [](auto& h) { ++h.occupied_cells; }),
      header("reserved0", [](auto& h) { h.reserved0 = 1; }),
      header("reserved3", [](auto& h) { h.reserved3 = 1; }),
  };
}

std::vector<Corruption> section_corruptions() {
  const auto erase = [](SectionKind kind, int pe) {
    return [=](Image& image) {
      std::erase_if(image.sections,
                    [&](const ImageSection& s) { return s.kind == kind && s.pe == pe; });
    };
  };
  const auto resize = [](SectionKind kind, std::ptrdiff_t by) {
    return [=](Image& image) {
      auto& bytes = section(image, kind).bytes;
      bytes.resize(bytes.size() + static_cast<std::size_t>(by));
    };
  };
  return {
      {"no blocks", erase(SectionKind::kBlocks, 0), "section Blocks"},
      {"no cells", erase(SectionKind::kCells, 0), "section Cells"},
      {"no ids", erase(SectionKind::kIds, 0), "section Ids"},
      {"no vertices", erase(SectionKind::kVertices, 1), "section Vertices of PE 1"},
      {"no references", erase(SectionKind::kReferences, 0), "section References of PE 0"},
      {"a byte of the blocks less", resize(SectionKind::kBlocks, -1), "section Blocks"},
      {"a block more", resize(SectionKind::kBlocks, 8), "section Blocks"},
      {"a byte of the vertices less", resize(SectionKind::kVertices, -1), "section Vertices"},
      {"references lost", resize(SectionKind::kReferences, -36), "section References of PE 0"},
      {"an id less", resize(SectionKind::kIds, -4), "section Ids"},
      {"a byte of the scene less", resize(SectionKind::kScene, -1), "scene section"},
      {"sections in another order",
       [](Image& image) { std::swap(image.sections[0], image.sections[1]); }, "directory"},
      {"a section twice", [](Image& image) { image.sections.push_back(image.sections.back()); },
       "twice"},
      {"a section of no kind", [](Image& image) { image.sections[2].kind = SectionKind{77}; },
       "directory entry 2"},
      {"a header as section", [](Image& image) { image.sections[2].kind = SectionKind::kHeader; },
       "directory entry 2"},
      {"a section of a PE that is not there", [](Image& image) { image.sections[2].pe = 9; },
       "section References of PE 0"},
      {"a shared section with an owner", [](Image& image) { image.sections[0].pe = 1; },
       "section Blocks"},
      {"no triangle left",
       [](Image& image) {
         for (const int pe : {0, 1}) section(image, SectionKind::kTriangles, pe).bytes.clear();
       },
       "no PE holds the triangle with local id 0"},
      {"an id out of order",
       [](Image& image) {
         protocol::detail::put32(section(image, SectionKind::kIds).bytes.data() + 8, 0);
       },
       "section Ids: id 2"},
      {"an id beyond the scene",
       [](Image& image) {
         auto& bytes = section(image, SectionKind::kIds).bytes;
         protocol::detail::put32(bytes.data() + bytes.size() - 4, 5000);
       },
       "section Ids"},
      {"an id of a degenerate triangle",
       [](Image& image) {
         // Triangle 3 is degenerate, so local id 3 is triangle 4.
         protocol::detail::put32(section(image, SectionKind::kIds).bytes.data() + 12, 3);
       },
       "section Scene"},
  };
}

/// What the file's checks and the deep check say; empty if neither objects.
std::string verdict(const Image& image) {
  const auto parsed = parse_image(serialize_image(image), "test.grt");
  if (!parsed) return parsed.error().message;
  const auto verified = verify_image(*parsed);
  return verified ? std::string{} : verified.error().message;
}

/// Most triangles in a corner of the box, so that there are blocks to skip.
Image test_image(protocol::Layout layout) {
  Scene scene = random_scene(50, 9, 0.4F);
  for (glm::vec3& v : scene.positions) v *= 0.25F;
  add_triangle(scene, {0.9F, 0.9F, 0.9F}, {1.0F, 0.9F, 0.9F}, {0.9F, 1.0F, 1.0F});
  ImageOptions options;
  options.layout = layout;
  options.pes = 2;
  options.grid = glm::ivec3{8, 8, 8};
  return must_build(scene, options);
}

class Verify : public testing::TestWithParam<protocol::Layout> {};

TEST_P(Verify, FindsEveryCorruption) {
  const Image good = test_image(GetParam());
  ASSERT_EQ(verdict(good), "");
  std::vector<Corruption> all = record_corruptions(good);
  for (auto& c : header_corruptions()) all.push_back(std::move(c));
  for (auto& c : section_corruptions()) all.push_back(std::move(c));
  for (const Corruption& corruption : all) {
    Image image = good;
    corruption.apply(image);
    const std::string said = verdict(image);
    EXPECT_NE(said, "") << corruption.name;
    EXPECT_NE(said.find(corruption.message), std::string::npos) << corruption.name << ": " << said;
  }
}

TEST_P(Verify, FindsEveryFlippedBitOfEverySectionButTheScene) {
  const Image good = test_image(GetParam());
  for (std::size_t s = 0; s < good.sections.size(); ++s) {
    if (good.sections[s].kind == SectionKind::kScene) continue;
    Image image = good;
    std::vector<std::byte>& bytes = image.sections[s].bytes;
    for (std::size_t bit = 0; bit < 8 * bytes.size(); ++bit) {
      const auto mask = static_cast<std::byte>(1U << (bit % 8));
      bytes[bit / 8] ^= mask;
      ASSERT_FALSE(verify_image(image)) << protocol::name(image.sections[s].kind) << " bit " << bit;
      bytes[bit / 8] ^= mask;
    }
  }
}

TEST_P(Verify, CopiesOfATriangleMustAgree) {
  // The same triangle in both PEs; one copy is turned round, which no other check of one PE sees.
  Image image = test_image(GetParam());
  const protocol::TriangleCodec codec(image.header);
  const auto ids = [&](int pe) {
    std::vector<std::uint32_t> out;
    const auto& bytes = section(image, SectionKind::kTriangles, pe).bytes;
    for (std::size_t i = 0; i < bytes.size() / codec.stride(); ++i) {
      out.push_back(codec.at(bytes, i).id);
    }
    return out;
  };
  const auto first = ids(0);
  const auto second = ids(1);
  for (std::size_t i = 0; i < second.size(); ++i) {
    if (std::find(first.begin(), first.end(), second[i]) == first.end()) continue;
    change_record<protocol::TriangleCodec>(image, SectionKind::kTriangles, 1, i, [](auto& r) {
      r.vertex = {r.vertex[1], r.vertex[2], r.vertex[0]};
    });
    const auto decoded = decode_triangles(image);
    ASSERT_FALSE(decoded);
    EXPECT_NE(decoded.error().message.find("differs from an earlier PE's copy"), std::string::npos)
        << decoded.error().message;
    return;
  }
  FAIL() << "no triangle has two copies";
}

INSTANTIATE_TEST_SUITE_P(Layouts, Verify,
                         testing::Values(protocol::Layout::kWide, protocol::Layout::kCompact),
                         [](const auto& layout) {
                           return std::string(protocol::name(layout.param));
                         });

}  // namespace
}  // namespace gridrt
