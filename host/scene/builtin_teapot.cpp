// Newell's teapot, cut from its patches, and scenes of many of them.
#include <algorithm>
#include <cstddef>

#include <glm/ext/matrix_transform.hpp>
#include <glm/geometric.hpp>
#include <glm/mat4x4.hpp>
#include <glm/trigonometric.hpp>

#include "host/scene/assemble.hpp"
#include "host/scene/builtin.hpp"
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

Scene make_single(const BuiltinValues& values) {
  return make_teapot(values.integer("tessellation"));
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
  const BuiltinOption tessellation{
      "tessellation", kInteger,
      "10",           1,
      2000,           "cuts of each side of a patch: 64 n^2 - 8 n triangles"};
  return {
      {"teapot", "Newell's teapot, smooth", {tessellation}, make_single},
  };
}

}  // namespace gridrt::scene_detail
