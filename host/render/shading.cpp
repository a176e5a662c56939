#include "host/render/shading.hpp"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "host/render/camera.hpp"
#include "host/render/optics.hpp"

namespace gridrt {
namespace {

bool is_zero(const glm::dvec3& colour) {
  return colour.x == 0.0 && colour.y == 0.0 && colour.z == 0.0;
}

Ray continue_from(const Surface& surface, const glm::dvec3& direction) {
  Ray ray;
  ray.origin = surface.point;
  ray.direction = direction;
  return ray;
}

}  // namespace

glm::dvec3 unlit_part(const Surface& surface, const glm::vec3& ambient_light) {
  const Material& material = *surface.material;
  return glm::dvec3(material.emission) + (glm::dvec3(material.ambient) * glm::dvec3(ambient_light));
}

glm::dvec3 lit_part(const Surface& surface, const glm::dvec3& view, const glm::dvec3& to_light,
                    const glm::vec3& colour) {
  const double facing = glm::dot(surface.normal, to_light);
  if (!(facing > 0.0) || !(glm::dot(surface.geometric, to_light) > 0.0)) return glm::dvec3(0.0);
  const Material& material = *surface.material;
  glm::dvec3 part = glm::dvec3(material.diffuse) * facing;
  const glm::dvec3 specular(material.specular);
  if (!is_zero(specular)) {
    const double highlight = glm::dot(reflect(view, surface.normal), to_light);
    if (highlight > 0.0) part += specular * std::pow(highlight, double{material.shininess});
  }
  return part * glm::dvec3(colour);
}

std::optional<LightSample> sample_light(const Surface& surface, const glm::dvec3& view,
                                        const Light& light) {
  LightSample sample;
  glm::dvec3 to_light(0.0);
  if (light.kind == Light::Kind::kPoint) {
    to_light = light.position - surface.point;
    sample.shadow = continue_from(surface, to_light);
    sample.shadow.tmax = 1.0;
  } else {
    to_light = -light.direction;
    sample.shadow = continue_from(surface, to_light);
  }
  if (!normalise(to_light)) return std::nullopt;
  sample.radiance = lit_part(surface, view, to_light, light.colour);
  if (is_zero(sample.radiance)) return std::nullopt;
  return sample;
}

Bounces bounce(const Surface& surface, const glm::dvec3& view) {
  const Material& material = *surface.material;
  glm::dvec3 mirrored(material.mirror);
  const glm::dvec3 transmission(material.transmission);
  Bounces bounces;
  if (is_zero(mirrored) && is_zero(transmission)) return bounces;
  // Seen from behind its shading normal (near a silhouette) a surface is what its triangle is.
  const glm::dvec3& normal =
      glm::dot(surface.normal, view) < 0.0 ? surface.normal : surface.geometric;
  if (!is_zero(transmission)) {
    const double ior = material.ior;
    const double ratio = surface.front ? 1.0 / ior : ior;
    Refraction refraction = refract(view, normal, ratio);
    if (refraction.reflectance < 1.0 &&
        !(glm::dot(refraction.direction, surface.geometric) < 0.0)) {
      refraction = refract(view, surface.geometric, ratio);
    }
    mirrored += transmission * refraction.reflectance;
    const glm::dvec3 weight = transmission * (1.0 - refraction.reflectance);
    if (!is_zero(weight))
      bounces.glass = Bounce{continue_from(surface, refraction.direction), weight};
  }
  if (!is_zero(mirrored)) {
    glm::dvec3 direction = reflect(view, normal);
    if (!(glm::dot(direction, surface.geometric) > 0.0))
      direction = reflect(view, surface.geometric);
    normalise(direction);
    bounces.mirror = Bounce{continue_from(surface, direction), mirrored};
  }
  return bounces;
}

}  // namespace gridrt
