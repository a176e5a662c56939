// Built-in scenes of a single simple shape.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <numbers>
#include <utility>

#include <glm/geometric.hpp>

#include "host/scene/assemble.hpp"
#include "host/scene/builtin.hpp"

namespace gridrt::scene_detail {
namespace {

constexpr double kFar = 1e37;  // leaves room within float32 for a size on top of a place

Result<Scene> make_empty(const BuiltinValues&) { return {}; }

Result<Scene> make_triangle(const BuiltinValues& values) {
  Scene scene;
  const double s = values.real("size");
  add_vertex(scene, {-s, -s, 0.0});
  add_vertex(scene, {s, -s, 0.0});
  add_vertex(scene, {0.0, s, 0.0});
  add_triangle(scene, {0, 1, 2});
  return scene;
}

Result<Scene> make_quad(const BuiltinValues& values) {
  Scene scene;
  const double s = values.real("size") / 2.0;
  const int axis = values.choice("axis")[0] - 'x';
  const glm::dvec3 centre = values.vector("centre");
  std::array<glm::dvec3, 4> corners{};
  constexpr int kSigns[4][2] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
  for (std::size_t i = 0; i < 4; ++i) {
    corners[i] = centre;
    corners[i][(axis + 1) % 3] += s * kSigns[i][0];
    corners[i][(axis + 2) % 3] += s * kSigns[i][1];
  }
  add_quad(scene, corners, 0);
  return scene;
}

Result<Scene> make_cube(const BuiltinValues& values) {
  Scene scene;
  const glm::dvec3 half = values.vector("size") * 0.5;
  add_box(scene, values.vector("centre") - half, values.vector("centre") + half, 0);
  return scene;
}

// A sphere of rings of latitude: the poles are shared by `segments` thin triangles.
void add_uv_sphere(Scene& scene, const glm::dvec3& centre, double radius, std::uint32_t segments,
                   bool smooth) {
  const std::uint32_t rings = segments / 2;
  const auto add = [&](const glm::dvec3& unit) {
    if (smooth) {
      add_normal(scene, unit);
    }
    return add_vertex(scene, centre + unit * radius);
  };
  const auto triangle = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    const Corners corners{a, b, c};
    add_triangle(scene, corners, 0, smooth ? corners : kFlat);
  };
  const std::uint32_t north = add({0.0, 1.0, 0.0});
  for (std::uint32_t r = 1; r < rings; ++r) {
    const double theta = std::numbers::pi * r / rings;
    for (std::uint32_t i = 0; i < segments; ++i) {
      const double phi = 2.0 * std::numbers::pi * i / segments;
      add({std::sin(theta) * std::cos(phi), std::cos(theta), -std::sin(theta) * std::sin(phi)});
    }
  }
  const std::uint32_t south = add({0.0, -1.0, 0.0});
  const auto at = [&](std::uint32_t r, std::uint32_t i) {
    return north + 1 + (r - 1) * segments + i % segments;
  };
  for (std::uint32_t i = 0; i < segments; ++i) {
    triangle(north, at(1, i), at(1, i + 1));
    for (std::uint32_t r = 1; r + 1 < rings; ++r) {
      triangle(at(r, i), at(r + 1, i), at(r + 1, i + 1));
      triangle(at(r, i), at(r + 1, i + 1), at(r, i + 1));
    }
    triangle(at(rings - 1, i), south, at(rings - 1, i + 1));
  }
}

Result<Scene> make_sphere(const BuiltinValues& values) {
  Scene scene;
  const bool smooth = values.integer("smooth") == 1;
  if (values.choice("kind") == "uv") {
    add_uv_sphere(scene, values.vector("centre"), values.real("radius"), values.integer("segments"),
                  smooth);
  } else {
    add_icosphere(scene, values.vector("centre"), values.real("radius"),
                  values.integer("subdivisions"), 0, smooth);
  }
  return scene;
}

// The sheet of the Vulkan conformance tests for watertightness: the square [-1, 1]^2 cut into cells
// of two triangles, inner vertices jittered. With a jitter of j cells, twice the area of a triangle
// is at least (1 - 2j)^2 - (2j)^2 = 1 - 4j in cells, so that below 1/4 nothing folds.
Result<Scene> make_sheet(const BuiltinValues& values) {
  Scene scene;
  const std::uint32_t cells = std::max(values.integer("triangles") / 2, 1U);
  auto columns = static_cast<std::uint32_t>(std::sqrt(static_cast<double>(cells)));
  while (cells % columns != 0) {
    --columns;
  }
  const std::uint32_t rows = cells / columns;
  SplitMix64 random(values.integer("seed"));
  const double jitter = values.real("jitter");
  const double depth = values.real("depth");
  const double height = 2.0 / rows;
  const double width = 2.0 / columns;
  for (std::uint32_t j = 0; j <= rows; ++j) {
    for (std::uint32_t i = 0; i <= columns; ++i) {
      const double dx = random.uniform(-jitter, jitter) * width;
      const double dy = random.uniform(-jitter, jitter) * height;
      const double dz = random.uniform(-depth, depth);
      const bool side = i == 0 || i == columns;
      const bool end = j == 0 || j == rows;
      add_vertex(scene, {-1.0 + i * width + (side ? 0.0 : dx), -1.0 + j * height + (end ? 0.0 : dy),
                         side || end ? 0.0 : dz});
    }
  }
  for (std::uint32_t j = 0; j < rows; ++j) {
    for (std::uint32_t i = 0; i < columns; ++i) {
      const std::uint32_t a = j * (columns + 1) + i;
      const std::uint32_t d = a + columns + 1;
      // Either diagonal, so that vertices have many valences.
      if ((random.bits() & 1U) == 0) {
        add_triangle(scene, {a, a + 1, d + 1});
        add_triangle(scene, {a, d + 1, d});
      } else {
        add_triangle(scene, {a, a + 1, d});
        add_triangle(scene, {a + 1, d + 1, d});
      }
    }
  }
  return scene;
}

}  // namespace

void add_quad(Scene& scene, const std::array<glm::dvec3, 4>& corners, std::uint32_t material) {
  const std::uint32_t a = add_vertex(scene, corners[0]);
  for (std::size_t i = 1; i < 4; ++i) {
    add_vertex(scene, corners[i]);
  }
  add_triangle(scene, {a, a + 1, a + 2}, material);
  add_triangle(scene, {a, a + 2, a + 3}, material);
}

void add_box(Scene& scene, const glm::dvec3& low, const glm::dvec3& high, std::uint32_t material,
             bool inward) {
  const auto first = static_cast<std::uint32_t>(scene.positions.size());
  for (int i = 0; i < 8; ++i) {
    add_vertex(scene, {(i & 1) != 0 ? high.x : low.x, (i & 2) != 0 ? high.y : low.y,
                       (i & 4) != 0 ? high.z : low.z});
  }
  constexpr std::uint32_t kFaces[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                                          {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
  for (const auto& face : kFaces) {
    const std::uint32_t a = first + face[0];
    const std::uint32_t b = first + face[inward ? 3 : 1];
    const std::uint32_t c = first + face[2];
    const std::uint32_t d = first + face[inward ? 1 : 3];
    add_triangle(scene, {a, b, c}, material);
    add_triangle(scene, {a, c, d}, material);
  }
}

void add_fine_box(Scene& scene, const glm::dvec3& low, const glm::dvec3& high, std::uint32_t cells,
                  std::uint32_t material, bool inward) {
  // All vertices of a side come from one grid per axis, so that sides meet in equal positions.
  const auto at = [&](int axis, std::uint32_t i) {
    return i == cells ? high[axis] : low[axis] + (high[axis] - low[axis]) * i / cells;
  };
  for (int side = 0; side < 6; ++side) {
    const int axis = side / 2;
    const int u = (axis + 1) % 3;
    const int v = (axis + 2) % 3;
    const bool outer = side % 2 == 1;
    const auto point = [&](std::uint32_t i, std::uint32_t j) {
      glm::dvec3 p(0.0);
      p[axis] = outer ? high[axis] : low[axis];
      p[u] = at(u, i);
      p[v] = at(v, j);
      return p;
    };
    for (std::uint32_t j = 0; j < cells; ++j) {
      for (std::uint32_t i = 0; i < cells; ++i) {
        const std::array<glm::dvec3, 4> around = {point(i, j), point(i + 1, j), point(i + 1, j + 1),
                                                  point(i, j + 1)};
        if (outer != inward) {
          add_quad(scene, around, material);
        } else {
          add_quad(scene, {around[3], around[2], around[1], around[0]}, material);
        }
      }
    }
  }
}

void add_icosphere(Scene& scene, const glm::dvec3& centre, double radius,
                   std::uint32_t subdivisions, std::uint32_t material, bool smooth) {
  constexpr double kPhi = std::numbers::phi;
  std::vector<glm::dvec3> points = {{-1, kPhi, 0}, {1, kPhi, 0}, {-1, -kPhi, 0}, {1, -kPhi, 0},
                                    {0, -1, kPhi}, {0, 1, kPhi}, {0, -1, -kPhi}, {0, 1, -kPhi},
                                    {kPhi, 0, -1}, {kPhi, 0, 1}, {-kPhi, 0, -1}, {-kPhi, 0, 1}};
  std::vector<Corners> faces = {{0, 11, 5}, {0, 5, 1},  {0, 1, 7},   {0, 7, 10}, {0, 10, 11},
                                {1, 5, 9},  {5, 11, 4}, {11, 10, 2}, {10, 7, 6}, {7, 1, 8},
                                {3, 9, 4},  {3, 4, 2},  {3, 2, 6},   {3, 6, 8},  {3, 8, 9},
                                {4, 9, 5},  {2, 4, 11}, {6, 2, 10},  {8, 6, 7},  {9, 8, 1}};
  for (glm::dvec3& p : points) {
    p = glm::normalize(p);
  }
  for (std::uint32_t level = 0; level < subdivisions; ++level) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
    const auto middle = [&](std::uint32_t a, std::uint32_t b) {
      const auto [at, added] =
          middles.try_emplace(std::minmax(a, b), static_cast<std::uint32_t>(points.size()));
      if (added) {
        points.push_back(glm::normalize(points[a] + points[b]));
      }
      return at->second;
    };
    std::vector<Corners> finer;
    finer.reserve(faces.size() * 4);
    for (const auto& [a, b, c] : faces) {
      const std::uint32_t ab = middle(a, b);
      const std::uint32_t bc = middle(b, c);
      const std::uint32_t ca = middle(c, a);
      finer.insert(finer.end(), {{a, ab, ca}, {b, bc, ab}, {c, ca, bc}, {ab, bc, ca}});
    }
    faces = std::move(finer);
  }
  const auto first_vertex = static_cast<std::uint32_t>(scene.positions.size());
  const auto first_normal = static_cast<std::uint32_t>(scene.normals.size());
  for (const glm::dvec3& p : points) {
    add_vertex(scene, centre + p * radius);
    if (smooth) {
      add_normal(scene, p);
    }
  }
  for (const Corners& face : faces) {
    Corners corners = face;
    Corners normals = kFlat;
    for (std::size_t k = 0; k < 3; ++k) {
      corners[k] += first_vertex;
      normals[k] = smooth ? face[k] + first_normal : kNoIndex;
    }
    add_triangle(scene, corners, material, normals);
  }
}

std::vector<Builtin> shape_builtins() {
  using enum OptionKind;
  const BuiltinOption centre{"centre", kVector, "0,0,0", -kFar, kFar, "where its middle lies"};
  return {
      {"empty", "no triangle at all", {}, make_empty},
      {"triangle",
       "one triangle in the plane z = 0",
       {{"size", kReal, "1", 0.0, kFar, "half its width"}},
       make_triangle},
      {"quad",
       "two triangles in a plane of two axes, a box of no thickness",
       {{"axis", kChoice, "z", 0, 0, "x|y|z: the axis that it faces"},
        {"size", kReal, "2", 0.0, kFar, "length of its sides"},
        centre},
       make_quad},
      {"cube",
       "a closed box of 12 triangles",
       {{"size", kVector, "2,2,2", 0.0, kFar, "its extents; 1,1000,1000 is a thin slab"}, centre},
       make_cube},
      {"sphere",
       "a closed sphere",
       {{"kind", kChoice, "ico", 0, 0, "ico|uv: geodesic, or rings of latitude"},
        {"subdivisions", kInteger, "3", 0, 9, "ico: 20 * 4^n triangles"},
        {"segments", kInteger, "32", 4, 4096, "uv: triangles around a pole"},
        {"radius", kReal, "1", 0.0, kFar, "its radius"},
        centre,
        {"smooth", kInteger, "1", 0, 1, "1: smooth normals, 0: flat"}},
       make_sphere},
      {"sheet",
       "a sheet over [-1, 1]^2 whose inner vertices are jittered: no ray gets through",
       {{"triangles", kInteger, "512", 2, 16'777'216, "how many; made even"},
        {"seed", kInteger, "1", 0, 4294967295.0, "of the random numbers"},
        {"jitter", kReal, "0.24", 0.0, 0.24, "in the plane, in widths of a cell"},
        {"depth", kReal, "0.05", 0.0, 1e6, "along z, scene units"}},
       make_sheet},
  };
}

}  // namespace gridrt::scene_detail
