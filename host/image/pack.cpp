#include "host/image/pack.hpp"

#include <algorithm>
#include <bit>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "host/grid/quarters.hpp"
#include "host/image/blocks.hpp"
#include "host/image/limits.hpp"
#include "host/image/quarter_code.hpp"

namespace gridrt {
namespace {

using protocol::SectionKind;

constexpr std::uint32_t kNone = 0xFFFFFFFFU;

/// Records of one kind, one after the other.
template <class Codec>
class RecordWriter {
 public:
  RecordWriter(const protocol::ImageHeader& header, std::size_t count)
      : codec_(header), bytes_(count * codec_.stride()) {}

  template <class Record>
  void add(const Record& record) {
    good_ = good_ && codec_.pack(record, std::span(bytes_).subspan(at_));
    at_ += codec_.stride();
  }
  [[nodiscard]] bool good() const { return good_ && at_ == bytes_.size(); }
  std::vector<std::byte> take() { return std::move(bytes_); }

 private:
  Codec codec_;
  std::vector<std::byte> bytes_;
  std::size_t at_ = 0;
  bool good_ = true;
};

protocol::ImageHeader make_header(const LocalTriangles& local, const Cut& cut,
                                  std::uint64_t cells) {
  protocol::ImageHeader h;
  h.magic = protocol::kImageMagic;
  h.version = static_cast<std::uint16_t>(protocol::kImageVersion);
  h.layout = static_cast<std::uint8_t>(cut.layout);
  h.pes = static_cast<std::uint8_t>(cut.pes);
  h.bits = static_cast<std::uint8_t>(cut.lattice.bits);
  h.mapping = static_cast<std::uint8_t>(cut.mapping);
  h.chunks = 1;
  for (int a = 0; a < 3; ++a) {
    const auto i = static_cast<std::size_t>(a);
    h.lo[i] = cut.lattice.lo[a];
    h.hi[i] = cut.lattice.hi[a];
    h.scale[i] = cut.lattice.scale[a];
    h.max_q[i] = cut.lattice.max_q[a];
    h.grid_count[i] = cut.grid.count[a];
    h.grid_edge[i] = cut.grid.edge[a];
  }
  h.margin = static_cast<std::uint32_t>(cut.grid.margin);
  h.triangles = local.scene_triangles;
  h.local_ids = static_cast<std::uint32_t>(local.triangles.size());
  h.degenerate = h.triangles - h.local_ids;
  const protocol::LayoutLimits limits = protocol::layout_limits(cut.layout);
  h.coordinate_bits = static_cast<std::uint8_t>(limits.coordinate_bits);
  h.vertex_index_bits = static_cast<std::uint8_t>(limits.vertex_index_bits);
  h.triangle_index_bits = static_cast<std::uint8_t>(limits.triangle_index_bits);
  h.id_bits = static_cast<std::uint8_t>(limits.id_bits);
  h.base_bits = static_cast<std::uint8_t>(limits.base_bits);
  h.first_bits = static_cast<std::uint8_t>(limits.first_bits);
  h.list_bits = static_cast<std::uint8_t>(limits.list_bits);
  h.pe_bits = static_cast<std::uint8_t>(limits.pe_bits);
  h.occupied_cells = static_cast<std::uint32_t>(cells);
  return h;
}

/// Calls visit(cell index) for every voxel with references, in block order, then bit order.
template <class Visit>
void for_each_cell(const VoxelGrid& grid, std::span<const std::uint8_t> occupancy, Visit&& visit) {
  const glm::ivec3 blocks = block_count(grid);
  std::size_t index = 0;
  for (int z = 0; z < blocks.z; ++z) {
    for (int y = 0; y < blocks.y; ++y) {
      for (int x = 0; x < blocks.x; ++x, ++index) {
        if (occupancy[index] == 0) continue;
        for (int bit = 0; bit < 8; ++bit) {
          if (((occupancy[index] >> bit) & 1) == 0) continue;
          visit(grid.index(block_voxel({x, y, z}, bit)));
        }
      }
    }
  }
}

/// The memory of one PE before packing.
struct PeMemory {
  std::vector<std::size_t> cells;  ///< its voxels with references, in order
  std::uint64_t references = 0;
  std::vector<std::uint32_t> triangles;  ///< local ids, ascending
  std::vector<std::uint32_t> vertices;   ///< indices into LocalTriangles::vertices
};

/// Finds out what each PE holds; keeps scratch space between PEs.
class Collector {
 public:
  Collector(const LocalTriangles& local, const Cut& cut)
      : local_(local),
        cut_(cut),
        used_(local.triangles.size(), 0),
        triangle_index_(local.triangles.size(), kNone),
        vertex_index_(local.vertices.size(), kNone) {}

  /// Lists the PE's triangles, ascending, and their vertices by first use.
  void collect(PeMemory& pe) {
    for (const std::size_t cell : pe.cells) {
      for (const VoxelReference& r : list(cell)) used_[r.triangle] = 1;
    }
    for (std::uint32_t t = 0; t < used_.size(); ++t) {
      if (used_[t] == 0) continue;
      used_[t] = 0;
      pe.triangles.push_back(t);
      for (const std::uint32_t v : local_.corners[t]) {
        if (vertex_index_[v] != kNone) continue;
        vertex_index_[v] = static_cast<std::uint32_t>(pe.vertices.size());
        pe.vertices.push_back(v);
      }
    }
    for (const std::uint32_t v : pe.vertices) vertex_index_[v] = kNone;
  }

  /// Packs the PE's three sections into the image.
  Result<void> pack(const PeMemory& pe, int number, Image& image) {
    RecordWriter<protocol::VertexCodec> vertices(image.header, pe.vertices.size());
    for (std::size_t i = 0; i < pe.vertices.size(); ++i) {
      vertex_index_[pe.vertices[i]] = static_cast<std::uint32_t>(i);
      const glm::uvec3 q{local_.vertices[pe.vertices[i]]};
      vertices.add(protocol::VertexRecord{.q = {q.x, q.y, q.z}});
    }
    RecordWriter<protocol::TriangleCodec> triangles(image.header, pe.triangles.size());
    for (std::size_t i = 0; i < pe.triangles.size(); ++i) {
      const std::uint32_t id = pe.triangles[i];
      triangle_index_[id] = static_cast<std::uint32_t>(i);
      protocol::TriangleRecord record{.vertex = {}, .id = id};
      for (std::size_t c = 0; c < 3; ++c) record.vertex[c] = vertex_index_[local_.corners[id][c]];
      triangles.add(record);
    }
    RecordWriter<protocol::ReferenceCodec> references(image.header, pe.references);
    for (const std::size_t cell : pe.cells) {
      for (const VoxelReference& r : in_order(list(cell))) {
        references.add(
            protocol::ReferenceRecord{triangle_index_[r.triangle], quarter_code(r.quarters)});
      }
    }
    for (const std::uint32_t v : pe.vertices) vertex_index_[v] = kNone;
    if (!vertices.good() || !triangles.good() || !references.good()) {
      return fail(ErrorKind::kInternal, fmt::format("records of PE {} do not fit", number));
    }
    Result<void> done = add_section(image, SectionKind::kReferences, number, references.take());
    if (done) done = add_section(image, SectionKind::kTriangles, number, triangles.take());
    if (done) done = add_section(image, SectionKind::kVertices, number, vertices.take());
    return done;
  }

 private:
  /// For a board those that take most of the voxel first: rays pass them by the least, and while
  /// they are tested a PE reads the others.
  std::span<const VoxelReference> in_order(std::span<const VoxelReference> list) {
    if (cut_.layout != protocol::Layout::kCompact) return list;
    sorted_.assign(list.begin(), list.end());
    std::ranges::sort(sorted_, {}, [](const VoxelReference& r) {
      return std::pair(-std::popcount(cells_of(r.quarters)), r.triangle);
    });
    return sorted_;
  }

  [[nodiscard]] std::span<const VoxelReference> list(std::size_t cell) const {
    return std::span(cut_.lists.references)
        .subspan(cut_.lists.first[cell], cut_.lists.first[cell + 1] - cut_.lists.first[cell]);
  }

  const LocalTriangles& local_;
  const Cut& cut_;
  std::vector<std::uint8_t> used_;
  std::vector<std::uint32_t> triangle_index_;  // in the PE at hand, by local id
  std::vector<VoxelReference> sorted_;         // a list of the board
  std::vector<std::uint32_t> vertex_index_;    // in the PE at hand, by vertex
};

/// Blocks and Cells.
Result<void> pack_traversal(const Cut& cut, std::span<const std::uint8_t> occupancy, Image& image) {
  const std::vector<Jumps> jumps = skip_field(block_count(cut.grid), occupancy);
  RecordWriter<protocol::BlockCodec> blocks(image.header, occupancy.size());
  std::uint32_t base = 0;
  for (std::size_t i = 0; i < occupancy.size(); ++i) {
    protocol::BlockRecord record;
    std::ranges::copy(jumps[i], record.jump.begin());
    record.occupancy = occupancy[i];
    record.base = occupancy[i] == 0 ? 0 : base;
    base += static_cast<std::uint32_t>(std::popcount(occupancy[i]));
    blocks.add(record);
  }
  RecordWriter<protocol::CellCodec> cells(image.header, image.header.occupied_cells);
  std::vector<std::uint32_t> next(static_cast<std::size_t>(cut.pes), 0);
  for_each_cell(cut.grid, occupancy, [&](std::size_t cell) {
    const auto count =
        static_cast<std::uint32_t>(cut.lists.first[cell + 1] - cut.lists.first[cell]);
    const std::uint8_t pe = cut.owners[cell];
    cells.add(protocol::CellRecord{next[pe], count, pe});
    next[pe] += count;
  });
  if (!blocks.good() || !cells.good()) {
    return fail(ErrorKind::kInternal, "records of the traversal section do not fit");
  }
  Result<void> done = add_section(image, SectionKind::kBlocks, 0, blocks.take());
  if (done) done = add_section(image, SectionKind::kCells, 0, cells.take());
  return done;
}

std::vector<std::byte> pack_ids(std::span<const std::uint32_t> ids) {
  std::vector<std::byte> bytes(ids.size() * 4);
  for (std::size_t i = 0; i < ids.size(); ++i) {
    protocol::detail::put32(bytes.data() + 4 * i, ids[i]);
  }
  return bytes;
}

}  // namespace

Result<void> add_section(Image& image, protocol::SectionKind kind, int pe,
                         std::vector<std::byte> bytes) {
  if (bytes.size() > std::numeric_limits<std::uint32_t>::max()) {
    return fail(ErrorKind::kLimit,
                fmt::format("section {} of PE {} takes {} bytes, more than 4 GiB",
                            protocol::name(kind), pe, bytes.size()),
                "use more --pes, or a coarser --grid");
  }
  image.sections.push_back({kind, static_cast<std::uint8_t>(pe), std::move(bytes)});
  image.header.sections = static_cast<std::uint16_t>(image.sections.size());
  return {};
}

Result<Image> pack_image(const LocalTriangles& local, const Cut& cut) {
  const std::vector<std::uint8_t> occupancy = block_occupancy(cut.grid, cut.lists);
  std::vector<PeMemory> pes(static_cast<std::size_t>(cut.pes));
  ImageUse use;
  use.local_ids = local.triangles.size();
  use.blocks = occupancy.size();
  for_each_cell(cut.grid, occupancy, [&](std::size_t cell) {
    PeMemory& pe = pes[cut.owners[cell]];
    const std::uint64_t count = cut.lists.first[cell + 1] - cut.lists.first[cell];
    pe.cells.push_back(cell);
    pe.references += count;
    ++use.cells;
    use.longest_list = std::max(use.longest_list, count);
  });
  Collector collector(local, cut);
  for (PeMemory& pe : pes) {
    collector.collect(pe);
    use.pes.push_back({pe.triangles.size(), pe.vertices.size(), pe.references});
  }
  if (auto good = check_limits(cut.layout, cut.memory, use); !good) {
    return std::unexpected(std::move(good.error()));
  }
  Image image;
  image.header = make_header(local, cut, use.cells);
  Result<void> done = pack_traversal(cut, occupancy, image);
  for (std::size_t p = 0; p < pes.size() && done; ++p) {
    done = collector.pack(pes[p], static_cast<int>(p), image);
    pes[p] = {};
  }
  if (done) done = add_section(image, SectionKind::kIds, 0, pack_ids(local.global_ids));
  if (!done) return std::unexpected(std::move(done.error()));
  return image;
}

}  // namespace gridrt
