// Light at a surface: Phong's local part, and the rays that Whitted's global part asks for.
#pragma once

#include <optional>

#include <glm/vec3.hpp>

#include "host/grid/segment.hpp"
#include "host/render/surface.hpp"
#include "host/scene/scene.hpp"

namespace gridrt {

/// Emission and ambient part; no light and no ray is needed for it.
glm::dvec3 unlit_part(const Surface& surface, const glm::vec3& ambient_light);

/// Phong's diffuse and specular part for light of `colour` from the unit vector `to_light`, seen
/// along `view` (unit, towards the surface): B. T. Phong, "Illumination for Computer Generated
/// Pictures", 1975. Zero where the light is behind the triangle or behind the shading normal.
glm::dvec3 lit_part(const Surface& surface, const glm::dvec3& view, const glm::dvec3& to_light,
                    const glm::vec3& colour);

/// A shadow ray to ask for, and what the light adds if nothing is in the way.
struct LightSample {
  Ray shadow;  ///< from the surface: to a point light with tmax = 1, else with tmax infinite
  glm::dvec3 radiance{0.0};
};

/// Nothing where the light cannot add anything, so that no shadow ray is wasted.
std::optional<LightSample> sample_light(const Surface& surface, const glm::dvec3& view,
                                        const Light& light);

/// A mirror or glass ray to ask for, and the weight of what it brings.
struct Bounce {
  Ray ray;
  glm::dvec3 weight{0.0};
};
struct Bounces {
  std::optional<Bounce> mirror;
  std::optional<Bounce> glass;
};

/// Rays that continue the light path at a surface; none has weight zero. Light that meets glass
/// (`transmission`) is split by Fresnel's equations into a refracted part and a part that joins the
/// mirror's; all of it is mirrored under total reflection. A ray that meets the front side
/// enters the medium of index `ior`, one that meets the back side leaves it into index 1. A
/// direction that would end up on the wrong side of the triangle because of the shading normal is
/// taken about the geometric normal instead.
Bounces bounce(const Surface& surface, const glm::dvec3& view);

}  // namespace gridrt
