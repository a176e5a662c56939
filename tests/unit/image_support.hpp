// Small scenes for the tests of images.
#pragma once

#include <random>

#include <gtest/gtest.h>

#include "host/image/image.hpp"

namespace gridrt {

/// Adds a triangle with vertices of its own.
inline void add_triangle(Scene& scene, const glm::vec3& a, const glm::vec3& b, const glm::vec3& c) {
  const auto base = static_cast<std::uint32_t>(scene.positions.size());
  for (const glm::vec3& v : {a, b, c}) scene.positions.push_back(v);
  scene.triangles.push_back({base, base + 1, base + 2});
  scene.triangle_materials.push_back(0);
}

/// A number in [0, 1), the same with every library.
inline float unit(std::mt19937& random) { return static_cast<float>(random() >> 8U) * 0x1p-24F; }

inline glm::vec3 random_point(std::mt19937& random) {
  const float x = unit(random);
  const float y = unit(random);
  return {x, y, unit(random)};
}

/// Random triangles of about `size` in the unit cube; every seventh is degenerate.
inline Scene random_scene(std::size_t triangles, unsigned seed, float size = 0.2F) {
  std::mt19937 random(seed);
  Scene scene;
  scene.materials.emplace_back();
  for (std::size_t i = 0; i < triangles; ++i) {
    const glm::vec3 a = random_point(random);
    const glm::vec3 b = a + size * random_point(random);
    const glm::vec3 c = i % 7 == 3 ? b : a + size * random_point(random);
    add_triangle(scene, a, b, c);
  }
  return scene;
}

/// A sheet of nx x ny quads over the unit square, bent, vertices shared.
inline Scene sheet_scene(std::uint32_t nx, std::uint32_t ny, float height = 0.1F) {
  Scene scene;
  scene.materials.emplace_back();
  for (std::uint32_t y = 0; y <= ny; ++y) {
    for (std::uint32_t x = 0; x <= nx; ++x) {
      const float u = static_cast<float>(x) / static_cast<float>(nx);
      const float v = static_cast<float>(y) / static_cast<float>(ny);
      scene.positions.emplace_back(u, v, height * u * v);
    }
  }
  for (std::uint32_t y = 0; y < ny; ++y) {
    for (std::uint32_t x = 0; x < nx; ++x) {
      const std::uint32_t i = y * (nx + 1) + x;
      scene.triangles.push_back({i, i + 1, i + nx + 2});
      scene.triangles.push_back({i, i + nx + 2, i + nx + 1});
    }
  }
  scene.triangle_materials.assign(scene.triangles.size(), 0);
  return scene;
}

/// The image, or a failed test and an empty one.
inline Image must_build(const Scene& scene, const ImageOptions& options = {}) {
  auto image = build_image(scene, options);
  if (!image) {
    ADD_FAILURE() << image.error().message;
    return {};
  }
  return std::move(*image);
}

}  // namespace gridrt
