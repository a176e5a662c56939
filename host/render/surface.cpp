#include "host/render/surface.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "host/grid/intersect.hpp"
#include "host/render/camera.hpp"

namespace gridrt {
namespace {

/// Normal (v1 - v0) x (v2 - v0) on the lattice: 51 bits at most, so exact.
std::array<std::int64_t, 3> lattice_normal(const LatticeTriangle& triangle) {
  std::array<std::int64_t, 3> a{};
  std::array<std::int64_t, 3> b{};
  for (int i = 0; i < 3; ++i) {
    const auto axis = static_cast<std::size_t>(i);
    a[axis] = triangle.v[1][i] - triangle.v[0][i];
    b[axis] = triangle.v[2][i] - triangle.v[0][i];
  }
  return {(a[1] * b[2]) - (a[2] * b[1]), (a[2] * b[0]) - (a[0] * b[2]),
          (a[0] * b[1]) - (a[1] * b[0])};
}

}  // namespace

Result<SurfaceTable> SurfaceTable::create(const Scene& scene, const Lattice& lattice,
                                          const ImageTriangles& triangles) {
  const std::size_t count = scene.triangles.size();
  const auto refuse = [](std::string message) {
    return fail(ErrorKind::kInput, "scene: " + std::move(message));
  };
  if (scene.materials.empty()) return refuse("there is no material");
  if (scene.triangle_materials.size() != count) return refuse("not every triangle has a material");
  if (!scene.triangle_normals.empty() && scene.triangle_normals.size() != count) {
    return refuse("not every triangle has an entry for normals");
  }
  for (std::size_t i = 0; i < count; ++i) {
    if (scene.triangle_materials[i] >= scene.materials.size()) {
      return refuse(fmt::format("triangle {} has material {} of {}", i, scene.triangle_materials[i],
                                scene.materials.size()));
    }
    for (const std::uint32_t vertex : scene.triangles[i]) {
      if (vertex >= scene.positions.size()) {
        return refuse(
            fmt::format("triangle {} has vertex {} of {}", i, vertex, scene.positions.size()));
      }
    }
    if (scene.triangle_normals.empty()) continue;
    for (const std::uint32_t normal : scene.triangle_normals[i]) {
      if (normal != kNoIndex && normal >= scene.normals.size()) {
        return refuse(
            fmt::format("triangle {} has normal {} of {}", i, normal, scene.normals.size()));
      }
    }
  }
  SurfaceTable table;
  table.scene_ = &scene;
  table.triangles_ = &triangles;
  table.locals_.assign(count, kNoIndex);
  for (std::size_t i = 0; i < triangles.global_ids.size(); ++i) {
    const std::uint32_t id = triangles.global_ids[i];
    if (id >= count) return refuse(fmt::format("the image knows triangle {} of {}", id, count));
    table.locals_[id] = static_cast<std::uint32_t>(i);
  }
  const int most = std::max({lattice.scale.x, lattice.scale.y, lattice.scale.z});
  for (int i = 0; i < 3; ++i) table.scale_[i] = std::scalbn(1.0, lattice.scale[i] - most);
  return table;
}

glm::dvec3 SurfaceTable::shading_normal(std::size_t id, double u, double v) const {
  glm::dvec3 normal(0.0);
  if (!scene_->triangle_normals.empty()) {
    const auto& n = scene_->triangle_normals[id];
    if (n[0] != kNoIndex && n[1] != kNoIndex && n[2] != kNoIndex) {
      normal = (glm::dvec3(scene_->normals[n[0]]) * (1.0 - u - v)) +
               (glm::dvec3(scene_->normals[n[1]]) * u) + (glm::dvec3(scene_->normals[n[2]]) * v);
      if (normalise(normal)) return normal;
    }
  }
  const auto& corners = scene_->triangles[id];
  const glm::dvec3 a(scene_->positions[corners[0]]);
  normal = glm::cross(glm::dvec3(scene_->positions[corners[1]]) - a,
                      glm::dvec3(scene_->positions[corners[2]]) - a);
  normalise(normal);  // stays zero where the scene's own triangle has no area
  return normal;
}

Surface SurfaceTable::at(const Ray& ray, const Segment& segment, const Hit& hit) const {
  const auto id = static_cast<std::size_t>(hit.id);
  const auto n = lattice_normal(triangle(hit.id));
  Int128 along = 0;
  for (int i = 0; i < 3; ++i) {
    along += static_cast<Int128>(n[static_cast<std::size_t>(i)]) * (segment.p1[i] - segment.p0[i]);
  }
  Surface surface;
  surface.point = ray.origin + (ray.direction * hit.t);
  surface.front = along < 0;
  surface.geometric = glm::dvec3(n[0], n[1], n[2]) * scale_;
  normalise(surface.geometric);
  if (!surface.front) surface.geometric = -surface.geometric;
  surface.normal = shading_normal(id, hit.u, hit.v);
  const double side = glm::dot(surface.normal, surface.geometric);
  if (side < 0.0) surface.normal = -surface.normal;
  if (side == 0.0) surface.normal = surface.geometric;
  surface.material = &scene_->materials[scene_->triangle_materials[id]];
  return surface;
}

}  // namespace gridrt
