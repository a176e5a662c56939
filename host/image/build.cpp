#include <array>
#include <utility>

#include <fmt/format.h>

#include "host/image/image.hpp"
#include "host/image/lattice_scene.hpp"
#include "host/image/limits.hpp"
#include "host/image/measured_cut.hpp"
#include "host/image/scene_section.hpp"
#include "host/image/weld.hpp"

namespace gridrt {
namespace {

constexpr std::size_t kMostTriangles = 0x7FFFFFFFU;  ///< global ids are int32 in results
constexpr int kTries = 30;                           ///< down to 1 voxel for 1,000 triangles

/// Snaps the scene and leaves out degenerate triangles.
LocalTriangles make_local(const Scene& scene, const Lattice& lattice) {
  LocalTriangles local;
  local.scene_triangles = static_cast<std::uint32_t>(scene.triangles.size());
  WeldedPoints welded = weld(snap_all(lattice, scene.positions));
  local.vertices = std::move(welded.points);
  for (std::size_t i = 0; i < scene.triangles.size(); ++i) {
    LatticeTriangle triangle{};
    std::array<std::uint32_t, 3> corners{};
    for (std::size_t c = 0; c < 3; ++c) {
      corners[c] = welded.index[scene.triangles[i][c]];
      triangle.v[c] = local.vertices[corners[c]];
    }
    if (is_degenerate(triangle)) continue;
    local.triangles.push_back(triangle);
    local.corners.push_back(corners);
    local.global_ids.push_back(static_cast<std::uint32_t>(i));
  }
  return local;
}

}  // namespace

Result<LatticeScene> make_lattice_scene(const Scene& scene, const ImageOptions& options) {
  LatticeScene out;
  Cut& cut = out.cut;
  cut.mapping = options.mapping;
  cut.pes = options.pes;
  cut.threads = options.threads;
  cut.layout = options.layout == protocol::Layout::kCompact ? protocol::Layout::kCompact
                                                            : protocol::Layout::kWide;
  cut.memory = memory_sizes(cut.layout);
  if (options.memory) cut.memory = smaller_of(cut.memory, *options.memory);
  if (options.pes < 1 || options.pes > kMaxPes) {
    return fail(ErrorKind::kUsage, fmt::format("{} PEs asked for", options.pes),
                fmt::format("choose between 1 and {}", kMaxPes));
  }
  if (scene.triangles.size() > kMostTriangles) {
    return fail(ErrorKind::kLimit,
                fmt::format("{} triangles, more than {}", scene.triangles.size(), kMostTriangles));
  }
  auto lattice = make_lattice(scene.positions, scene.triangles, options.bits);
  if (!lattice) return std::unexpected(std::move(lattice.error()));
  cut.lattice = *lattice;
  if (auto good = check_widths(cut.layout, options.bits, options.pes); !good) {
    return std::unexpected(std::move(good.error()));
  }
  out.local = make_local(scene, *lattice);
  out.lights = scene.lights;
  return out;
}

Result<Image> pack_with_grid(const LatticeScene& scene, const VoxelGrid& grid) {
  Cut cut = scene.cut;
  cut.grid = grid;
  if (cut.mapping == Mapping::kMeasured) cut.mapping = Mapping::kBoxes;
  cut.lists = bin_triangles(grid, scene.local.triangles, cut.threads);
  auto owners = deal_voxels(grid, cut.lists, cut.mapping, cut.pes);
  if (!owners) return std::unexpected(std::move(owners.error()));
  cut.owners = std::move(*owners);
  return pack_image(scene.local, cut);
}

Result<Image> pack_whole(const LatticeScene& scene, std::optional<glm::ivec3> grid) {
  const Cut& cut = scene.cut;
  const std::size_t triangles = scene.local.triangles.size();
  if (auto good = check_scene_limits(cut.layout, cut.memory, cut.pes, triangles); !good) {
    return std::unexpected(std::move(good.error()));
  }
  if (grid) {
    const auto asked = make_grid(cut.lattice, triangles, grid);
    if (!asked) return std::unexpected(asked.error());
    return pack_with_grid(scene, *asked);
  }
  if (cut.layout == protocol::Layout::kCompact && triangles > 0) {
    Result<Image> measured = pack_measured(scene);
    if (measured || measured.error().kind != ErrorKind::kLimit) return measured;
  }
  Result<Image> image = fail(ErrorKind::kInternal, "no grid was tried");
  double density = kGridDensity;
  for (int i = 0; i < kTries; ++i, density *= kCoarserGrid) {
    const auto chosen = make_grid(cut.lattice, triangles, std::nullopt, density);
    if (!chosen) return std::unexpected(chosen.error());
    image = pack_with_grid(scene, *chosen);
    // The memories of the wide layout are never exceeded by a chosen grid.
    if (image || image.error().kind != ErrorKind::kLimit ||
        cut.memory == memory_sizes(protocol::Layout::kWide)) {
      break;
    }
  }
  return image;
}

Result<Image> build_image(const Scene& scene, const ImageOptions& options) {
  const auto snapped = make_lattice_scene(scene, options);
  if (!snapped) return std::unexpected(snapped.error());
  Result<Image> image = pack_whole(*snapped, options.grid);
  if (!image || !options.with_scene) return image;

  auto bytes = pack_scene(scene);
  if (!bytes) return std::unexpected(std::move(bytes.error()));
  if (auto added = add_section(*image, protocol::SectionKind::kScene, 0, std::move(*bytes));
      !added) {
    return std::unexpected(std::move(added.error()));
  }
  return image;
}

}  // namespace gridrt
