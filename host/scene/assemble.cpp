#include "host/scene/assemble.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <glm/vec4.hpp>

namespace gridrt::scene_detail {
namespace {

bool finite(const glm::vec3& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

// Unit vector along v, without overflow or underflow; zero if v has no direction.
glm::dvec3 direction_of(const glm::dvec3& v) {
  const double largest = std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
  if (!(largest > 0.0) || !std::isfinite(largest)) {
    return glm::dvec3(0.0);
  }
  const glm::dvec3 scaled(v.x / largest, v.y / largest, v.z / largest);
  return scaled / glm::length(scaled);
}

}  // namespace

std::uint32_t add_vertex(Scene& scene, const glm::dvec3& position) {
  scene.positions.emplace_back(static_cast<float>(position.x), static_cast<float>(position.y),
                               static_cast<float>(position.z));
  return static_cast<std::uint32_t>(scene.positions.size() - 1);
}

std::uint32_t add_normal(Scene& scene, const glm::dvec3& normal) {
  const glm::dvec3 unit = direction_of(normal);
  if (unit == glm::dvec3(0.0)) {
    return kNoIndex;
  }
  scene.normals.emplace_back(unit);
  return static_cast<std::uint32_t>(scene.normals.size() - 1);
}

void add_triangle(Scene& scene, const Corners& corners, std::uint32_t material,
                  const Corners& normals) {
  const bool smooth = normals[0] != kNoIndex && normals[1] != kNoIndex && normals[2] != kNoIndex;
  if (smooth && scene.triangle_normals.empty()) {
    scene.triangle_normals.assign(scene.triangles.size(), kFlat);
  }
  if (smooth || !scene.triangle_normals.empty()) {
    scene.triangle_normals.push_back(smooth ? normals : kFlat);
  }
  scene.triangles.push_back(corners);
  scene.triangle_materials.push_back(material);
}

std::uint32_t add_material(Scene& scene, Material material) {
  scene.materials.push_back(std::move(material));
  return static_cast<std::uint32_t>(scene.materials.size() - 1);
}

Result<void> append_scene(Scene& into, const Scene& from, const Placement& placement,
                          const std::string& where) {
  if (into.triangles.size() + from.triangles.size() > kMaxTriangles ||
      into.positions.size() + from.positions.size() >= kNoIndex ||
      into.normals.size() + from.normals.size() >= kNoIndex) {
    return fail(ErrorKind::kLimit,
                fmt::format("{}: more than {} triangles in one scene", where, kMaxTriangles));
  }
  const glm::dmat3 linear(placement.matrix);
  const double determinant = glm::determinant(linear);
  // Cofactors instead of the inverse transpose: they exist for flattening matrices too.
  const glm::dmat3 cofactors(glm::cross(linear[1], linear[2]), glm::cross(linear[2], linear[0]),
                             glm::cross(linear[0], linear[1]));
  const auto first_vertex = static_cast<std::uint32_t>(into.positions.size());
  for (const glm::vec3& p : from.positions) {
    const glm::dvec4 placed = placement.matrix * glm::dvec4(glm::dvec3(p), 1.0);
    add_vertex(into, glm::dvec3(placed));
    if (!finite(into.positions.back())) {
      return fail(ErrorKind::kInput,
                  fmt::format("{}: vertex {} lies beyond float32's range where it is placed", where,
                              into.positions.size() - 1 - first_vertex));
    }
  }
  std::vector<std::uint32_t> normal_at(from.normals.size());
  for (std::size_t i = 0; i < from.normals.size(); ++i) {
    const glm::dvec3 n = cofactors * glm::dvec3(from.normals[i]);
    normal_at[i] = add_normal(into, determinant < 0.0 ? -n : n);
  }
  for (std::size_t i = 0; i < from.triangles.size(); ++i) {
    Corners corners = from.triangles[i];
    Corners normals = from.triangle_normals.empty() ? kFlat : from.triangle_normals[i];
    for (std::size_t k = 0; k < 3; ++k) {
      corners[k] += first_vertex;
      normals[k] = normals[k] == kNoIndex ? kNoIndex : normal_at[normals[k]];
    }
    if (determinant < 0.0) {
      std::swap(corners[1], corners[2]);
      std::swap(normals[1], normals[2]);
    }
    add_triangle(into, corners,
                 placement.material.value_or(placement.first_material + from.triangle_materials[i]),
                 normals);
  }
  return {};
}

void make_flat(Scene& scene) {
  scene.normals.clear();
  scene.triangle_normals.clear();
}

void add_default_lights(Scene& scene) {
  Light key;
  key.kind = Light::Kind::kDirectional;
  key.direction = glm::dvec3(0.5, -0.8, -0.7);
  key.colour = glm::vec3(0.85F);
  Light fill = key;
  fill.direction = glm::dvec3(-0.8, -0.3, -0.5);
  fill.colour = glm::vec3(0.3F);
  scene.lights.push_back(key);
  scene.lights.push_back(fill);
}

}  // namespace gridrt::scene_detail
