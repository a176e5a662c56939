#include "host/render/camera.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <fmt/format.h>
#include <glm/geometric.hpp>

namespace gridrt {
namespace {

bool is_finite(const glm::dvec3& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

double largest(const glm::dvec3& v) {
  return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
}

std::string text(const glm::dvec3& v) { return fmt::format("{},{},{}", v.x, v.y, v.z); }

double half_height(double fov_degrees) {
  return std::tan(fov_degrees * (std::numbers::pi / 360.0));
}

}  // namespace

glm::dvec2 sample_position(int index, int count) {
  double inverse = 0.0;  // the bits of index mirrored about the binary point
  double digit = 0.5;
  auto rest = static_cast<unsigned>(index);
  for (unsigned span = 1; span < static_cast<unsigned>(count); span *= 2, digit *= 0.5) {
    if ((rest & 1U) != 0) inverse += digit;
    rest >>= 1U;
  }
  return {(index + 0.5) / count, inverse + digit};
}

bool normalise(glm::dvec3& v) {
  const double size = largest(v);
  if (!(size > 0.0) || !is_finite(v)) return false;
  // A power of two, so that scaling a scene by one changes no bit of a direction.
  const int exponent = std::ilogb(size);
  const glm::dvec3 scaled(std::scalbn(v.x, -exponent), std::scalbn(v.y, -exponent),
                          std::scalbn(v.z, -exponent));
  v = scaled / glm::length(scaled);
  return true;
}

Result<PinholeCamera> PinholeCamera::create(const Camera& camera, int width, int height) {
  const auto refuse = [](std::string message, std::string advice = {}) {
    return fail(ErrorKind::kUsage, "camera: " + std::move(message), std::move(advice));
  };
  if (!is_finite(camera.eye)) return refuse("eye " + text(camera.eye) + " is not finite");
  if (!is_finite(camera.look)) return refuse("look " + text(camera.look) + " is not finite");
  if (!is_finite(camera.up)) return refuse("up " + text(camera.up) + " is not finite");
  if (!is_field_of_view(camera.fov_degrees)) {
    return refuse(
        fmt::format("a field of view of {} degrees is outside (0, 180)", camera.fov_degrees));
  }
  if (width < 1 || height < 1)
    return refuse(fmt::format("no picture has {}x{} pixels", width, height));
  // Halved, so that the difference of two large numbers stays finite.
  glm::dvec3 forward = (camera.look * 0.5) - (camera.eye * 0.5);
  if (!normalise(forward)) {
    return refuse("eye and look are the same point " + text(camera.eye),
                  "give --eye and --look different points");
  }
  glm::dvec3 up = camera.up;
  if (!normalise(up)) return refuse("up is the zero vector");
  glm::dvec3 right = glm::cross(forward, up);
  constexpr double kParallel = 1e-9;
  if (glm::length(right) < kParallel) {
    return refuse("up " + text(camera.up) + " lies along the view",
                  "give --up a direction across the view, such as 0,0,1");
  }
  normalise(right);
  const glm::dvec3 down = glm::cross(forward, right);
  const double half = half_height(camera.fov_degrees);
  const double pixel = 2.0 * half / height;
  PinholeCamera result;
  result.eye_ = camera.eye;
  result.right_ = right * pixel;
  result.down_ = down * pixel;
  result.corner_ = forward - (right * (0.5 * pixel * width)) - (down * half);
  return result;
}

Ray PinholeCamera::ray(int x, int y, const glm::dvec2& position) const {
  Ray ray;
  ray.origin = eye_;
  ray.direction = corner_ + (right_ * (x + position.x)) + (down_ * (y + position.y));
  normalise(ray.direction);
  return ray;
}

Camera frame_scene(const Scene& scene, double aspect) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  glm::dvec3 lo(kInfinity);
  glm::dvec3 hi(-kInfinity);
  for (const auto& triangle : scene.triangles) {
    for (const std::uint32_t index : triangle) {
      const glm::dvec3 p(scene.positions[index]);
      lo = glm::dvec3(std::min(lo.x, p.x), std::min(lo.y, p.y), std::min(lo.z, p.z));
      hi = glm::dvec3(std::max(hi.x, p.x), std::max(hi.y, p.y), std::max(hi.z, p.z));
    }
  }
  Camera camera;
  if (scene.triangles.empty()) return camera;
  camera.fov_degrees = 40.0;
  camera.look = (lo + hi) * 0.5;
  const glm::dvec3 half = (hi - lo) * 0.5;
  const glm::dvec3 toward = glm::normalize(glm::dvec3(0.35, 0.3, 1.0));
  const glm::dvec3 right = glm::normalize(glm::cross(camera.up, toward));
  const glm::dvec3 up = glm::cross(toward, right);
  // Each corner of the box asks for a distance at which it is just within the picture.
  constexpr double kMargin = 1.06;
  const double tan_y = half_height(camera.fov_degrees);
  const double tan_x = tan_y * aspect;
  double distance = 0.0;
  for (int corner = 0; corner < 8; ++corner) {
    const glm::dvec3 d((corner & 1) != 0 ? half.x : -half.x, (corner & 2) != 0 ? half.y : -half.y,
                       (corner & 4) != 0 ? half.z : -half.z);
    const double need =
        kMargin * std::max(std::abs(glm::dot(d, right)) / tan_x, std::abs(glm::dot(d, up)) / tan_y);
    distance = std::max(distance, need + glm::dot(d, toward));
  }
  if (!(distance > 0.0)) distance = 1.0;  // all triangles are one point
  camera.eye = camera.look + (toward * distance);
  if (camera.eye == camera.look) camera.eye.z += std::max(1.0, std::abs(camera.look.z));
  return camera;
}

}  // namespace gridrt
