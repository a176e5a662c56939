#include "tests/adversarial/meshes.hpp"

#include <algorithm>
#include <numbers>

namespace gridrt::adversarial {

std::uint32_t add_vertex(Scene& scene, const glm::vec3& p) {
  scene.positions.push_back(p);
  return static_cast<std::uint32_t>(scene.positions.size() - 1);
}

void add_triangle(Scene& scene, std::uint32_t a, std::uint32_t b, std::uint32_t c) {
  if (scene.materials.empty()) scene.materials.emplace_back();
  scene.triangles.push_back({a, b, c});
  scene.triangle_materials.push_back(0);
}

void add_triangle(Scene& scene, const glm::vec3& a, const glm::vec3& b, const glm::vec3& c) {
  const std::uint32_t first = add_vertex(scene, a);
  add_vertex(scene, b);
  add_vertex(scene, c);
  add_triangle(scene, first, first + 1, first + 2);
}

void add_scene(Scene& scene, const Scene& part, float scale, const glm::vec3& move) {
  const auto first = static_cast<std::uint32_t>(scene.positions.size());
  for (const auto& p : part.positions) scene.positions.push_back(p * scale + move);
  for (const auto& t : part.triangles)
    add_triangle(scene, t[0] + first, t[1] + first, t[2] + first);
}

Scene sheet(int n, double jitter, Random& random) {
  Scene scene;
  const double cell = 1.0 / n;
  const auto moved = [&](double x, double y, bool interior) {
    glm::dvec3 p{x, y, 0.0};
    if (interior) {
      p += cell * jitter * random.in_box(glm::dvec3{-1.0}, glm::dvec3{1.0});
    }
    return add_vertex(scene, glm::vec3{p});
  };
  std::vector<std::uint32_t> corner;
  for (int y = 0; y <= n; ++y) {
    for (int x = 0; x <= n; ++x) {
      corner.push_back(moved(x * cell, y * cell, x > 0 && x < n && y > 0 && y < n));
    }
  }
  const auto at = [&](int x, int y) {
    return corner[static_cast<std::size_t>(y) * static_cast<std::size_t>(n + 1) +
                  static_cast<std::size_t>(x)];
  };
  for (int y = 0; y < n; ++y) {
    for (int x = 0; x < n; ++x) {
      const std::uint32_t middle = moved((x + 0.5) * cell, (y + 0.5) * cell, true);
      add_triangle(scene, at(x, y), at(x + 1, y), middle);
      add_triangle(scene, at(x + 1, y), at(x + 1, y + 1), middle);
      add_triangle(scene, at(x + 1, y + 1), at(x, y + 1), middle);
      add_triangle(scene, at(x, y + 1), at(x, y), middle);
    }
  }
  return scene;
}

Scene sphere(int stacks, int slices, const glm::vec3& centre, float radius) {
  Scene scene;
  const auto ring = [&](int stack, int slice) {
    const double a = std::numbers::pi * stack / stacks;
    const double b = 2.0 * std::numbers::pi * (slice % slices) / slices;
    const glm::dvec3 p{std::sin(a) * std::cos(b), std::cos(a), std::sin(a) * std::sin(b)};
    return glm::vec3{glm::dvec3{centre} + double{radius} * p};
  };
  const std::uint32_t top = add_vertex(scene, centre + glm::vec3{0, radius, 0});
  const std::uint32_t bottom = add_vertex(scene, centre - glm::vec3{0, radius, 0});
  for (int i = 1; i < stacks; ++i) {
    for (int j = 0; j < slices; ++j) add_vertex(scene, ring(i, j));
  }
  const auto at = [&](int stack, int slice) {
    return static_cast<std::uint32_t>(2 + (stack - 1) * slices + slice % slices);
  };
  for (int j = 0; j < slices; ++j) {
    add_triangle(scene, top, at(1, j + 1), at(1, j));
    add_triangle(scene, bottom, at(stacks - 1, j), at(stacks - 1, j + 1));
    for (int i = 1; i + 1 < stacks; ++i) {
      add_triangle(scene, at(i, j), at(i, j + 1), at(i + 1, j + 1));
      add_triangle(scene, at(i, j), at(i + 1, j + 1), at(i + 1, j));
    }
  }
  return scene;
}

Scene box(int n, const glm::vec3& lo, const glm::vec3& hi) {
  Scene scene;
  const auto coordinate = [&](int axis, int k) {
    return k == n
               ? hi[axis]
               : lo[axis] + (hi[axis] - lo[axis]) * static_cast<float>(k) / static_cast<float>(n);
  };
  for (int axis = 0; axis < 3; ++axis) {
    const int b = (axis + 1) % 3;
    const int c = (axis + 2) % 3;
    for (const bool high : {false, true}) {
      const auto corner = [&](int j, int k) {
        glm::vec3 p;
        p[axis] = high ? hi[axis] : lo[axis];
        p[b] = coordinate(b, j);
        p[c] = coordinate(c, k);
        return p;
      };
      for (int j = 0; j < n; ++j) {
        for (int k = 0; k < n; ++k) {
          add_triangle(scene, corner(j, k), corner(j + 1, k), corner(j + 1, k + 1));
          add_triangle(scene, corner(j, k), corner(j + 1, k + 1), corner(j, k + 1));
        }
      }
    }
  }
  return scene;
}

Scene fan(int valence, float bend, Random& random) {
  Scene scene;
  const std::uint32_t hub = add_vertex(scene, glm::vec3{0.0F});
  for (int i = 0; i < valence; ++i) {
    const double a = 2.0 * std::numbers::pi * i / valence;
    const double r = random.uniform(0.5, 1.0);
    add_vertex(scene, glm::vec3{glm::dvec3{r * std::cos(a), r * std::sin(a),
                                           double{bend} * random.uniform(-1.0, 1.0)}});
  }
  for (int i = 0; i < valence; ++i) {
    add_triangle(scene, hub, hub + 1 + static_cast<std::uint32_t>(i),
                 hub + 1 + static_cast<std::uint32_t>((i + 1) % valence));
  }
  return scene;
}

Scene soup(int triangles, double octaves, Random& random) {
  Scene scene;
  for (int i = 0; i < triangles; ++i) {
    const glm::dvec3 centre = random.in_box(glm::dvec3{0.0}, glm::dvec3{1.0});
    const double size = std::exp2(-octaves * random.unit());
    const auto corner = [&] {
      return glm::vec3{centre + size * random.in_box(glm::dvec3{-0.5}, glm::dvec3{0.5})};
    };
    const glm::vec3 a = corner();
    const glm::vec3 b = corner();
    add_triangle(scene, a, b, corner());
  }
  return scene;
}

Scene lattice_soup(int triangles, int steps, Random& random) {
  Scene scene;
  const auto corner = [&] {
    const int x = random.between(0, steps);
    const int y = random.between(0, steps);
    return glm::vec3{glm::ivec3{x, y, random.between(0, steps)}};
  };
  for (int i = 0; i < triangles; ++i) {
    const glm::vec3 a = corner();
    const glm::vec3 b = corner();
    add_triangle(scene, a, b, corner());
  }
  return scene;
}

Scene slivers(int triangles, double aspect, Random& random) {
  Scene scene;
  for (int i = 0; i < triangles; ++i) {
    const glm::dvec3 a = random.in_box(glm::dvec3{0.0}, glm::dvec3{1.0});
    const glm::dvec3 along = random.direction() * random.uniform(0.2, 1.0);
    const glm::dvec3 across = random.direction() / aspect;
    if (i % 2 == 0) {  // needle: one short edge
      add_triangle(scene, glm::vec3{a}, glm::vec3{a + along}, glm::vec3{a + along + across});
    } else {  // cap: one corner almost on the opposite edge
      add_triangle(scene, glm::vec3{a}, glm::vec3{a + along},
                   glm::vec3{a + along * random.uniform(0.1, 0.9) + across});
    }
  }
  return scene;
}

NamedScene any_scene(Random& random, int most_triangles) {
  const int n = random.between(1, std::max(1, most_triangles));
  const auto root = static_cast<int>(std::sqrt(n / 4.0));
  switch (random.below(9)) {
    case 0:
      return {"sheet", sheet(std::max(1, root), random.uniform(0.0, 0.4), random)};
    case 1:
      return {"sphere", sphere(std::max(3, root), std::max(3, 2 * root),
                               glm::vec3{random.in_box(glm::dvec3{-9.0}, glm::dvec3{9.0})}, 1.5F)};
    case 2:
      return {"box", box(std::max(1, root / 2), glm::vec3{-1.0F, 0.0F, 2.0F},
                         glm::vec3{1.0F, 1.5F, 2.0F + static_cast<float>(random.unit())})};
    case 3:
      return {"fan", fan(random.between(3, 64), random.chance(0.5) ? 0.0F : 0.3F, random)};
    case 4:
      return {"lattice soup", lattice_soup(n, random.between(1, 12), random)};
    case 5:
      return {"slivers", slivers(n, std::pow(10.0, random.uniform(3.0, 12.0)), random)};
    case 6: {  // a small mesh in a large box, and one stray vertex
      Scene scene = sphere(std::max(3, root), std::max(3, root), glm::vec3{0.5F}, 0.01F);
      add_triangle(scene, glm::vec3{0.0F}, glm::vec3{1.0F}, glm::vec3{0.0F, 1.0F, 0.5F});
      return {"small in large", scene};
    }
    case 7: {  // flat along one axis, long along another
      Scene scene;
      add_scene(scene, soup(n, 4.0, random));
      const int flat = random.between(0, 2);
      for (auto& p : scene.positions) {
        p[flat] = random.chance(0.3) ? 0.25F : p[flat] * 1e-4F;
        p[(flat + 1) % 3] *= 1000.0F;
      }
      return {"flat", scene};
    }
    default:
      return {"soup", soup(n, random.uniform(0.0, 12.0), random)};
  }
}

}  // namespace gridrt::adversarial
