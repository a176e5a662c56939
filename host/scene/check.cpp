#include <cmath>
#include <cstddef>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "host/scene/assemble.hpp"

namespace gridrt::scene_detail {
namespace {

template <class V>
bool finite(const V& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

bool in_unit_range(const glm::vec3& c) {
  return finite(c) && c.x >= 0 && c.y >= 0 && c.z >= 0 && c.x <= 1 && c.y <= 1 && c.z <= 1;
}

bool non_negative(const glm::vec3& c) { return finite(c) && c.x >= 0 && c.y >= 0 && c.z >= 0; }

Result<void> check_triangles(const Scene& scene, const std::string& name) {
  const std::size_t count = scene.triangles.size();
  if (count > kMaxTriangles) {
    return fail(ErrorKind::kLimit, fmt::format("{}: {} triangles; a scene holds at most {}", name,
                                               count, kMaxTriangles));
  }
  if (scene.triangle_materials.size() != count ||
      (!scene.triangle_normals.empty() && scene.triangle_normals.size() != count)) {
    return fail(ErrorKind::kInternal,
                fmt::format("{}: materials or normals do not match the triangles", name));
  }
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t vertex = scene.triangles[i][k];
      if (vertex >= scene.positions.size()) {
        return fail(ErrorKind::kInput, fmt::format("{}: triangle {} uses vertex {} of {}", name, i,
                                                   vertex, scene.positions.size()));
      }
      const std::uint32_t normal =
          scene.triangle_normals.empty() ? kNoIndex : scene.triangle_normals[i][k];
      if (normal != kNoIndex && normal >= scene.normals.size()) {
        return fail(ErrorKind::kInput, fmt::format("{}: triangle {} uses normal {} of {}", name, i,
                                                   normal, scene.normals.size()));
      }
    }
    if (scene.triangle_materials[i] >= scene.materials.size()) {
      return fail(ErrorKind::kInput,
                  fmt::format("{}: triangle {} uses material {} of {}", name, i,
                              scene.triangle_materials[i], scene.materials.size()));
    }
  }
  return {};
}

Result<void> check_materials(const Scene& scene, const std::string& name) {
  if (scene.materials.empty()) {
    return fail(ErrorKind::kInternal, fmt::format("{}: no material", name));
  }
  for (const Material& m : scene.materials) {
    const bool colours = in_unit_range(m.ambient) && in_unit_range(m.diffuse) &&
                         in_unit_range(m.specular) && in_unit_range(m.mirror) &&
                         in_unit_range(m.transmission) && non_negative(m.emission);
    const bool numbers =
        std::isfinite(m.shininess) && m.shininess >= 0 && std::isfinite(m.ior) && m.ior > 0;
    if (!colours || !numbers) {
      return fail(ErrorKind::kInput,
                  fmt::format("{}: material '{}' has a value outside its range", name, m.name),
                  "colours are in [0, 1], the exponent is >= 0, the index of refraction > 0");
    }
  }
  return {};
}

Result<void> check_camera(const Camera& camera, const std::string& name) {
  if (!finite(camera.eye) || !finite(camera.look) || !finite(camera.up) ||
      !std::isfinite(camera.fov_degrees)) {
    return fail(ErrorKind::kInput, fmt::format("{}: the camera has a value not finite", name));
  }
  if (!is_field_of_view(camera.fov_degrees)) {
    return fail(
        ErrorKind::kInput,
        fmt::format("{}: the camera's field of view is {} degrees", name, camera.fov_degrees),
        "give one between 0 and 180");
  }
  if (camera.eye == camera.look) {
    return fail(ErrorKind::kInput, fmt::format("{}: the camera looks at its own eye", name));
  }
  return {};
}

}  // namespace

Result<void> check_scene(const Scene& scene, const std::string& name) {
  for (std::size_t i = 0; i < scene.positions.size(); ++i) {
    if (!finite(scene.positions[i])) {
      return fail(ErrorKind::kInput, fmt::format("{}: vertex {} is not finite", name, i));
    }
  }
  for (std::size_t i = 0; i < scene.normals.size(); ++i) {
    const float length = glm::length(scene.normals[i]);
    if (!(std::abs(length - 1.0F) <= 1e-5F)) {
      return fail(ErrorKind::kInput, fmt::format("{}: normal {} has length {}", name, i, length));
    }
  }
  if (const auto ok = check_triangles(scene, name); !ok) {
    return ok;
  }
  if (const auto ok = check_materials(scene, name); !ok) {
    return ok;
  }
  for (std::size_t i = 0; i < scene.lights.size(); ++i) {
    const Light& light = scene.lights[i];
    if (!finite(light.position) || !finite(light.direction) || !non_negative(light.colour) ||
        (light.kind == Light::Kind::kDirectional && light.direction == glm::dvec3(0.0))) {
      return fail(ErrorKind::kInput,
                  fmt::format("{}: light {} has a value outside its range", name, i),
                  "positions and directions are finite, colours >= 0, a direction is not zero");
    }
  }
  if (!non_negative(scene.background) || !non_negative(scene.ambient_light)) {
    return fail(ErrorKind::kInput,
                fmt::format("{}: background or ambient light is negative or not finite", name));
  }
  return scene.camera ? check_camera(*scene.camera, name) : Result<void>{};
}

}  // namespace gridrt::scene_detail
