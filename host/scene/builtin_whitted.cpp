// Built-in scenes that show what Whitted's ray tracing can: mirror, glass, shadows.
#include <cstddef>
#include <utility>

#include <glm/ext/matrix_transform.hpp>
#include <glm/mat4x4.hpp>
#include <glm/trigonometric.hpp>

#include "host/scene/assemble.hpp"
#include "host/scene/builtin.hpp"
#include "host/scene/builtin_looks.hpp"

namespace gridrt::scene_detail {
namespace {

// A floor of squares in the plane y = 0; neighbours share no vertices but have equal ones.
void add_checker(Scene& scene, double half, int squares, std::uint32_t light, std::uint32_t dark) {
  const double side = 2.0 * half / squares;
  for (int j = 0; j < squares; ++j) {
    for (int i = 0; i < squares; ++i) {
      const double x0 = -half + i * side;
      const double z0 = -half + j * side;
      const double x1 = -half + (i + 1) * side;
      const double z1 = -half + (j + 1) * side;
      add_quad(scene, {{{x0, 0.0, z0}, {x0, 0.0, z1}, {x1, 0.0, z1}, {x1, 0.0, z0}}},
               (i + j) % 2 == 0 ? light : dark);
    }
  }
}

Result<void> add_teapot(Scene& scene, std::uint32_t tessellation, const glm::dvec3& place,
                        double size, double turn_degrees, std::uint32_t material) {
  Placement placement;
  placement.matrix = glm::translate(glm::dmat4(1.0), place);
  placement.matrix =
      glm::rotate(placement.matrix, glm::radians(turn_degrees), glm::dvec3(0.0, 1.0, 0.0));
  placement.matrix = glm::scale(placement.matrix, glm::dvec3(size));
  placement.material = material;
  return append_scene(scene, make_teapot(tessellation), placement, "teapot");
}

Result<Scene> make_demo(const BuiltinValues& values) {
  Scene scene;
  const std::uint32_t light = add_material(scene, matte("light", {0.82F, 0.80F, 0.75F}));
  const std::uint32_t dark = add_material(scene, matte("dark", {0.16F, 0.22F, 0.30F}));
  const std::uint32_t china = add_material(scene, glossy("china", {0.80F, 0.33F, 0.20F}, 0.12F));
  const std::uint32_t mirror = add_material(scene, mirror_of(glm::vec3(0.95F)));
  const std::uint32_t glass = add_material(scene, glass_of(1.5F));
  const std::uint32_t balls = values.integer("subdivisions");
  add_checker(scene, 9.0, 18, light, dark);
  if (auto placed =
          add_teapot(scene, values.integer("tessellation"), {0.1, 0.0, -0.6}, 0.8, 25.0, china);
      !placed) {
    return std::unexpected(std::move(placed.error()));
  }
  add_icosphere(scene, {-2.6, 1.5, -2.6}, 1.5, balls, mirror, true);
  add_icosphere(scene, {2.1, 0.95, 1.6}, 0.95, balls, glass, true);
  scene.lights = {lamp({-5.0, 8.0, 6.0}, 0.65F), lamp({6.0, 6.0, 3.0}, 0.4F)};
  scene.background = glm::vec3(0.32F, 0.48F, 0.66F);
  scene.camera = Camera{{1.2, 3.4, 8.6}, {-0.1, 1.0, 0.0}, {0.0, 1.0, 0.0}, 38.0};
  return scene;
}

// After the picture in T. Whitted, "An Improved Illumination Model for Shaded Display", 1980: a
// glass ball before a mirror ball over a chequered floor.
Result<Scene> make_whitted(const BuiltinValues& values) {
  Scene scene;
  const std::uint32_t yellow = add_material(scene, matte("yellow", {0.90F, 0.85F, 0.20F}));
  const std::uint32_t red = add_material(scene, matte("red", {0.80F, 0.10F, 0.10F}));
  const std::uint32_t mirror = add_material(scene, mirror_of(glm::vec3(0.9F)));
  const std::uint32_t glass = add_material(scene, glass_of(static_cast<float>(values.real("ior"))));
  const std::uint32_t balls = values.integer("subdivisions");
  add_checker(scene, 8.0, 16, yellow, red);
  add_icosphere(scene, {-0.4, 1.6, 1.6}, 0.9, balls, glass, true);
  add_icosphere(scene, {1.2, 1.1, -0.9}, 1.0, balls, mirror, true);
  scene.lights = {lamp({-4.0, 9.0, 5.0}, 0.9F)};
  scene.background = glm::vec3(0.25F, 0.45F, 0.75F);
  scene.camera = Camera{{0.0, 2.0, 8.0}, {0.2, 1.2, 0.0}, {0.0, 1.0, 0.0}, 36.0};
  return scene;
}

}  // namespace

std::vector<Builtin> whitted_builtins() {
  using enum OptionKind;
  return {
      {"demo",
       "teapot, mirror and glass balls on a chequered floor under two lamps",
       {{"tessellation", kInteger, "8", 1, 500, "of the teapot"},
        {"subdivisions", kInteger, "3", 0, 8, "of the balls: 20 * 4^n triangles each"}},
       make_demo},
      {"whitted",
       "a glass ball before a mirror ball over a chequered floor",
       {{"subdivisions", kInteger, "4", 0, 8, "of the balls: 20 * 4^n triangles each"},
        {"ior", kReal, "1.5", 0.1, 10, "index of refraction of the glass"}},
       make_whitted},
  };
}

}  // namespace gridrt::scene_detail
