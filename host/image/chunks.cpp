#include "host/image/chunks.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "host/image/blocks.hpp"
#include "host/image/lattice_scene.hpp"

namespace gridrt {
namespace {

constexpr std::size_t kMostChunks = std::numeric_limits<std::uint16_t>::max();
constexpr std::uint32_t kNone = 0xFFFFFFFFU;

/// What a chunk holds: the references of a box of voxels or, of a single voxel, the part
/// [first, last) of its list.
struct Part {
  VoxelBox box;
  std::uint64_t first = 0;
  std::uint64_t last = std::numeric_limits<std::uint64_t>::max();
};

class Chunker {
 public:
  Chunker(const LatticeScene& scene, const VoxelGrid& grid)
      : local_(scene.local),
        cut_(scene.cut),
        lists_(bin_triangles(grid, scene.local.triangles, scene.cut.threads)),
        triangle_index_(scene.local.triangles.size(), kNone),
        vertex_index_(scene.local.vertices.size(), kNone) {
    cut_.grid = grid;
    if (cut_.mapping == Mapping::kMeasured) cut_.mapping = Mapping::kBoxes;
  }

  Result<std::vector<Chunk>> run() {
    if (auto done = cut(Part{.box = {glm::ivec3{0}, cut_.grid.count}}); !done) {
      return std::unexpected(std::move(done.error()));
    }
    for (std::size_t i = 0; i < chunks_.size(); ++i) {
      protocol::ImageHeader& header = chunks_[i].image.header;
      header.chunk = static_cast<std::uint16_t>(i);
      header.chunks = static_cast<std::uint16_t>(chunks_.size());
    }
    return std::move(chunks_);
  }

 private:
  /// The triangles and lists of one part, numbered anew.
  struct Extract {
    LocalTriangles local;
    VoxelLists lists;
    VoxelBox used;  ///< the voxels with references
    std::uint64_t cells = 0;
  };

  Result<void> cut(Part part);
  Result<void> divide(const Part& part, std::uint64_t pieces, Error why);
  [[nodiscard]] Extract extract(const Part& part);
  void take(const VoxelReference& reference, Extract& out);
  [[nodiscard]] std::uint64_t pieces_needed(const Extract& extract) const;
  Result<Image> pack(const Extract& extract) const;

  const LocalTriangles& local_;
  Cut cut_;  ///< lacks lists and owners
  VoxelLists lists_;
  std::vector<Chunk> chunks_;
  std::vector<std::uint32_t> triangle_index_;  ///< in the part at hand, by local id
  std::vector<std::uint32_t> vertex_index_;    ///< in the part at hand, by vertex
};

/// Calls visit(voxel, index) for the voxels of a box, x fastest.
template <class Visit>
void for_each_voxel(const VoxelGrid& grid, const VoxelBox& box, const Visit& visit) {
  for (int z = box.lo.z; z < box.hi.z; ++z) {
    for (int y = box.lo.y; y < box.hi.y; ++y) {
      for (int x = box.lo.x; x < box.hi.x; ++x) {
        const glm::ivec3 voxel{x, y, z};
        visit(voxel, grid.index(voxel));
      }
    }
  }
}

Chunker::Extract Chunker::extract(const Part& part) {
  Extract out;
  out.used = {cut_.grid.count, glm::ivec3{0}};
  out.lists.first.assign(cut_.grid.cells() + 1, 0);
  std::vector<std::uint32_t>& ids = out.local.global_ids;  // local ids of the scene, for now
  const auto list = [&](std::size_t cell) {
    const std::uint64_t first = lists_.first[cell];
    const std::uint64_t count = lists_.first[cell + 1] - first;
    const std::uint64_t begin = std::min(part.first, count);
    return std::span(lists_.references).subspan(first + begin, std::min(part.last, count) - begin);
  };
  for_each_voxel(cut_.grid, part.box, [&](const glm::ivec3& voxel, std::size_t cell) {
    const auto references = list(cell);
    if (references.empty()) return;
    ++out.cells;
    for (int a = 0; a < 3; ++a) {
      out.used.lo[a] = std::min(out.used.lo[a], voxel[a]);
      out.used.hi[a] = std::max(out.used.hi[a], voxel[a] + 1);
    }
    out.lists.first[cell + 1] = references.size();
    for (const VoxelReference& r : references) {
      if (triangle_index_[r.triangle] != kNone) continue;
      triangle_index_[r.triangle] = 0;
      ids.push_back(r.triangle);
    }
  });
  std::ranges::sort(ids);
  for (std::size_t i = 0; i < ids.size(); ++i) {
    triangle_index_[ids[i]] = static_cast<std::uint32_t>(i);
    std::array<std::uint32_t, 3> corners = local_.corners[ids[i]];
    for (std::uint32_t& corner : corners) {
      std::uint32_t& index = vertex_index_[corner];
      if (index == kNone) {
        index = static_cast<std::uint32_t>(out.local.vertices.size());
        out.local.vertices.push_back(local_.vertices[corner]);
      }
      corner = index;
    }
    out.local.corners.push_back(corners);
    out.local.triangles.push_back(local_.triangles[ids[i]]);
  }
  for_each_voxel(cut_.grid, part.box, [&](const glm::ivec3&, std::size_t cell) {
    for (const VoxelReference& r : list(cell)) {
      out.lists.references.push_back({triangle_index_[r.triangle], r.quarters});
    }
  });
  for (std::size_t i = 0; i < cut_.grid.cells(); ++i) {
    out.lists.first[i + 1] += out.lists.first[i];
  }
  for (std::uint32_t& id : ids) {
    triangle_index_[id] = kNone;
    for (const std::uint32_t corner : local_.corners[id]) vertex_index_[corner] = kNone;
    id = local_.global_ids[id];
  }
  out.local.scene_triangles = local_.scene_triangles;
  return out;
}

std::uint64_t Chunker::pieces_needed(const Extract& extract) const {
  const MemorySizes& m = cut_.memory;
  const auto pes = static_cast<std::uint64_t>(cut_.pes);
  const auto pieces = [](std::uint64_t need, std::uint64_t room) {
    return room == 0 ? std::max<std::uint64_t>(need, 1) : (need + room - 1) / room;
  };
  return std::max({pieces(extract.lists.references.size(), pes * m.references),
                   pieces(extract.local.triangles.size(), pes * m.triangles),
                   pieces(extract.local.vertices.size(), pes * m.vertices),
                   pieces(extract.cells, m.cells)});
}

Result<Image> Chunker::pack(const Extract& extract) const {
  Cut cut = cut_;
  cut.lists = extract.lists;
  auto owners = deal_voxels(cut.grid, cut.lists, cut.mapping, cut.pes);
  if (!owners) return std::unexpected(std::move(owners.error()));
  cut.owners = std::move(*owners);
  return pack_image(extract.local, cut);
}

/// Packs a part, or divides it until each piece fits.
Result<void> Chunker::cut(Part part) {
  const Extract held = extract(part);
  if (held.cells == 0) return {};
  part.box = held.used;
  const std::uint64_t pieces = pieces_needed(held);
  Error too_large{ErrorKind::kLimit, "no triangle fits the device's memories", {}};
  if (pieces == 1 || held.lists.references.size() == 1) {
    Result<Image> image = pack(held);
    if (image) {
      if (chunks_.size() == kMostChunks) {
        return fail(ErrorKind::kLimit,
                    fmt::format("the scene needs more than {} chunks", kMostChunks),
                    "use fewer triangles, or a device with more memory");
      }
      image->header.degenerate =
          local_.scene_triangles - static_cast<std::uint32_t>(local_.triangles.size());
      const VoxelGrid& grid = cut_.grid;
      chunks_.push_back({std::move(*image), held.used.lo * grid.edge - grid.margin,
                         held.used.hi * grid.edge + grid.margin});
      return {};
    }
    if (image.error().kind != ErrorKind::kLimit) return std::unexpected(std::move(image.error()));
    too_large = std::move(image.error());
  }
  return divide(part, std::max<std::uint64_t>(pieces, 2), std::move(too_large));
}

/// Boxes in two by their references; a single voxel's list in the middle.
Result<void> Chunker::divide(const Part& part, std::uint64_t pieces, Error why) {
  std::pair<Part, Part> halves{part, part};
  if (part.box.hi - part.box.lo == glm::ivec3{1}) {
    const std::size_t cell = cut_.grid.index(part.box.lo);
    const std::uint64_t count = lists_.first[cell + 1] - lists_.first[cell];
    const std::uint64_t last = std::min(part.last, count);
    if (last - part.first < 2) {
      why.advice = "one triangle alone is too large for this device: use another one";
      return std::unexpected(std::move(why));
    }
    halves.first.last = halves.second.first = part.first + (last - part.first) / 2;
  } else {
    const std::uint64_t left = pieces / 2;
    const double share = static_cast<double>(left) / static_cast<double>(pieces);
    std::tie(halves.first.box, halves.second.box) = cut_box(cut_.grid, lists_, part.box, share);
  }
  if (auto done = cut(halves.first); !done) return done;
  return cut(halves.second);
}

/// The finest of a few grids whose blocks the device holds.
Result<VoxelGrid> choose_grid(const LatticeScene& scene, std::optional<glm::ivec3> wanted) {
  const std::size_t triangles = scene.local.triangles.size();
  const std::uint32_t most = scene.cut.memory.blocks;
  double density = kGridDensity;
  for (;;) {
    auto grid = make_grid(scene.cut.lattice, triangles, wanted, density);
    if (!grid || block_total(*grid) <= most) return grid;
    if (wanted || grid->cells() == 1) {
      return fail(ErrorKind::kLimit,
                  fmt::format("the grid has {} blocks of 2x2x2 voxels, the device holds {}",
                              block_total(*grid), most),
                  "use a coarser --grid, or leave it out");
    }
    density *= kCoarserGrid;
  }
}

}  // namespace

Result<SceneImages> whole_image(Image image) {
  auto triangles = decode_triangles(image);
  if (!triangles) return std::unexpected(std::move(triangles.error()));
  const glm::ivec3 box = image.lattice().box();
  SceneImages out;
  out.triangles = std::move(*triangles);
  out.chunks.push_back({std::move(image), glm::ivec3{0}, box});
  return out;
}

Result<SceneImages> build_scene_images(const Scene& scene, const ImageOptions& options) {
  auto snapped = make_lattice_scene(scene, options);
  if (!snapped) return std::unexpected(std::move(snapped.error()));
  Result<Image> whole = pack_whole(*snapped, options.grid);
  if (whole) return whole_image(std::move(*whole));
  if (whole.error().kind != ErrorKind::kLimit ||
      snapped->cut.memory == memory_sizes(protocol::Layout::kWide)) {
    return std::unexpected(std::move(whole.error()));
  }
  const auto grid = choose_grid(*snapped, options.grid);
  if (!grid) return std::unexpected(grid.error());
  auto chunks = Chunker(*snapped, *grid).run();
  if (!chunks) return std::unexpected(std::move(chunks.error()));
  return SceneImages{std::move(*chunks),
                     {std::move(snapped->local.triangles), std::move(snapped->local.global_ids)}};
}

}  // namespace gridrt
