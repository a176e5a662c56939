// Built-in scenes of what is hard to intersect: slivers, fans, soups, degenerate triangles.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "host/scene/assemble.hpp"
#include "host/scene/builtin.hpp"

namespace gridrt::scene_detail {
namespace {

constexpr double kMaxSeed = 4294967295.0;

// Slivers keep their thinness in float32 because their thin extent begins at 0.
Result<Scene> make_slivers(const BuiltinValues& values) {
  Scene scene;
  const std::uint32_t count = values.integer("triangles");
  const double thin = 2.0 / values.real("aspect");
  const std::string& kind = values.choice("kind");
  SplitMix64 random(values.integer("seed"));
  if (kind == "fan") {
    // Neighbours share their long edges.
    add_vertex(scene, {-1.0, 0.0, 0.0});
    add_vertex(scene, {1.0, 0.0, 0.0});
    for (std::uint32_t i = 0; i < count; ++i) {
      add_vertex(scene, {1.0, thin * (i + 1), 0.0});
      add_triangle(scene, {0, i + 1, i + 2});
    }
    return scene;
  }
  for (std::uint32_t i = 0; i < count; ++i) {
    const double z = random.uniform(-1.0, 1.0);
    const double apex = kind == "caps" ? random.uniform(-0.5, 0.5) : 1.0;
    const std::uint32_t a = add_vertex(scene, {-1.0, 0.0, z});
    add_vertex(scene, {1.0, 0.0, z});
    add_vertex(scene, {apex, thin, z});
    add_triangle(scene, {a, a + 1, a + 2});
  }
  return scene;
}

// A closed disc of triangles around one vertex.
Result<Scene> make_fan(const BuiltinValues& values) {
  Scene scene;
  const std::uint32_t valence = values.integer("valence");
  const double depth = values.real("depth");
  SplitMix64 random(values.integer("seed"));
  const double x = random.uniform(-0.2, 0.2);
  const double y = random.uniform(-0.2, 0.2);
  add_vertex(scene, {x, y, random.uniform(-depth, depth)});
  for (std::uint32_t i = 0; i < valence; ++i) {
    const double turn = i + random.uniform(-0.2, 0.2);
    const double angle = 2.0 * std::numbers::pi * turn / valence;
    add_vertex(scene, {std::cos(angle), std::sin(angle), random.uniform(-depth, depth)});
    add_triangle(scene, {0, i + 1, (i + 1) % valence + 1});
  }
  return scene;
}

// Triangles anywhere in the cube [-1, 1]^3; some through the whole cube, and each several times.
Result<Scene> make_soup(const BuiltinValues& values) {
  Scene scene;
  const std::uint32_t small = values.integer("triangles");
  const std::uint32_t large = std::min(values.integer("large"), small);
  const double size = values.real("size");
  SplitMix64 random(values.integer("seed"));
  const auto point = [&](const glm::dvec3& centre, double reach) {
    const double x = random.uniform(-reach, reach);
    const double y = random.uniform(-reach, reach);
    const double z = random.uniform(-reach, reach);
    return centre + glm::dvec3(x, y, z);
  };
  for (std::uint32_t i = 0; i < small; ++i) {
    const bool through = i < large;
    const glm::dvec3 centre = through ? glm::dvec3(0.0) : point(glm::dvec3(0.0), 1.0 - size);
    std::array<std::uint32_t, 3> corners{};
    for (std::uint32_t& corner : corners) {
      corner = add_vertex(scene, point(centre, through ? 1.0 : size));
    }
    for (std::uint32_t copy = 0; copy < values.integer("copies"); ++copy) {
      add_triangle(scene, corners);
    }
  }
  return scene;
}

// Points, segments and flat triangles by turns; none may ever be hit.
Result<Scene> make_degenerate(const BuiltinValues& values) {
  Scene scene;
  SplitMix64 random(values.integer("seed"));
  for (std::uint32_t i = 0; i < values.integer("triangles"); ++i) {
    // Multiples of 1/64, so that middles are exact.
    const auto coordinate = [&] { return std::floor(random.uniform(-64.0, 64.0)) / 64.0; };
    const glm::dvec3 p(coordinate(), coordinate(), coordinate());
    const glm::dvec3 q(coordinate(), coordinate(), coordinate());
    const std::uint32_t a = add_vertex(scene, p);
    const std::uint32_t b = add_vertex(scene, q);
    const std::uint32_t m = add_vertex(scene, (p + q) * 0.5);
    const std::array<Corners, 4> kinds = {{{a, a, a}, {a, b, b}, {a, b, a}, {a, m, b}}};
    add_triangle(scene, kinds[i % kinds.size()]);
  }
  if (values.integer("whole") == 1) {
    const std::uint32_t a = add_vertex(scene, {-1.0, -1.0, 0.0});
    add_vertex(scene, {1.0, -1.0, 0.0});
    add_vertex(scene, {0.0, 1.0, 0.0});
    add_triangle(scene, {a, a + 1, a + 2});
  }
  return scene;
}

}  // namespace

std::vector<Builtin> hard_builtins() {
  using enum OptionKind;
  const BuiltinOption seed{"seed", kInteger, "1", 0, kMaxSeed, "of the random numbers"};
  return {
      {"slivers",
       "triangles that are very long for their width",
       {{"kind", kChoice, "needles", 0, 0,
         "needles|caps|fan: a short side, a blunt corner, or needles that share their long sides"},
        {"aspect", kReal, "1000", 1, 1e12, "length over width"},
        {"triangles", kInteger, "256", 1, 1'000'000, "how many"},
        seed},
       make_slivers},
      {"fan",
       "a closed disc of triangles around one vertex",
       {{"valence", kInteger, "16", 3, 1'000'000, "triangles around it"},
        {"depth", kReal, "0.05", 0.0, 1e6, "jitter along z"},
        seed},
       make_fan},
      {"soup",
       "random triangles in a cube",
       {{"triangles", kInteger, "1000", 1, 4'000'000, "how many different ones"},
        {"large", kInteger, "0", 0, 4'000'000, "how many of them go through the whole cube"},
        {"copies", kInteger, "1", 1, 16, "how often each is there"},
        {"size", kReal, "0.05", 0.0, 1, "reach of the others"},
        seed},
       make_soup},
      {"degenerate",
       "triangles without area: points, segments, collinear corners",
       {{"triangles", kInteger, "64", 1, 1'000'000, "how many"},
        {"whole", kInteger, "0", 0, 1, "1: with one proper triangle behind them"},
        seed},
       make_degenerate},
  };
}

}  // namespace gridrt::scene_detail
