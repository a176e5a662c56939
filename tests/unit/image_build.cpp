// build_image: what its sections say, decoded by hand, is what the scene and the grid give.
#include <algorithm>
#include <bit>
#include <set>
#include <tuple>

#include "host/grid/quarters.hpp"
#include "host/image/blocks.hpp"
#include "host/image/image_file.hpp"
#include "host/image/quarter_code.hpp"
#include "image_support.hpp"

namespace gridrt {
namespace {

using protocol::SectionKind;

const std::vector<std::byte>& bytes_of(const Image& image, SectionKind kind, int pe = 0) {
  static const std::vector<std::byte> none;
  const ImageSection* section = image.find(kind, pe);
  if (section == nullptr) ADD_FAILURE() << "no section " << protocol::name(kind);
  return section == nullptr ? none : section->bytes;
}

/// The lists of an image by voxel: owner, then (local id, quarters' code) in order.
struct DecodedCell {
  std::uint32_t pe = 0;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> references;
};

std::vector<DecodedCell> decode_cells(const Image& image) {
  const protocol::ImageHeader& h = image.header;
  const protocol::BlockCodec blocks(h);
  const protocol::CellCodec cells(h);
  const protocol::ReferenceCodec references(h);
  const protocol::TriangleCodec triangles(h);
  const VoxelGrid grid = image.grid();
  std::vector<DecodedCell> out(grid.cells());
  std::size_t block = 0;
  std::size_t records = 0;
  for (int z = 0; z < grid.count.z; z += 2) {
    for (int y = 0; y < grid.count.y; y += 2) {
      for (int x = 0; x < grid.count.x; x += 2, ++block) {
        const auto record = blocks.at(bytes_of(image, SectionKind::kBlocks), block);
        std::uint32_t cell = record.base;
        for (int bit = 0; bit < 8; ++bit) {
          if (((record.occupancy >> bit) & 1U) == 0) continue;
          const glm::ivec3 voxel{x + (bit & 1), y + ((bit >> 1) & 1), z + (bit >> 2)};
          const auto c = cells.at(bytes_of(image, SectionKind::kCells), cell++);
          ++records;
          DecodedCell& target = out.at(grid.index(voxel));
          target.pe = c.pe;
          for (std::uint32_t i = 0; i < c.count; ++i) {
            const int pe = static_cast<int>(c.pe);
            const auto r =
                references.at(bytes_of(image, SectionKind::kReferences, pe), c.first + i);
            const auto t = triangles.at(bytes_of(image, SectionKind::kTriangles, pe), r.triangle);
            target.references.emplace_back(t.id, r.quarters);
          }
        }
      }
    }
  }
  EXPECT_EQ(records, h.occupied_cells);
  return out;
}

std::vector<ImageOptions> many_options() {
  std::vector<ImageOptions> all;
  for (const auto layout : {protocol::Layout::kWide, protocol::Layout::kCompact}) {
    for (const int pes : {1, 2, 3, 4}) {
      for (const Mapping mapping : {Mapping::kBoxes, Mapping::kContiguous, Mapping::kVoxel}) {
        ImageOptions options;
        options.layout = layout;
        options.pes = pes;
        options.mapping = mapping;
        all.push_back(options);
        options.grid = glm::ivec3{5, 1, 6};
        all.push_back(options);
      }
    }
  }
  return all;
}

TEST(BuildImage, CellsHoldWhatTheGridGives) {
  const Scene scene = random_scene(150, 1);
  for (const ImageOptions& options : many_options()) {
    const Image image = must_build(scene, options);
    const auto decoded = decode_triangles(image);
    ASSERT_TRUE(decoded) << decoded.error().message;
    const VoxelGrid grid = image.grid();
    const VoxelLists lists = bin_triangles(grid, decoded->triangles);
    const auto owners = deal_voxels(grid, lists, options.mapping, options.pes);
    ASSERT_TRUE(owners);
    const std::vector<DecodedCell> cells = decode_cells(image);
    for (std::size_t c = 0; c < cells.size(); ++c) {
      ASSERT_EQ(cells[c].references.size(), lists.first[c + 1] - lists.first[c]);
      // For a board those that take most of the voxel first.
      std::vector<VoxelReference> list(
          lists.references.begin() + static_cast<std::ptrdiff_t>(lists.first[c]),
          lists.references.begin() + static_cast<std::ptrdiff_t>(lists.first[c + 1]));
      const bool ranked = options.layout == protocol::Layout::kCompact;
      std::ranges::sort(list, {}, [&](const VoxelReference& r) {
        return std::pair(ranked ? -std::popcount(cells_of(r.quarters)) : 0, r.triangle);
      });
      for (std::size_t i = 0; i < list.size(); ++i) {
        const VoxelReference& r = list[i];
        EXPECT_EQ(cells[c].references[i], std::pair(r.triangle, quarter_code(r.quarters)));
      }
      if (!cells[c].references.empty()) {
        EXPECT_EQ(cells[c].pe, (*owners)[c]);
      }
    }
  }
}

TEST(BuildImage, BlocksCountTheirCellsAndSkip) {
  Scene scene = random_scene(40, 3, 0.1F);
  add_triangle(scene, {9.0F, 9.0F, 9.0F}, {9.1F, 9.0F, 9.0F}, {9.0F, 9.1F, 9.0F});  // far off
  for (const ImageOptions& options : many_options()) {
    const Image image = must_build(scene, options);
    const auto decoded = decode_triangles(image);
    ASSERT_TRUE(decoded) << decoded.error().message;
    const VoxelGrid grid = image.grid();
    const auto occupancy = block_occupancy(grid, bin_triangles(grid, decoded->triangles));
    const auto jumps = skip_field(block_count(grid), occupancy);
    const protocol::BlockCodec codec(image.header);
    std::uint32_t base = 0;
    std::size_t empty = 0;
    for (std::size_t i = 0; i < occupancy.size(); ++i) {
      const auto record = codec.at(bytes_of(image, SectionKind::kBlocks), i);
      EXPECT_EQ(record.occupancy, occupancy[i]);
      EXPECT_EQ(record.base, occupancy[i] == 0 ? 0 : base);
      EXPECT_TRUE(std::equal(jumps[i].begin(), jumps[i].end(), record.jump.begin()));
      base += static_cast<std::uint32_t>(std::popcount(record.occupancy));
      if (occupancy[i] == 0) ++empty;
    }
    EXPECT_EQ(base, image.header.occupied_cells);
    if (!options.grid) {
      EXPECT_GT(empty, 0U);
    }
  }
}

TEST(BuildImage, TrianglesAreTheSnappedOnes) {
  const Scene scene = random_scene(150, 2);
  for (const ImageOptions& options : many_options()) {
    const Image image = must_build(scene, options);
    const auto decoded = decode_triangles(image);
    ASSERT_TRUE(decoded) << decoded.error().message;
    const auto lattice = make_lattice(scene.positions, scene.triangles, options.bits);
    ASSERT_TRUE(lattice);
    EXPECT_EQ(image.lattice().lo, lattice->lo);
    EXPECT_EQ(image.lattice().hi, lattice->hi);
    EXPECT_EQ(image.lattice().scale, lattice->scale);
    EXPECT_EQ(image.lattice().max_q, lattice->max_q);
    std::size_t local = 0;
    for (std::size_t i = 0; i < scene.triangles.size(); ++i) {
      LatticeTriangle t{};
      for (std::size_t c = 0; c < 3; ++c) {
        t.v[c] = snap(*lattice, scene.positions[scene.triangles[i][c]]);
      }
      if (is_degenerate(t)) continue;
      ASSERT_LT(local, decoded->triangles.size());
      EXPECT_EQ(decoded->global_ids[local], i);
      EXPECT_EQ(decoded->triangles[local].v, t.v);
      ++local;
    }
    EXPECT_EQ(local, decoded->triangles.size());
    EXPECT_EQ(image.header.triangles, scene.triangles.size());
    EXPECT_EQ(image.header.degenerate, scene.triangles.size() - local);
    EXPECT_GE(image.header.degenerate, scene.triangles.size() / 7);
  }
}

TEST(BuildImage, EveryPeHoldsOnlyAndAllThatItNeeds) {
  const Scene scene = sheet_scene(12, 9);
  for (const ImageOptions& options : many_options()) {
    const Image image = must_build(scene, options);
    const std::vector<DecodedCell> cells = decode_cells(image);
    const std::vector<ImageCounts> counts = count_image(image);
    for (int pe = 0; pe < options.pes; ++pe) {
      std::set<std::uint32_t> used;
      std::uint64_t references = 0;
      for (const DecodedCell& cell : cells) {
        if (cell.references.empty() || cell.pe != static_cast<std::uint32_t>(pe)) continue;
        references += cell.references.size();
        for (const auto& [id, mask] : cell.references) used.insert(id);
      }
      const protocol::TriangleCodec codec(image.header);
      const auto& triangles = bytes_of(image, SectionKind::kTriangles, pe);
      std::vector<std::uint32_t> ids;
      std::set<std::uint32_t> vertices;
      for (std::size_t i = 0; i < triangles.size() / codec.stride(); ++i) {
        const auto record = codec.at(triangles, i);
        ids.push_back(record.id);
        vertices.insert(record.vertex.begin(), record.vertex.end());
      }
      EXPECT_TRUE(std::is_sorted(ids.begin(), ids.end()));
      EXPECT_TRUE(std::equal(ids.begin(), ids.end(), used.begin(), used.end()));
      // Vertices: each used, none twice.
      const protocol::VertexCodec vertex_codec(image.header);
      const auto& raw = bytes_of(image, SectionKind::kVertices, pe);
      std::set<std::array<std::uint32_t, 3>> places;
      for (std::size_t i = 0; i < raw.size() / vertex_codec.stride(); ++i) {
        places.insert(vertex_codec.at(raw, i).q);
      }
      EXPECT_EQ(places.size(), raw.size() / vertex_codec.stride());
      EXPECT_EQ(vertices.size(), places.size());
      const auto& count = counts[static_cast<std::size_t>(pe)];
      EXPECT_EQ(count.triangles, ids.size());
      EXPECT_EQ(count.vertices, places.size());
      EXPECT_EQ(count.references, references);
    }
    EXPECT_EQ(counts.back().triangles - counts.back().copies, image.header.local_ids);
    EXPECT_EQ(counts.back().cells, image.header.occupied_cells);
  }
}

TEST(BuildImage, SharedVerticesAreStoredOnce) {
  // The same sheet with vertices of its own for every triangle gives the same sections.
  const Scene shared = sheet_scene(8, 8);
  Scene apart;
  apart.materials.emplace_back();
  for (const auto& t : shared.triangles) {
    add_triangle(apart, shared.positions[t[0]], shared.positions[t[1]], shared.positions[t[2]]);
  }
  ImageOptions options;
  options.with_scene = false;
  EXPECT_EQ(serialize_image(must_build(shared, options)),
            serialize_image(must_build(apart, options)));
}

TEST(BuildImage, IsDeterministic) {
  const Scene scene = random_scene(300, 4);
  for (const ImageOptions& options : many_options()) {
    EXPECT_EQ(serialize_image(must_build(scene, options)),
              serialize_image(must_build(scene, options)));
  }
}

TEST(BuildImage, NoTriangleOrOnlyDegenerateOnes) {
  Scene scene;
  scene.materials.emplace_back();
  for (int round = 0; round < 2; ++round) {
    for (const auto layout : {protocol::Layout::kWide, protocol::Layout::kCompact}) {
      ImageOptions options;
      options.layout = layout;
      const Image image = must_build(scene, options);
      EXPECT_EQ(image.header.local_ids, 0U);
      EXPECT_EQ(image.header.occupied_cells, 0U);
      EXPECT_EQ(image.header.triangles, scene.triangles.size());
      const auto decoded = decode_triangles(image);
      ASSERT_TRUE(decoded) << decoded.error().message;
      EXPECT_TRUE(decoded->triangles.empty());
      const auto again = parse_image(serialize_image(image), "empty");
      ASSERT_TRUE(again) << again.error().message;
      EXPECT_TRUE(verify_image(*again)) << verify_image(*again).error().message;
      EXPECT_FALSE(describe_image(image).empty());
    }
    add_triangle(scene, {1, 2, 3}, {1, 2, 3}, {4, 5, 6});
  }
}

TEST(BuildImage, OneFlatTriangle) {
  Scene scene;
  scene.materials.emplace_back();
  add_triangle(scene, {0, 0, 7}, {1, 0, 7}, {0, 1, 7});
  const Image image = must_build(scene);
  EXPECT_EQ(image.header.local_ids, 1U);
  EXPECT_TRUE(verify_image(image));
}

TEST(BuildImage, MistakesHaveClearErrors) {
  const Scene good = random_scene(10, 5);
  const auto error_of = [](const Scene& scene, const ImageOptions& options) {
    const auto image = build_image(scene, options);
    EXPECT_FALSE(image);
    return image ? Error{} : image.error();
  };
  ImageOptions options;
  options.pes = 65;
  EXPECT_EQ(error_of(good, options).kind, ErrorKind::kUsage);
  options.pes = 0;
  EXPECT_EQ(error_of(good, options).kind, ErrorKind::kUsage);
  options = {};
  options.bits = 25;
  EXPECT_EQ(error_of(good, options).kind, ErrorKind::kUsage);
  options = {};
  options.grid = glm::ivec3{0, 4, 4};
  EXPECT_EQ(error_of(good, options).kind, ErrorKind::kUsage);
  options.grid = glm::ivec3{100000, 1, 1};
  EXPECT_EQ(error_of(good, options).kind, ErrorKind::kLimit);
  Scene broken = good;
  broken.triangles[4][1] = 99;
  EXPECT_EQ(error_of(broken, {}).kind, ErrorKind::kInput);
  broken = good;
  broken.positions[7].y = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(error_of(broken, {}).kind, ErrorKind::kInput);
  broken = good;
  broken.triangle_materials[3] = 1;
  EXPECT_NE(error_of(broken, {}).message.find("triangle 3"), std::string::npos);
}

}  // namespace
}  // namespace gridrt
