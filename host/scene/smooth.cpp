#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <span>
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

// Unit normal of a triangle times its angle at each corner; zeros for one without area.
std::array<glm::dvec3, 3> corner_normals(const Scene& scene, std::size_t triangle) {
  std::array<glm::dvec3, 3> p{};
  for (std::size_t k = 0; k < 3; ++k) {
    p[k] = glm::dvec3(scene.positions[scene.triangles[triangle][k]]);
  }
  const glm::dvec3 normal = glm::cross(p[1] - p[0], p[2] - p[0]);
  const double length = glm::length(normal);
  std::array<glm::dvec3, 3> parts{};
  for (std::size_t k = 0; k < 3 && length > 0.0; ++k) {
    parts[k] = normal * (angle_between(p[(k + 1) % 3] - p[k], p[(k + 2) % 3] - p[k]) / length);
  }
  return parts;
}

}  // namespace

void make_smooth(Scene& scene, std::span<const std::uint32_t> groups) {
  scene.triangle_normals.resize(scene.triangles.size(), kFlat);
  const std::vector<std::uint32_t> number = weld(scene.positions);
  const auto wanted = [&](std::size_t i) {
    return (groups.empty() || groups[i] != 0) && scene.triangle_normals[i] == kFlat;
  };
  // A vertex in a group has a normal of its own: the key of the two.
  const auto key = [&](std::size_t i, std::size_t k) {
    const std::uint64_t group = groups.empty() ? 0 : groups[i];
    return group << 32 | number[scene.triangles[i][k]];
  };
  std::vector<std::uint64_t> keys;
  for (std::size_t i = 0; i < scene.triangles.size(); ++i) {
    for (std::size_t k = 0; k < 3 && wanted(i); ++k) {
      keys.push_back(key(i, k));
    }
  }
  std::sort(keys.begin(), keys.end());
  keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
  const auto slot = [&](std::size_t i, std::size_t k) {
    return static_cast<std::size_t>(std::lower_bound(keys.begin(), keys.end(), key(i, k)) -
                                    keys.begin());
  };
  std::vector<glm::dvec3> sums(keys.size(), glm::dvec3(0.0));
  for (std::size_t i = 0; i < scene.triangles.size(); ++i) {
    if (wanted(i)) {
      const std::array<glm::dvec3, 3> parts = corner_normals(scene, i);
      for (std::size_t k = 0; k < 3; ++k) {
        sums[slot(i, k)] += parts[k];
      }
    }
  }
  std::vector<std::uint32_t> normal_of(sums.size());
  std::transform(sums.begin(), sums.end(), normal_of.begin(),
                 [&](const glm::dvec3& sum) { return add_normal(scene, sum); });
  for (std::size_t i = 0; i < scene.triangles.size(); ++i) {
    if (wanted(i)) {
      const Corners normals = {normal_of[slot(i, 0)], normal_of[slot(i, 1)], normal_of[slot(i, 2)]};
      const bool smooth = std::find(normals.begin(), normals.end(), kNoIndex) == normals.end();
      scene.triangle_normals[i] = smooth ? normals : kFlat;
    }
  }
}

}  // namespace gridrt::scene_detail
