#include "host/image/image.hpp"

namespace gridrt {

const ImageSection* Image::find(protocol::SectionKind kind, int pe) const {
  for (const ImageSection& section : sections) {
    if (section.kind == kind && section.pe == pe) return &section;
  }
  return nullptr;
}

Lattice Image::lattice() const {
  Lattice lattice;
  lattice.bits = header.bits;
  for (int a = 0; a < 3; ++a) {
    const auto i = static_cast<std::size_t>(a);
    lattice.lo[a] = header.lo[i];
    lattice.hi[a] = header.hi[i];
    lattice.scale[a] = header.scale[i];
    lattice.max_q[a] = header.max_q[i];
  }
  return lattice;
}

VoxelGrid Image::grid() const {
  VoxelGrid grid;
  for (int a = 0; a < 3; ++a) {
    const auto i = static_cast<std::size_t>(a);
    grid.count[a] = header.grid_count[i];
    grid.edge[a] = header.grid_edge[i];
  }
  grid.margin = static_cast<int>(header.margin);
  return grid;
}

}  // namespace gridrt
