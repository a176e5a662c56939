#include "tests/bench/workload.hpp"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "host/render/camera.hpp"
#include "tests/adversarial/meshes.hpp"
#include "tests/adversarial/random.hpp"

namespace gridrt::bench {
namespace {

using adversarial::Random;

glm::dvec3 rounded(const glm::dvec3& x) { return glm::dvec3{glm::vec3{x}}; }

}  // namespace

Scene repeat(const Scene& mesh, int copies) {
  if (copies == 1) return mesh;
  glm::vec3 lo{INFINITY};
  glm::vec3 hi{-INFINITY};
  for (const auto& triangle : mesh.triangles) {
    for (const std::uint32_t v : triangle) {
      lo = glm::min(lo, mesh.positions[v]);
      hi = glm::max(hi, mesh.positions[v]);
    }
  }
  Scene out;
  const int across = 3;
  for (int i = 0; i < copies; ++i) {
    const glm::vec3 place{i % across, i / across % across, i / (across * across)};
    adversarial::add_scene(out, mesh, 1.0F, place * (hi - lo) * 1.1F);
  }
  return out;
}

RaySet primary_rays(const Scene& scene, int width, int height) {
  const double aspect = static_cast<double>(width) / height;
  const auto camera = PinholeCamera::create(frame_scene(scene, aspect), width, height).value();
  RaySet set{"primary", true, {}};
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      Ray ray = camera.ray(x, y, sample_position(0, 1));
      ray.origin = rounded(ray.origin);
      ray.direction = rounded(ray.direction);
      set.rays.push_back(ray);
    }
  }
  return set;
}

RaySet shuffled(const RaySet& rays) {
  RaySet set{"shuffled", false, rays.rays};
  Random random(1);
  for (std::size_t i = set.rays.size(); i > 1; --i) {
    std::swap(set.rays[i - 1], set.rays[random.below(i)]);
  }
  return set;
}

RaySet bounced_rays(const Scene& scene, const RaySet& rays, const std::vector<Hit>& hits) {
  RaySet set{"bounced", false, {}};
  Random random(2);
  for (std::size_t i = 0; i < hits.size(); ++i) {
    if (hits[i].id < 0) continue;
    const auto& v = scene.triangles[static_cast<std::size_t>(hits[i].id)];
    const glm::dvec3 a{scene.positions[v[0]]};
    const glm::dvec3 e1 = glm::dvec3{scene.positions[v[1]]} - a;
    const glm::dvec3 e2 = glm::dvec3{scene.positions[v[2]]} - a;
    glm::dvec3 n = glm::normalize(glm::cross(e1, e2));
    if (glm::dot(n, rays.rays[i].direction) > 0) n = -n;
    const glm::dvec3 way = n * 1.0001 + random.direction();
    const glm::dvec3 at = a + hits[i].u * e1 + hits[i].v * e2;
    const double off = 1e-3 * std::sqrt(glm::length(e1) * glm::length(e2)) + 1e-5 * glm::length(at);
    set.rays.push_back({rounded(at + off * n), rounded(glm::normalize(way))});
  }
  return set;
}

}  // namespace gridrt::bench
