// The deep check of an image: builds it again from its own triangles and compares.
#include <algorithm>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "host/image/blocks.hpp"
#include "host/image/image_file.hpp"
#include "host/image/pack.hpp"
#include "host/image/quarter_code.hpp"
#include "host/image/triangles.hpp"
#include "host/image/weld.hpp"

namespace gridrt {
namespace {

using protocol::SectionKind;

std::unexpected<Error> bad(std::string message) {
  return fail(ErrorKind::kInput, std::move(message), "write the file again with gridrt-image");
}

std::string text(const protocol::BlockRecord& r) {
  return fmt::format("jumps {}, occupancy {:#04x}, base {}", fmt::join(r.jump, " "), r.occupancy,
                     r.base);
}
std::string text(const protocol::CellRecord& r) {
  return fmt::format("first {}, count {}, PE {}", r.first, r.count, r.pe);
}
std::string text(const protocol::ReferenceRecord& r) {
  return fmt::format("triangle {}, quarters {:#05x}", r.triangle, quarters_of_code(r.quarters));
}
std::string text(const protocol::TriangleRecord& r) {
  return fmt::format("vertices {}, id {}", fmt::join(r.vertex, " "), r.id);
}
std::string text(const protocol::VertexRecord& r) {
  return fmt::format("coordinates {}", fmt::join(r.q, " "));
}

/// How the record that holds byte `offset` differs.
template <class Codec>
std::string difference(const protocol::ImageHeader& header, const ImageSection& found,
                       const ImageSection& expected, std::size_t offset) {
  const Codec codec(header);
  const std::size_t index = offset / codec.stride();
  const auto is = codec.at(found.bytes, index);
  const auto should = codec.at(expected.bytes, index);
  const std::string place =
      fmt::format("{}: record {} at offset {}", section_name(found.kind, found.pe), index,
                  index * codec.stride());
  if (is == should) return place + " has padding bits that are not zero";
  return fmt::format("{} says {}, but the triangles give {}", place, text(is), text(should));
}

Result<void> compare(const protocol::ImageHeader& header, const ImageSection& found,
                     const ImageSection& expected) {
  const std::string name = section_name(found.kind, found.pe);
  if (found.bytes.size() != expected.bytes.size()) {
    return bad(fmt::format("{}: {} bytes, but the triangles give {}", name, found.bytes.size(),
                           expected.bytes.size()));
  }
  const auto [at, end] = std::ranges::mismatch(found.bytes, expected.bytes);
  if (at == found.bytes.end()) return {};
  const auto offset = static_cast<std::size_t>(at - found.bytes.begin());
  switch (found.kind) {
    case SectionKind::kBlocks:
      return bad(difference<protocol::BlockCodec>(header, found, expected, offset));
    case SectionKind::kCells:
      return bad(difference<protocol::CellCodec>(header, found, expected, offset));
    case SectionKind::kReferences:
      return bad(difference<protocol::ReferenceCodec>(header, found, expected, offset));
    case SectionKind::kTriangles:
      return bad(difference<protocol::TriangleCodec>(header, found, expected, offset));
    case SectionKind::kVertices:
      return bad(difference<protocol::VertexCodec>(header, found, expected, offset));
    default:
      return bad(fmt::format("{}: byte {} is wrong", name, offset));
  }
}

/// The header's lattice is the one that its bounds and bits give.
Result<Lattice> check_lattice(const Image& image) {
  const Lattice lattice = image.lattice();
  if (image.header.triangles == 0) {
    auto unit = make_lattice({}, {}, lattice.bits);
    if (!unit) return bad("header: " + unit.error().message);
    return unit;
  }
  const std::array<glm::vec3, 2> bounds{lattice.lo, lattice.hi};
  const std::array<std::array<std::uint32_t, 3>, 1> triangle{{{0, 1, 0}}};
  auto expected = make_lattice(bounds, triangle, lattice.bits);
  if (!expected) return bad("header: " + expected.error().message);
  return expected;
}

/// The header's grid is the one that make_grid gives for its counts; the Blocks section bounds it,
/// so that no memory is taken for a grid that is not there.
Result<VoxelGrid> check_grid(const Image& image, const Lattice& lattice) {
  const VoxelGrid grid = image.grid();
  for (int a = 0; a < 3; ++a) {
    if (grid.count[a] < 1 || grid.count[a] > lattice.box()[a]) {
      return bad(fmt::format("header: a grid of {} voxels along axis {}", grid.count[a], a));
    }
  }
  auto expected = make_grid(lattice, 0, grid.count);
  if (!expected) return bad("header: " + expected.error().message);
  const protocol::BlockCodec codec(image.header);
  const auto blocks = find_records(image, SectionKind::kBlocks, 0, codec.stride());
  if (!blocks) return std::unexpected(blocks.error());
  const std::size_t count = (*blocks)->bytes.size() / codec.stride();
  if (count != block_total(*expected)) {
    return bad(fmt::format("section Blocks: {} blocks, but the grid has {}", count,
                           block_total(*expected)));
  }
  return expected;
}

Result<LocalTriangles> decode_local(const Image& image) {
  auto decoded = decode_triangles(image);
  if (!decoded) return std::unexpected(std::move(decoded.error()));
  LocalTriangles local;
  local.triangles = std::move(decoded->triangles);
  local.global_ids = std::move(decoded->global_ids);
  local.scene_triangles = image.header.triangles;
  std::vector<glm::ivec3> points;
  points.reserve(3 * local.triangles.size());
  for (std::size_t id = 0; id < local.triangles.size(); ++id) {
    if (is_degenerate(local.triangles[id])) {
      return bad(fmt::format("the triangle with local id {} is degenerate", id));
    }
    points.insert(points.end(), local.triangles[id].v.begin(), local.triangles[id].v.end());
  }
  WeldedPoints welded = weld(points);
  local.vertices = std::move(welded.points);
  local.corners.resize(local.triangles.size());
  for (std::size_t i = 0; i < welded.index.size(); ++i) {
    local.corners[i / 3][i % 3] = welded.index[i];
  }
  return local;
}

/// The owners that the cells name, where nothing else tells them; what cannot be right is left for
/// the comparison to find.
Result<std::vector<std::uint8_t>> stored_owners(const Image& image, const VoxelGrid& grid,
                                                const VoxelLists& lists) {
  const protocol::CellCodec codec(image.header);
  const auto cells = find_records(image, SectionKind::kCells, 0, codec.stride());
  if (!cells) return std::unexpected(cells.error());
  const std::vector<std::uint8_t> occupancy = block_occupancy(grid, lists);
  const std::size_t count = (*cells)->bytes.size() / codec.stride();
  const glm::ivec3 blocks = block_count(grid);
  std::vector<std::uint8_t> owners(grid.cells(), 0);
  std::size_t next = 0;
  std::size_t index = 0;
  for (int z = 0; z < blocks.z; ++z) {
    for (int y = 0; y < blocks.y; ++y) {
      for (int x = 0; x < blocks.x; ++x, ++index) {
        for (int bit = 0; bit < 8; ++bit) {
          if (((occupancy[index] >> bit) & 1) == 0) continue;
          if (next == count) return bad("section Cells: it ends too early");
          const std::uint32_t pe = codec.at((*cells)->bytes, next++).pe;
          if (pe >= image.header.pes) {
            return bad(fmt::format("section Cells: cell {} belongs to PE {}", next - 1, pe));
          }
          owners[grid.index(block_voxel({x, y, z}, bit))] = static_cast<std::uint8_t>(pe);
        }
      }
    }
  }
  return owners;
}

/// The image that build_image would have written for these triangles.
Result<Image> rebuild(const Image& image, const LocalTriangles& local, const Lattice& lattice,
                      const VoxelGrid& grid) {
  Cut cut;
  cut.lattice = lattice;
  cut.grid = grid;
  cut.mapping = static_cast<Mapping>(image.header.mapping);
  cut.pes = image.header.pes;
  cut.layout = static_cast<protocol::Layout>(image.header.layout);
  if (mapping_name(cut.mapping) == "?") {
    return bad(fmt::format("header: mapping {} is not known", image.header.mapping));
  }
  cut.lists = bin_triangles(grid, local.triangles);
  auto owners = cut.mapping == Mapping::kMeasured
                    ? stored_owners(image, grid, cut.lists)
                    : deal_voxels(grid, cut.lists, cut.mapping, cut.pes);
  if (!owners) return bad("header: " + owners.error().message);
  cut.owners = std::move(*owners);
  return pack_image(local, cut);
}

/// The scene's triangles, snapped, are those of the PEs.
Result<void> check_scene(const Image& image, const Lattice& lattice, const LocalTriangles& local) {
  const auto scene = decode_scene(image);
  if (!scene) return std::unexpected(scene.error());
  const auto own = make_lattice(scene->positions, scene->triangles, image.header.bits);
  if (!own) return bad("section Scene: " + own.error().message);
  if (own->lo != lattice.lo || own->hi != lattice.hi) {
    return bad("section Scene: its bounds are not those of the header");
  }
  const std::vector<glm::ivec3> snapped = snap_all(lattice, scene->positions);
  std::size_t id = 0;
  for (std::size_t i = 0; i < scene->triangles.size(); ++i) {
    LatticeTriangle triangle{};
    for (std::size_t c = 0; c < 3; ++c) triangle.v[c] = snapped[scene->triangles[i][c]];
    if (is_degenerate(triangle)) continue;
    const bool same = id < local.global_ids.size() && local.global_ids[id] == i &&
                      local.triangles[id].v == triangle.v;
    if (!same) return bad(fmt::format("section Scene: triangle {} is not that of the PEs", i));
    ++id;
  }
  if (id != local.global_ids.size()) {
    return bad(fmt::format("section Scene: {} triangles, but the PEs hold {}", id,
                           local.global_ids.size()));
  }
  return {};
}

/// Compares header and sections with the rebuilt ones.
Result<void> compare_images(const Image& image, const Image& expected) {
  protocol::ImageHeader header = expected.header;
  header.sections = image.header.sections;
  if (header != image.header) {
    std::array<std::byte, protocol::ImageHeader::kBytes> found{};
    std::array<std::byte, protocol::ImageHeader::kBytes> should{};
    store(image.header, found);
    store(header, should);
    const auto at = std::ranges::mismatch(found, should).in1 - found.begin();
    return bad(fmt::format("header: the field at offset {} is not what the triangles give", at));
  }
  const bool with_scene = image.find(SectionKind::kScene) != nullptr;
  if (image.sections.size() != expected.sections.size() + (with_scene ? 1 : 0) ||
      image.header.sections != image.sections.size()) {
    return bad(fmt::format("header: {} sections, but {} are expected", image.header.sections,
                           expected.sections.size()));
  }
  for (std::size_t i = 0; i < expected.sections.size(); ++i) {
    const ImageSection& found = image.sections[i];
    if (found.kind != expected.sections[i].kind || found.pe != expected.sections[i].pe) {
      return bad(fmt::format("directory: {} stands where {} is expected",
                             section_name(found.kind, found.pe),
                             section_name(expected.sections[i].kind, expected.sections[i].pe)));
    }
    if (auto same = compare(image.header, found, expected.sections[i]); !same) return same;
  }
  return {};
}

}  // namespace

Result<void> verify_image(const Image& image) {
  const auto lattice = check_lattice(image);
  if (!lattice) return std::unexpected(lattice.error());
  const auto grid = check_grid(image, *lattice);
  if (!grid) return std::unexpected(grid.error());
  const auto local = decode_local(image);
  if (!local) return std::unexpected(local.error());
  const auto expected = rebuild(image, *local, *lattice, *grid);
  if (!expected) return std::unexpected(expected.error());
  if (auto same = compare_images(image, *expected); !same) return same;
  if (image.find(SectionKind::kScene) == nullptr) return {};
  return check_scene(image, *lattice, *local);
}

}  // namespace gridrt
