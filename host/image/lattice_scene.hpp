// The first half of making images: a scene on its lattice, before a grid is laid over it.
#pragma once

#include "host/image/image.hpp"
#include "host/image/pack.hpp"

namespace gridrt {

/// A scene's triangles by local id, its lights, and a cut that lacks grid, lists and owners.
struct LatticeScene {
  LocalTriangles local;
  std::vector<Light> lights;  ///< scene units
  Cut cut;
};

/// Errors: kUsage for PEs out of range, kLimit for lattice bits and PEs beyond the layout, those of
/// make_lattice.
Result<LatticeScene> make_lattice_scene(const Scene& scene, const ImageOptions& options);

/// Bins, deals and packs with one grid. Errors: those of deal_voxels and pack_image.
Result<Image> pack_with_grid(const LatticeScene& scene, const VoxelGrid& grid);

/// One image on the wanted grid or, without one, on one that is chosen: in the compact layout that
/// on which rays cost least (pack_measured), else the finest of a few that fit. Errors: kLimit if
/// none does, those of make_grid.
Result<Image> pack_whole(const LatticeScene& scene, std::optional<glm::ivec3> grid);

/// Voxels a triangle that a chosen grid has at the most, and from one try to the next.
inline constexpr double kGridDensity = 4.0;
inline constexpr double kCoarserGrid = 0.75;

}  // namespace gridrt
