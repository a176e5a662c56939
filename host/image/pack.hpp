// From binned and dealt triangles to the sections of an image.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "host/image/image.hpp"

namespace gridrt {

/// Triangles on the lattice by local id: none degenerate, every vertex once.
struct LocalTriangles {
  std::vector<LatticeTriangle> triangles;
  std::vector<std::array<std::uint32_t, 3>> corners;  ///< indices into vertices
  std::vector<glm::ivec3> vertices;                   ///< distinct
  std::vector<std::uint32_t> global_ids;              ///< ascending
  std::uint32_t scene_triangles = 0;                  ///< of the scene, degenerate ones included
};

/// How an image is cut.
struct Cut {
  Lattice lattice;
  VoxelGrid grid;
  VoxelLists lists;                   ///< references are local ids
  std::vector<std::uint8_t> owners;   ///< PE of each voxel
  Mapping mapping = Mapping::kBoxes;  ///< by which they were dealt
  int pes = 1;
  protocol::Layout layout = protocol::Layout::kWide;
  MemorySizes memory = memory_sizes(protocol::Layout::kWide);
  int threads = 0;  ///< that cut it; 0: one a core
};

/// Packs all sections but Scene, and the header. Errors: kLimit if layout or memory cannot hold
/// them.
Result<Image> pack_image(const LocalTriangles& local, const Cut& cut);

/// Appends a section and counts it in the header. Errors: kLimit for a section of 4 GiB or more.
Result<void> add_section(Image& image, protocol::SectionKind kind, int pe,
                         std::vector<std::byte> bytes);

}  // namespace gridrt
