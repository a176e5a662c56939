#include "host/render/optics.hpp"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "host/render/camera.hpp"

namespace gridrt {

glm::dvec3 reflect(const glm::dvec3& d, const glm::dvec3& n) {
  return d - (n * (2.0 * glm::dot(d, n)));
}

Refraction refract(const glm::dvec3& d, const glm::dvec3& n, double ratio) {
  const double cos_in = std::clamp(-glm::dot(d, n), 0.0, 1.0);
  const double sin2_out = ratio * ratio * (1.0 - (cos_in * cos_in));
  if (!(sin2_out < 1.0)) return {};
  const double cos_out = std::sqrt(1.0 - sin2_out);
  // Both amplitudes, divided by the index behind the surface.
  const double across = ((ratio * cos_in) - cos_out) / ((ratio * cos_in) + cos_out);
  const double along = (cos_in - (ratio * cos_out)) / (cos_in + (ratio * cos_out));
  Refraction result;
  result.reflectance = std::min(1.0, 0.5 * ((across * across) + (along * along)));
  result.direction = (d * ratio) + (n * ((ratio * cos_in) - cos_out));
  normalise(result.direction);
  return result;
}

}  // namespace gridrt
