// The memory images of a scene: what a device loads, section by section, and what a .grt holds.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "gridrt_protocol.hpp"
#include "hal/error.hpp"
#include "host/grid/lattice.hpp"
#include "host/grid/partition.hpp"
#include "host/grid/voxel_grid.hpp"
#include "host/image/memory_sizes.hpp"
#include "host/scene/scene.hpp"

namespace gridrt {

/// How a scene is cut and stored.
struct ImageOptions {
  int bits = kDefaultBits;
  std::optional<glm::ivec3> grid = std::nullopt;  ///< none: chosen from the scene
  int pes = 4;
  Mapping mapping = Mapping::kMeasured;
  /// kCompact has the board's field widths and memory sizes, kWide is for software; kNone: what
  /// the device prefers (options_for, host/driver/image_options.hpp), and wide without one.
  protocol::Layout layout = protocol::Layout::kNone;
  std::optional<MemorySizes> memory =
      std::nullopt;        ///< of the device; none: the most that the layout allows
  bool with_scene = true;  ///< keep materials, normals, lights and camera in the image
  int threads = 0;         ///< that build it; 0: one a core. The image does not depend on them
};

/// One section: its directory entry and its bytes.
struct ImageSection {
  protocol::SectionKind kind{};
  std::uint8_t pe = 0;  ///< owner of a per-PE section
  std::vector<std::byte> bytes;
};

/// A complete image. Sections are in the order of the file; their bytes are exactly those that a
/// device receives.
struct Image {
  protocol::ImageHeader header{};
  std::vector<ImageSection> sections;

  [[nodiscard]] const ImageSection* find(protocol::SectionKind kind, int pe = 0) const;
  [[nodiscard]] Lattice lattice() const;
  [[nodiscard]] VoxelGrid grid() const;
};

/// Counts shown by --info and in the statistics, for one PE or for the whole image.
struct ImageCounts {
  std::uint64_t triangles = 0;  ///< records in the PE's memory
  std::uint64_t copies = 0;     ///< of these, triangles that an earlier PE holds too
  std::uint64_t vertices = 0;
  std::uint64_t references = 0;
  std::uint64_t cells = 0;  ///< voxels with references
};

/// Counts of every PE, then one entry for the whole image (its copies are those of all PEs).
/// Sections that are not whole records count what they hold.
std::vector<ImageCounts> count_image(const Image& image);

/// Snaps, bins, partitions and packs a scene. Errors: those of make_lattice, make_grid and
/// deal_voxels; kLimit where the compact layout cannot hold the scene, with the sizes and what
/// would help.
Result<Image> build_image(const Scene& scene, const ImageOptions& options);

/// The triangles of an image by local id, and their global ids: what the host needs to turn an id
/// into t, u, v. Decoded from the PE sections, so a .grt needs nothing else.
struct ImageTriangles {
  std::vector<LatticeTriangle> triangles;  ///< by local id
  std::vector<std::uint32_t> global_ids;   ///< by local id, ascending
};
Result<ImageTriangles> decode_triangles(const Image& image);

/// The scene kept in an image (with_scene), or one with the lattice's own vertices and the default
/// material.
Result<Scene> decode_scene(const Image& image);

}  // namespace gridrt
