// A scene as images for a device's memories: one if it fits, else several, the chunks.
//
// The voxels of one grid are dealt to chunks in boxes; each chunk is a complete image of the same
// lattice and grid in which the voxels of the others are empty. It has local ids of its own, which
// ascend with the global ones. A voxel whose list alone is too long is shared by several chunks.
// Every triangle is in the list of every voxel that it meets, so where a ray hits a triangle, some
// chunk tests it: the smallest key over all chunks is the scene's (docs/numerics.md, section 6).
#pragma once

#include <vector>

#include "host/image/image.hpp"

namespace gridrt {

struct Chunk {
  Image image;
  glm::ivec3 lo{0};  ///< the closed lattice box of all its voxels with references,
  glm::ivec3 hi{0};  ///< grown by the grid's margin
};

struct SceneImages {
  std::vector<Chunk> chunks;  ///< at least one
  ImageTriangles triangles;   ///< of the scene; their local ids are not those of the chunks

  [[nodiscard]] const Image& front() const { return chunks.front().image; }
};

/// One image, as from a .grt. Errors: those of decode_triangles.
Result<SceneImages> whole_image(Image image);

/// build_image where the scene fits, else chunks. `options.with_scene` is ignored: the host has the
/// scene. Errors: those of build_image; kLimit if a grid that was asked for has more blocks than
/// the device holds, if not even one triangle fits, or for more than 65,535 chunks.
Result<SceneImages> build_scene_images(const Scene& scene, const ImageOptions& options);

}  // namespace gridrt
