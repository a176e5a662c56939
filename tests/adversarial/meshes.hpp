// Scenes made by code, each to strain one thing.
#pragma once

#include <cstdint>
#include <string>

#include <glm/vec3.hpp>

#include "host/scene/scene.hpp"
#include "tests/adversarial/random.hpp"

namespace gridrt::adversarial {

/// Adds a vertex or a triangle (with the default material).
std::uint32_t add_vertex(Scene& scene, const glm::vec3& p);
void add_triangle(Scene& scene, std::uint32_t a, std::uint32_t b, std::uint32_t c);
void add_triangle(Scene& scene, const glm::vec3& a, const glm::vec3& b, const glm::vec3& c);

/// Adds all of `part`, scaled and moved.
void add_scene(Scene& scene, const Scene& part, float scale = 1.0F,
               const glm::vec3& move = glm::vec3{0.0F});

/// A closed sheet over the unit square near z = 0: n x n cells of four triangles around a middle,
/// interior vertices moved by up to `jitter` cells in the plane and across it.
Scene sheet(int n, double jitter, Random& random);

/// A closed sphere of 2 slices (stacks - 1) triangles.
Scene sphere(int stacks, int slices, const glm::vec3& centre, float radius);

/// A closed axis-aligned box, each face n x n squares of two triangles.
Scene box(int n, const glm::vec3& lo, const glm::vec3& hi);

/// A vertex of the given valence with its closed ring, bent out of plane by `bend`.
Scene fan(int valence, float bend, Random& random);

/// Independent triangles in the unit cube; sizes spread over `octaves` powers of two.
Scene soup(int triangles, double octaves, Random& random);

/// Triangles with corners on a coarse lattice of `steps` per axis: coplanar, touching, overlapping
/// and degenerate ones abound.
Scene lattice_soup(int triangles, int steps, Random& random);

/// Needles (one short edge) and caps (one flat corner) of the given aspect.
Scene slivers(int triangles, double aspect, Random& random);

/// A random scene of any of these kinds, a few to a few thousand triangles, and what it is.
struct NamedScene {
  std::string name;
  Scene scene;
};
NamedScene any_scene(Random& random, int most_triangles);

}  // namespace gridrt::adversarial
