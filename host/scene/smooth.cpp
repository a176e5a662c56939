#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <tuple>
#include <vector>

#include <glm/geometric.hpp>

#include "host/scene/assemble.hpp"

namespace gridrt::scene_detail {
namespace {

double angle_between(const glm::dvec3& a, const glm::dvec3& b) {
  return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
}

// For every vertex, the number of its position among the distinct ones.
std::vector<std::uint32_t> weld(const std::vector<glm::vec3>& positions) {
  std::vector<std::uint32_t> order(positions.size());
  std::iota(order.begin(), order.end(), 0U);
  const auto key = [&](std::uint32_t i) {
    return std::tuple(positions[i].x, positions[i].y, positions[i].z);
  };
  std::sort(order.begin(), order.end(),
            [&](std::uint32_t a, std::uint32_t b) { return key(a) < key(b); });
  std::vector<std::uint32_t> number(positions.size());
  std::uint32_t distinct = 0;
  for (std::size_t i = 0; i < order.size(); ++i) {
    if (i > 0 && key(order[i]) != key(order[i - 1])) {
      ++distinct;
    }
    number[order[i]] = distinct;
  }
  return number;
}

}  // namespace

void make_smooth(Scene& scene) {
  make_flat(scene);
  const std::vector<std::uint32_t> number = weld(scene.positions);
  std::vector<glm::dvec3> sums(scene.positions.size(), glm::dvec3(0.0));
  for (const Corners& corners : scene.triangles) {
    std::array<glm::dvec3, 3> p;
    for (std::size_t k = 0; k < 3; ++k) {
      p[k] = glm::dvec3(scene.positions[corners[k]]);
    }
    const glm::dvec3 normal = glm::cross(p[1] - p[0], p[2] - p[0]);
    const double length = glm::length(normal);
    if (!(length > 0.0)) {
      continue;
    }
    for (std::size_t k = 0; k < 3; ++k) {
      const glm::dvec3 to_next = p[(k + 1) % 3] - p[k];
      const glm::dvec3 to_last = p[(k + 2) % 3] - p[k];
      sums[number[corners[k]]] += normal * (angle_between(to_next, to_last) / length);
    }
  }
  std::vector<std::uint32_t> normal_of(sums.size());
  for (std::size_t i = 0; i < sums.size(); ++i) {
    normal_of[i] = add_normal(scene, sums[i]);
  }
  scene.triangle_normals.assign(scene.triangles.size(), kFlat);
  for (std::size_t i = 0; i < scene.triangles.size(); ++i) {
    Corners normals{};
    bool smooth = true;
    for (std::size_t k = 0; k < 3; ++k) {
      normals[k] = normal_of[number[scene.triangles[i][k]]];
      smooth = smooth && normals[k] != kNoIndex;
    }
    if (smooth) {
      scene.triangle_normals[i] = normals;
    }
  }
}

}  // namespace gridrt::scene_detail
