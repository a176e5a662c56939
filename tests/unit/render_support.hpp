// Small scenes, and a device that is nothing but brute force, for the tests of the renderer.
#pragma once

#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <glm/geometric.hpp>

#include "host/driver/device.hpp"
#include "host/grid/intersect.hpp"
#include "host/render/waves.hpp"

namespace gridrt::test {

/// Answers by the definition: the smallest key over all triangles. Remembers what it was asked.
class BruteDevice final : public Device {
 public:
  explicit BruteDevice(const ImageTriangles& triangles) : triangles_(triangles) {}

  Result<void> load(const Image& /*image*/) override { return {}; }

  Result<void> trace(std::span<const Segment> segments, Query query, std::span<Hit> hits) override {
    ++batches;
    asked.insert(asked.end(), segments.begin(), segments.end());
    for (std::size_t i = 0; i < segments.size(); ++i) hits[i] = answer(segments[i], query);
    if (broken_id) hits.front().id = *broken_id;
    return {};
  }

  Result<DeviceCounters> counters() override { return DeviceCounters{}; }
  [[nodiscard]] std::string name() const override { return "brute"; }
  [[nodiscard]] const protocol::CapabilitiesReport& capabilities() const override {
    return capabilities_;
  }

  int batches = 0;
  std::vector<Segment> asked;             ///< all segments so far
  std::optional<std::int32_t> broken_id;  ///< answered once in each batch instead of the truth

 private:
  [[nodiscard]] Hit answer(const Segment& segment, Query query) const {
    std::optional<ExactHit> best;
    HitKey key;
    if (!segment.is_miss()) {
      for (std::size_t i = 0; i < triangles_.triangles.size(); ++i) {
        if (triangles_.global_ids[i] == segment.ignore) continue;
        const auto hit = intersect_exact(segment.p0, segment.p1, triangles_.triangles[i]);
        if (!hit) continue;
        const HitKey found{hit_quotient(*hit), triangles_.global_ids[i]};
        if (!best || found < key) {
          best = hit;
          key = found;
        }
      }
    }
    if (query == Query::kAnyHit) {
      constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
      return {best ? 0 : -1, kNan, kNan, kNan};
    }
    if (!best) return {};
    const HitParameters p = hit_parameters(segment, *best);
    return {static_cast<std::int32_t>(key.id), p.t, p.u, p.v};
  }

  const ImageTriangles& triangles_;
  protocol::CapabilitiesReport capabilities_;
};

/// A scene under construction.
class SceneMaker {
 public:
  SceneMaker() { scene.materials.resize(1); }

  /// A triangle of vertices in this order.
  void triangle(glm::vec3 a, glm::vec3 b, glm::vec3 c, std::uint32_t material = 0) {
    const auto first = static_cast<std::uint32_t>(scene.positions.size());
    scene.positions.insert(scene.positions.end(), {a, b, c});
    scene.triangles.push_back({first, first + 1, first + 2});
    scene.triangle_materials.push_back(material);
  }

  /// Two triangles; seen from the side that (b - a) x (c - a) points to, a to d are anticlockwise.
  void quad(glm::vec3 a, glm::vec3 b, glm::vec3 c, glm::vec3 d, std::uint32_t material = 0) {
    triangle(a, b, c, material);
    triangle(a, c, d, material);
  }

  /// Six quads whose fronts are outside.
  void box(glm::vec3 lo, glm::vec3 hi, std::uint32_t material = 0) {
    const auto p = [&](int x, int y, int z) {
      return glm::vec3(x != 0 ? hi.x : lo.x, y != 0 ? hi.y : lo.y, z != 0 ? hi.z : lo.z);
    };
    quad(p(0, 0, 0), p(0, 0, 1), p(0, 1, 1), p(0, 1, 0), material);
    quad(p(1, 0, 0), p(1, 1, 0), p(1, 1, 1), p(1, 0, 1), material);
    quad(p(0, 0, 0), p(1, 0, 0), p(1, 0, 1), p(0, 0, 1), material);
    quad(p(0, 1, 0), p(0, 1, 1), p(1, 1, 1), p(1, 1, 0), material);
    quad(p(0, 0, 0), p(0, 1, 0), p(1, 1, 0), p(1, 0, 0), material);
    quad(p(0, 0, 1), p(1, 0, 1), p(1, 1, 1), p(0, 1, 1), material);
  }

  Scene scene;
};

/// Everything that rendering a scene by brute force needs.
struct BruteScene {
  explicit BruteScene(Scene given, int bits = kDefaultBits) : scene(std::move(given)) {
    lattice = make_lattice(scene.positions, scene.triangles, bits).value();
    for (std::uint32_t id = 0; id < scene.triangles.size(); ++id) {
      LatticeTriangle triangle{};
      for (std::size_t k = 0; k < 3; ++k) {
        triangle.v[k] = snap(lattice, scene.positions[scene.triangles[id][k]]);
      }
      if (is_degenerate(triangle)) continue;
      triangles.triangles.push_back(triangle);
      triangles.global_ids.push_back(id);
    }
  }

  /// The film, or the test ends with the error's message.
  Film render_film(const Camera& camera, const RenderOptions& options) {
    const auto pinhole = PinholeCamera::create(camera, options.width, options.height).value();
    BruteDevice device(triangles);
    report = {};
    return render({scene, lattice, triangles, pinhole}, options, device, report).value();
  }

  Scene scene;
  Lattice lattice;
  ImageTriangles triangles;
  RenderReport report;
};

/// A material that reflects nothing but what the test sets.
inline Material black() {
  Material material;
  material.ambient = glm::vec3(0.0F);
  material.diffuse = glm::vec3(0.0F);
  return material;
}

}  // namespace gridrt::test
