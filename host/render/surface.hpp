// What a hit looks like to the shader: point, normals, side, material.
#pragma once

#include <cstdint>
#include <vector>

#include <glm/vec3.hpp>

#include "hal/error.hpp"
#include "host/driver/device.hpp"
#include "host/grid/lattice.hpp"
#include "host/grid/segment.hpp"
#include "host/image/image.hpp"
#include "host/scene/scene.hpp"

namespace gridrt {

/// A place on a triangle as the ray that hit it sees it.
struct Surface {
  glm::dvec3 point{0.0};      ///< O + t D
  glm::dvec3 geometric{0.0};  ///< unit normal of the triangle on the lattice, towards the ray
  glm::dvec3 normal{0.0};     ///< unit normal to shade with, on the same side
  bool front = true;          ///< the ray meets the side that sees the vertices anticlockwise
  const Material* material = nullptr;
};

/// Looks up triangles of a scene and of its image by global id.
///
/// Which side of a triangle a ray meets is decided on the lattice in exact arithmetic, as are the
/// origins of secondary rays, so that entries and exits of glass pair up. The shading normal is the
/// interpolated vertex normal, or for a flat triangle that of the scene's own vertices. If it
/// points away from the side that the ray meets it is turned round: a surface is lit alike on both
/// sides, and normals that disagree with the order of the vertices do not darken it.
class SurfaceTable {
 public:
  /// Keeps references to `scene` and `triangles`. Errors: kInput where they do not belong together.
  static Result<SurfaceTable> create(const Scene& scene, const Lattice& lattice,
                                     const ImageTriangles& triangles);

  /// The surface at a closest hit (id >= 0) of `ray`, whose segment is `segment`.
  [[nodiscard]] Surface at(const Ray& ray, const Segment& segment, const Hit& hit) const;

  /// The triangle on the lattice, for secondary_origin.
  [[nodiscard]] const LatticeTriangle& triangle(std::int32_t id) const {
    return triangles_->triangles[locals_[static_cast<std::size_t>(id)]];
  }

  /// False for ids that no image triangle has; a device that answers one is broken.
  [[nodiscard]] bool knows(std::int32_t id) const {
    return id >= 0 && static_cast<std::size_t>(id) < locals_.size() &&
           locals_[static_cast<std::size_t>(id)] != kNoIndex;
  }

 private:
  [[nodiscard]] glm::dvec3 shading_normal(std::size_t id, double u, double v) const;

  const Scene* scene_ = nullptr;
  const ImageTriangles* triangles_ = nullptr;
  std::vector<std::uint32_t> locals_;  ///< local id by global id
  glm::dvec3 scale_{1.0};              ///< of lattice normals to scene units, largest 1
};

}  // namespace gridrt
