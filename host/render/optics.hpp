// Mirror, refraction and Fresnel's equations.
#pragma once

#include <glm/vec3.hpp>

namespace gridrt {

/// The mirror image d - 2 (d.n) n of a direction; n has unit length.
glm::dvec3 reflect(const glm::dvec3& d, const glm::dvec3& n);

/// What becomes of light at the border of two clear media.
struct Refraction {
  double reflectance = 1.0;   ///< share that is reflected, in [0, 1]; 1: total reflection
  glm::dvec3 direction{0.0};  ///< unit vector of the rest; not set under total reflection
};

/// Snell's law and Fresnel's equations for unpolarised light (Born and Wolf, Principles of Optics,
/// 1.5.2), without approximation. `d` has unit length and points to the surface, `n` has unit
/// length and points to where d comes from (d.n < 0); `ratio` is the index of refraction before
/// the surface over the one behind it, > 0.
Refraction refract(const glm::dvec3& d, const glm::dvec3& n, double ratio);

}  // namespace gridrt
