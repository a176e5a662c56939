// Built-in scenes for secondary rays: sealed rooms, mirrors all round, glass within glass.
#include <cstddef>

#include "host/scene/assemble.hpp"
#include "host/scene/builtin.hpp"
#include "host/scene/builtin_looks.hpp"

namespace gridrt::scene_detail {
namespace {

// A colour that nothing within a sealed scene has: a ray that leaks shows it.
constexpr glm::vec3 kLeak{1.0F, 0.0F, 1.0F};

Result<Scene> make_room(const BuiltinValues& values) {
  Scene scene;
  const std::uint32_t wall = add_material(scene, matte("wall", {0.75F, 0.72F, 0.65F}));
  const std::uint32_t block = add_material(scene, matte("block", {0.35F, 0.50F, 0.70F}));
  add_fine_box(scene, {-2.0, 0.0, -3.0}, {2.0, 3.0, 3.0}, values.integer("cells"), wall, true);
  add_box(scene, {-1.25, 0.0, -2.0}, {-0.25, 1.5, -1.0}, block);
  add_box(scene, {0.25, 0.0, -1.25}, {1.25, 0.75, -0.25}, block);
  const bool inside = values.choice("lamp") == "inside";
  scene.lights = {lamp(inside ? glm::dvec3(0.5, 2.75, 0.5) : glm::dvec3(3.0, 5.0, 4.0), 0.8F)};
  scene.background = kLeak;
  scene.camera = Camera{{0.0, 1.5, 2.75}, {0.0, 1.25, 0.0}, {0.0, 1.0, 0.0}, 55.0};
  return scene;
}

Result<Scene> make_mirrorbox(const BuiltinValues& values) {
  Scene scene;
  const std::uint32_t mirror = add_material(scene, mirror_of({0.95F, 0.97F, 0.95F}));
  const std::uint32_t ball = add_material(scene, glossy("ball", {0.85F, 0.45F, 0.15F}, 0.0F));
  add_fine_box(scene, {-2.0, -2.0, -2.0}, {2.0, 2.0, 2.0}, values.integer("cells"), mirror, true);
  if (values.integer("ball") == 1) {
    add_icosphere(scene, {0.3, -0.4, -0.2}, 0.6, 3, ball, true);
  }
  scene.lights = {lamp({-1.0, 1.5, 1.0}, 0.9F)};
  scene.background = kLeak;
  scene.camera = Camera{{1.1, 0.7, 1.6}, {0.0, -0.2, -0.2}, {0.0, 1.0, 0.0}, 65.0};
  return scene;
}

// Shells around one centre: glass and air by turns. An index of refraction is that of the inside
// over that of the outside, so the inner sides of the glass have 1 / 1.5.
Result<Scene> make_glass(const BuiltinValues& values) {
  Scene scene;
  const std::uint32_t into_glass = add_material(scene, glass_of(1.5F));
  const std::uint32_t into_air = add_material(scene, glass_of(1.0F / 1.5F));
  const std::uint32_t floor = add_material(scene, matte("floor", {0.6F, 0.6F, 0.55F}));
  const std::uint32_t dark = add_material(scene, matte("dark", {0.2F, 0.25F, 0.3F}));
  const std::uint32_t layers = values.integer("layers");
  for (std::uint32_t i = 0; i < layers; ++i) {
    const double radius = 1.5 * (1.0 - static_cast<double>(i) / layers);
    add_icosphere(scene, {0.0, 0.0, 0.0}, radius, values.integer("subdivisions"),
                  i % 2 == 0 ? into_glass : into_air, values.integer("smooth") == 1);
  }
  if (values.integer("floor") == 1) {
    constexpr int kSquares = 10;
    for (int i = 0; i < kSquares * kSquares; ++i) {
      const int column = i % kSquares;
      const int row = i / kSquares;
      const double x = column - 0.5 * kSquares;
      const double z = row - 0.5 * kSquares;
      add_quad(scene, {{{x, -1.6, z}, {x, -1.6, z + 1}, {x + 1, -1.6, z + 1}, {x + 1, -1.6, z}}},
               (i + row) % 2 == 0 ? floor : dark);
    }
  }
  scene.lights = {lamp({-4.0, 6.0, 4.0}, 0.9F)};
  scene.background = glm::vec3(0.5F, 0.6F, 0.75F);
  scene.camera = Camera{{0.0, 1.0, 6.0}, {0.0, -0.2, 0.0}, {0.0, 1.0, 0.0}, 40.0};
  return scene;
}

}  // namespace

std::vector<Builtin> room_builtins() {
  using enum OptionKind;
  const BuiltinOption cells{"cells", kInteger, "4", 1, 512, "each wall is cut into n x n squares"};
  return {
      {"room",
       "a sealed room of axis-aligned walls with two blocks; its background is magenta",
       {{"lamp", kChoice, "inside", 0, 0, "inside|outside: where the lamp hangs"}, cells},
       make_room},
      {"mirrorbox",
       "a sealed box of mirrors around a ball; its background is magenta",
       {cells, {"ball", kInteger, "1", 0, 1, "1: with a ball in it, 0: empty"}},
       make_mirrorbox},
      {"glass",
       "closed glass shells within each other over a floor",
       {{"layers", kInteger, "3", 1, 32, "number of closed surfaces, glass and air by turns"},
        {"subdivisions", kInteger, "3", 0, 7, "20 * 4^n triangles a surface"},
        {"smooth", kInteger, "1", 0, 1, "1: smooth normals, 0: flat"},
        {"floor", kInteger, "1", 0, 1, "1: with a floor, 0: shells only"}},
       make_glass},
  };
}

}  // namespace gridrt::scene_detail
