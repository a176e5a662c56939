// Case 36 on every device: scenes in chunks; memories that are full to the last entry, which is
// used; and one entry more, refused before anything is sent.
#include <algorithm>
#include <array>
#include <utility>

#include "host/driver/chunked_device.hpp"
#include "host/driver/image_options.hpp"
#include "tests/adversarial/meshes.hpp"
#include "tests/contract/fixture.hpp"

namespace gridrt::contract {
namespace {

using protocol::SectionKind;

TEST_P(Contract, TheChunksOfASceneAnswerAsOne) {
  const Scene scene = awkward_scene(40);
  const auto segments = awkward_segments(scene, bits(), 41);
  ImageOptions options = plain();
  options.grid.reset();
  const MemorySizes small{
      .triangles = 60, .vertices = 80, .references = 150, .cells = 60, .blocks = 64};
  options.memory = smaller_of(*options.memory, small);
  auto images = build_scene_images(scene, options);
  ASSERT_TRUE(images) << images.error().message;
  const std::size_t chunks = images->chunks.size();
  EXPECT_GT(chunks, 3U);
  auto device = load_images(open(), std::make_shared<const SceneImages>(std::move(*images)));
  ASSERT_TRUE(device) << device.error().message;
  for (const Query query : {Query::kClosestHit, Query::kAnyHit, Query::kClosestHit}) {
    expect_same(trace(**device, segments, query), reference(scene, bits(), segments, query),
                "in chunks");
    if (HasFatalFailure()) return;
  }
  EXPECT_GT((*device)->counters()->uploads, chunks);
  std::vector<Hit> hits(1);
  EXPECT_FALSE((*device)->trace(segments, Query::kClosestHit, hits));
  // A single image takes the place of the chunks.
  const auto whole = build_image(scene, plain());
  ASSERT_TRUE(whole);
  ASSERT_TRUE((*device)->load(*whole));
  expect_same(trace(**device, segments, Query::kClosestHit),
              reference(scene, bits(), segments, Query::kClosestHit), "after chunks");
}

/// As many triangles as a PE holds: small ones all over a cube, with three vertices each as long as
/// there is room for vertices, then copies of them. None is degenerate on a lattice of `bits`.
Scene full_scene(const MemorySizes& memory, int bits) {
  const double reach = bits < kDefaultBits ? 0.007 : 0.003;
  adversarial::Random random(42);
  Scene scene;
  const std::uint32_t own = std::min(memory.triangles, memory.vertices / 3);
  for (std::uint32_t i = 0; i < own; ++i) {
    const glm::dvec3 place = random.in_box(glm::dvec3{0.0}, glm::dvec3{1.0});
    std::array<glm::vec3, 3> corners{};
    for (glm::vec3& c : corners) {
      c = glm::vec3{place + random.in_box(glm::dvec3{-reach}, glm::dvec3{reach})};
    }
    adversarial::add_triangle(scene, corners[0], corners[1], corners[2]);
  }
  for (std::uint32_t i = own; i < memory.triangles; ++i) {
    const auto t = scene.triangles[i % own];
    adversarial::add_triangle(scene, t[0], t[1], t[2]);
  }
  return scene;
}

template <class Codec>
using RecordOf = decltype(std::declval<Codec>().at(std::span<const std::byte>{}, std::size_t{0}));

template <class Codec>
std::vector<RecordOf<Codec>> unpack_all(const Image& image, SectionKind kind, int pe) {
  const Codec codec(image.header);
  const std::vector<std::byte>& bytes = image.find(kind, pe)->bytes;
  std::vector<RecordOf<Codec>> records;
  for (std::size_t i = 0; i < bytes.size() / codec.stride(); ++i) {
    records.push_back(codec.at(bytes, i));
  }
  return records;
}

template <class Codec>
void pack_all(Image& image, SectionKind kind, int pe, const std::vector<RecordOf<Codec>>& records) {
  const Codec codec(image.header);
  std::vector<std::byte> bytes(records.size() * codec.stride());
  for (std::size_t i = 0; i < records.size(); ++i) {
    ASSERT_TRUE(codec.pack(records[i], std::span(bytes).subspan(i * codec.stride())));
  }
  for (ImageSection& section : image.sections) {
    if (section.kind == kind && section.pe == pe) section.bytes = std::move(bytes);
  }
}

/// Puts copies of the first record in front until there are `most`; returns how many.
template <class Record>
std::uint32_t pad(std::vector<Record>& records, std::uint32_t most) {
  const auto copies = most - static_cast<std::uint32_t>(records.size());
  const Record first = records.front();
  records.insert(records.begin(), copies, first);
  return copies;
}

/// Fills what building has left free in the memories: idle entries go first, so that those in use
/// are the last ones.
void fill(Image& image, const MemorySizes& memory) {
  auto cells = unpack_all<protocol::CellCodec>(image, SectionKind::kCells, 0);
  for (int pe = 0; pe < image.header.pes; ++pe) {
    auto vertices = unpack_all<protocol::VertexCodec>(image, SectionKind::kVertices, pe);
    auto triangles = unpack_all<protocol::TriangleCodec>(image, SectionKind::kTriangles, pe);
    auto references = unpack_all<protocol::ReferenceCodec>(image, SectionKind::kReferences, pe);
    ASSERT_FALSE(vertices.empty());
    const std::uint32_t moved = pad(vertices, memory.vertices);
    for (auto& t : triangles) {
      for (std::uint32_t& v : t.vertex) v += moved;
    }
    const std::uint32_t later = pad(references, memory.references);
    for (auto& c : cells) {
      if (c.pe == static_cast<std::uint32_t>(pe)) c.first += later;
    }
    pack_all<protocol::VertexCodec>(image, SectionKind::kVertices, pe, vertices);
    pack_all<protocol::TriangleCodec>(image, SectionKind::kTriangles, pe, triangles);
    pack_all<protocol::ReferenceCodec>(image, SectionKind::kReferences, pe, references);
  }
  const std::uint32_t later = pad(cells, memory.cells);
  image.header.occupied_cells = memory.cells;
  auto blocks = unpack_all<protocol::BlockCodec>(image, SectionKind::kBlocks, 0);
  for (auto& b : blocks) {
    if (b.occupancy != 0) b.base += later;
  }
  pack_all<protocol::CellCodec>(image, SectionKind::kCells, 0, cells);
  pack_all<protocol::BlockCodec>(image, SectionKind::kBlocks, 0, blocks);
}

/// A cube of as many voxels as the blocks of `memory` allow.
glm::ivec3 finest_cube(const MemorySizes& memory) {
  int n = 1;
  while (static_cast<std::uint32_t>((n + 1) * (n + 1) * (n + 1)) <= memory.blocks) ++n;
  return glm::ivec3{2 * n};
}

/// The image with one more record in a section, of zeros.
template <class Codec>
Image with_one_more(Image image, SectionKind kind) {
  const std::size_t stride = Codec(image.header).stride();
  for (ImageSection& section : image.sections) {
    if (section.kind != kind) continue;
    section.bytes.resize(section.bytes.size() + stride);
    break;
  }
  return image;
}

TEST_P(Contract, FullMemoriesAnswerAndOneEntryMoreIsRefusedBeforeAnythingIsSent) {
  const auto device = open();
  ASSERT_TRUE(device);
  const MemorySizes memory = memory_sizes(device->capabilities());
  if (memory.triangles > 1000000) GTEST_SKIP() << "this device has no memories to fill";
  // With one PE the triangles fill its memory, too.
  const Scene scene = full_scene(memory, bits());
  const auto segments = awkward_segments(scene, bits(), 43);
  const auto expected = reference(scene, bits(), segments, Query::kClosestHit);
  for (const int pes : {1, int{device->capabilities().pes}}) {
    ImageOptions options = plain(bits(), pes);
    options.grid = finest_cube(memory);
    auto image = build_image(scene, options);
    ASSERT_TRUE(image) << image.error().message;
    if (pes == 1) {
      EXPECT_EQ(count_image(*image)[0].triangles, memory.triangles);
    }
    fill(*image, memory);
    if (HasFatalFailure()) return;
    const auto loaded = device->load(*image);
    ASSERT_TRUE(loaded) << loaded.error().message;
    expect_same(trace(*device, segments, Query::kClosestHit), expected, "full memories");
    if (HasFatalFailure()) return;

    const auto expect_refused = [&](const Image& large, const char* what) {
      const auto before = device->counters();
      const auto done = device->load(large);
      ASSERT_FALSE(done) << what;
      EXPECT_EQ(done.error().kind, ErrorKind::kLimit) << done.error().message;
      EXPECT_NE(done.error().message.find(what), std::string::npos) << done.error().message;
      EXPECT_FALSE(done.error().advice.empty());
      EXPECT_EQ(device->counters()->bytes_out, before->bytes_out) << what;
    };
    expect_refused(with_one_more<protocol::VertexCodec>(*image, SectionKind::kVertices),
                   "vertices");
    expect_refused(with_one_more<protocol::ReferenceCodec>(*image, SectionKind::kReferences),
                   "references");
    if (pes == 1) {
      expect_refused(with_one_more<protocol::TriangleCodec>(*image, SectionKind::kTriangles),
                     "triangles");
    }
    Image large = with_one_more<protocol::CellCodec>(*image, SectionKind::kCells);
    ++large.header.occupied_cells;
    expect_refused(large, "voxels");
    large = *image;
    large.header.grid_count[0] += 2;
    expect_refused(large, "blocks");
  }
}

}  // namespace
}  // namespace gridrt::contract
