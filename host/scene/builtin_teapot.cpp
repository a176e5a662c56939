// Newell's teapot, cut from its patches, and scenes of many of them.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <utility>

#include <glm/ext/matrix_transform.hpp>
#include <glm/geometric.hpp>
#include <glm/mat4x4.hpp>
#include <glm/trigonometric.hpp>

#include "host/scene/assemble.hpp"
#include "host/scene/builtin.hpp"
#include "host/scene/builtin_looks.hpp"
#include "host/scene/teapot_patches.hpp"

namespace gridrt::scene_detail {
namespace {

struct SurfacePoint {
  glm::dvec3 position;
  glm::dvec3 normal;  // not of unit length; zero where the surface has none
};

// Bernstein polynomials of degree 3 and their derivatives at t.
struct Bernstein {
  explicit Bernstein(double t)
      : value{(1 - t) * (1 - t) * (1 - t), 3 * t * (1 - t) * (1 - t), 3 * t * t * (1 - t),
              t * t * t},
        slope{-3 * (1 - t) * (1 - t), 3 * (1 - t) * (1 - 3 * t), 3 * t * (2 - 3 * t), 3 * t * t} {}
  std::array<double, 4> value;
  std::array<double, 4> slope;
};

SurfacePoint evaluate(const ControlTube& tube, std::size_t first_row, std::size_t first_column,
                      double along_rows, double along_columns) {
  const Bernstein u(along_rows);
  const Bernstein v(along_columns);
  glm::dvec3 position(0.0);
  glm::dvec3 by_row(0.0);
  glm::dvec3 by_column(0.0);
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t j = 0; j < 4; ++j) {
      const glm::dvec3& point = tube.at(first_row + i, first_column + j);
      position += point * (u.value[i] * v.value[j]);
      by_row += point * (u.slope[i] * v.value[j]);
      by_column += point * (u.value[i] * v.slope[j]);
    }
  }
  return {position, glm::cross(by_column, by_row)};
}

glm::dvec3 y_up(const glm::dvec3& v) { return {v.x, v.z, -v.y}; }

// Adds the vertices of one row of the cut tube: one at a pole, `columns` elsewhere. Vertex and
// normal have the same index.
void add_row(Scene& scene, const ControlTube& tube, std::size_t row, std::size_t tessellation) {
  const std::size_t strips = (tube.rows - 1) / 3;
  const std::size_t strip = std::min(row / tessellation, strips - 1);
  const double along_rows =
      static_cast<double>(row - strip * tessellation) / static_cast<double>(tessellation);
  const bool pole = (row == 0 && tube.first_row_is_pole) ||
                    (row == strips * tessellation && tube.last_row_is_pole);
  const std::size_t columns = pole ? 1 : tube.columns / 3 * tessellation;
  for (std::size_t column = 0; column < columns; ++column) {
    const double along_columns =
        static_cast<double>(column % tessellation) / static_cast<double>(tessellation);
    const SurfacePoint point =
        evaluate(tube, 3 * strip, 3 * (column / tessellation), along_rows, along_columns);
    add_vertex(scene, y_up(point.position));
    add_normal(scene, y_up(pole ? tube.pole_normal : point.normal));
  }
}

void add_tube(Scene& scene, const ControlTube& tube, std::size_t tessellation) {
  const std::size_t rows = (tube.rows - 1) / 3 * tessellation;
  const std::size_t columns = tube.columns / 3 * tessellation;
  std::vector<std::uint32_t> first_of_row;
  std::vector<bool> one_point;
  for (std::size_t row = 0; row <= rows; ++row) {
    first_of_row.push_back(static_cast<std::uint32_t>(scene.positions.size()));
    add_row(scene, tube, row, tessellation);
    one_point.push_back(scene.positions.size() == first_of_row.back() + 1);
  }
  const auto at = [&](std::size_t row, std::size_t column) {
    return first_of_row[row] + (one_point[row] ? 0U : static_cast<std::uint32_t>(column % columns));
  };
  for (std::size_t row = 0; row < rows; ++row) {
    for (std::size_t column = 0; column < columns; ++column) {
      const std::uint32_t a = at(row, column);
      const std::uint32_t b = at(row, column + 1);
      const std::uint32_t c = at(row + 1, column + 1);
      const std::uint32_t d = at(row + 1, column);
      if (a != b) {
        add_triangle(scene, {a, b, c}, 0, {a, b, c});
      }
      if (c != d) {
        add_triangle(scene, {a, c, d}, 0, {a, c, d});
      }
    }
  }
}

Result<Scene> make_single(const BuiltinValues& values) {
  return make_teapot(values.integer("tessellation"));
}

// Three by three teapots on two floors, each turned by 40 degrees more.
Result<Scene> make_eighteen(const BuiltinValues& values) {
  constexpr int kAcross = 3;
  constexpr int kFloors = 2;
  constexpr int kColours = 3;
  Scene scene;
  add_material(scene, glossy("red", {0.75F, 0.25F, 0.20F}, 0.1F));
  add_material(scene, glossy("green", {0.30F, 0.60F, 0.30F}, 0.1F));
  add_material(scene, glossy("blue", {0.25F, 0.35F, 0.70F}, 0.1F));
  const Scene teapot = make_teapot(values.integer("tessellation"));
  const glm::dvec3 step = glm::dvec3(8.0, 4.5, 7.0) * values.real("spread");
  for (int number = 0; number < kAcross * kAcross * kFloors; ++number) {
    const int x = number % kAcross;
    const int z = number / kAcross % kAcross;
    const int y = number / (kAcross * kAcross);
    Placement placement;
    placement.matrix = glm::translate(glm::dmat4(1.0), step * glm::dvec3(x - 1, y, z - 1));
    placement.matrix =
        glm::rotate(placement.matrix, glm::radians(40.0 * number), glm::dvec3(0.0, 1.0, 0.0));
    placement.material = static_cast<std::uint32_t>(number % kColours);
    if (auto placed = append_scene(scene, teapot, placement, "teapots"); !placed) {
      return std::unexpected(std::move(placed.error()));
    }
  }
  if (const double far = values.real("stray"); far > 0.0) {
    const std::uint32_t a = add_vertex(scene, {far, 0.0, 0.0});
    add_vertex(scene, {far, 1.0, 0.0});
    add_vertex(scene, {far, 0.0, 1.0});
    add_triangle(scene, {a, a + 1, a + 2});
  }
  return scene;
}

// A bowl of steps around a teapot that is small against it.
Result<Scene> make_stadium(const BuiltinValues& values) {
  constexpr std::uint32_t kSides = 24;
  constexpr std::uint32_t kSteps = 8;
  Scene scene;
  const std::uint32_t concrete = add_material(scene, matte("concrete", glm::vec3(0.6F)));
  const std::uint32_t china = add_material(scene, glossy("china", {0.8F, 0.3F, 0.2F}, 0.1F));
  const auto corner = [&](std::uint32_t side, double radius, double height) {
    const double angle = 2.0 * std::numbers::pi * (side % kSides) / kSides;
    return glm::dvec3(radius * std::cos(angle), height, -radius * std::sin(angle));
  };
  for (std::uint32_t side = 0; side < kSides; ++side) {
    for (std::uint32_t step = 0; step < kSteps; ++step) {
      const double inner = 0.4 + 0.6 * step / kSteps;
      const double outer = 0.4 + 0.6 * (step + 1) / kSteps;
      const double low = 0.3 * step / kSteps;
      const double high = 0.3 * (step + 1) / kSteps;
      add_quad(scene,
               {corner(side, inner, low), corner(side + 1, inner, low),
                corner(side + 1, inner, high), corner(side, inner, high)},
               concrete);
      add_quad(scene,
               {corner(side, inner, high), corner(side + 1, inner, high),
                corner(side + 1, outer, high), corner(side, outer, high)},
               concrete);
    }
  }
  add_quad(scene, {{{-1.0, 0.0, 1.0}, {1.0, 0.0, 1.0}, {1.0, 0.0, -1.0}, {-1.0, 0.0, -1.0}}},
           concrete);
  const double size = values.real("ratio");
  constexpr double kTeapotWidth = 6.525;
  Placement placement;
  placement.matrix = glm::scale(glm::dmat4(1.0), glm::dvec3(2.0 * size / kTeapotWidth));
  placement.material = china;
  const Scene teapot = make_teapot(values.integer("tessellation"));
  if (auto placed = append_scene(scene, teapot, placement, "stadium"); !placed) {
    return std::unexpected(std::move(placed.error()));
  }
  scene.camera =
      Camera{glm::dvec3(1.5, 1.5, 4.0) * size, {0.0, 0.4 * size, 0.0}, {0.0, 1.0, 0.0}, 40.0};
  return scene;
}

}  // namespace

Scene make_teapot(std::uint32_t tessellation) {
  Scene scene;
  for (const ControlTube& tube : teapot_tubes()) {
    add_tube(scene, tube, tessellation);
  }
  return scene;
}

std::vector<Builtin> teapot_builtins() {
  using enum OptionKind;
  const BuiltinOption tessellation{"tessellation",
                                   kInteger,
                                   "10",
                                   1,
                                   400,
                                   "cuts of each side of a patch: 64 n^2 - 8 n triangles"};
  return {
      {"teapot", "Newell's teapot, smooth", {tessellation}, make_single},
      {"teapots",
       "eighteen teapots, three by three on two floors",
       {tessellation,
        {"spread", kReal, "1", 0.1, 1e6, "distance between them; 1000 makes distant clusters"},
        {"stray", kReal, "0", 0.0, 1e30, "x of a single triangle far away; 0: none"}},
       make_eighteen},
      {"stadium",
       "a teapot in a stadium that is 10,000 times as wide",
       {{"tessellation", kInteger, "16", 1, 400, "of the teapot: 64 n^2 - 8 n triangles"},
        {"ratio", kReal, "0.0001", 1e-9, 1, "width of the teapot over that of the stadium"}},
       make_stadium},
  };
}

}  // namespace gridrt::scene_detail
