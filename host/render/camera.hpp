// From a camera to primary rays.
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "hal/error.hpp"
#include "host/grid/segment.hpp"
#include "host/scene/scene.hpp"

namespace gridrt {

/// The place of sample `index` of `count` within its pixel, in (0, 1) x (0, 1), y down: a
/// Hammersley set (J. M. Hammersley, 1960) centred in the pixel. One sample: the pixel's centre.
glm::dvec2 sample_position(int index, int count);

/// A unit vector along v, or nothing for a vector that is zero or not finite. Does not overflow.
bool normalise(glm::dvec3& v);

/// A pinhole camera over a picture of a given size: square pixels, row 0 on top, the camera's
/// vertical field of view over the whole height.
class PinholeCamera {
 public:
  /// Errors: kUsage for numbers that are not finite, fov outside (0, 180), eye == look or `up`
  /// along the view.
  static Result<PinholeCamera> create(const Camera& camera, int width, int height);

  /// The ray through `position` (see sample_position) of pixel (x, y). Its direction has unit
  /// length, so a hit's t is a distance in scene units.
  [[nodiscard]] Ray ray(int x, int y, const glm::dvec2& position) const;

 private:
  glm::dvec3 eye_{0.0};
  glm::dvec3 corner_{0.0};  ///< from the eye to the picture's top left corner
  glm::dvec3 right_{0.0};   ///< one pixel to the right
  glm::dvec3 down_{0.0};    ///< one pixel down
};

/// A camera that has the whole box of the triangles in view, from the front, a little above and to
/// the right, for a scene that brings none. `aspect` is width / height.
Camera frame_scene(const Scene& scene, double aspect);

}  // namespace gridrt
