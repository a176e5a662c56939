// Rays and lattice segments, each kind to strain one thing.
#pragma once

#include <span>
#include <vector>

#include "host/grid/segment.hpp"
#include "host/grid/voxel_grid.hpp"
#include "tests/adversarial/random.hpp"
#include "tests/truth/tracer.hpp"

namespace gridrt::adversarial {

/// What rays are aimed with: the bounds of a scene in its own units.
struct Bounds {
  glm::dvec3 lo{0.0};
  glm::dvec3 hi{1.0};
  [[nodiscard]] glm::dvec3 extent() const { return hi - lo; }
};
Bounds bounds_of(const Scene& scene);

/// Scene coordinates of a lattice point (exact wherever a double holds them).
glm::dvec3 in_scene(const truth::Lattice& lattice, const glm::dvec3& q);

/// Rays through the bounds from in and around them, in any direction and of any length.
std::vector<Ray> random_rays(const Bounds& bounds, std::size_t n, Random& random);

/// Rays at vertices, at points of edges and at middles of the scene's triangles, from anywhere.
std::vector<Ray> aimed_rays(const Scene& scene, std::size_t n, Random& random);

/// Axis-parallel and diagonal rays of all octants through faces, edges and corners of cells.
std::vector<Ray> grid_rays(const truth::Lattice& lattice, const VoxelGrid& grid, std::size_t n,
                           Random& random);

/// Origins at special places: cell faces, triangles, vertices, the box, outside it; pointing
/// towards and away; tangent to the box's edges and corners; with tmin and tmax that end anywhere.
std::vector<Ray> origin_rays(const Scene& scene, const truth::Lattice& lattice,
                             const VoxelGrid& grid, std::size_t n, Random& random);

/// A mixture of the four kinds above.
std::vector<Ray> any_rays(const Scene& scene, const truth::Lattice& lattice, const VoxelGrid& grid,
                          std::size_t n, Random& random);

/// Segments on the lattice that pass exactly through vertices and points of edges, end on them,
/// start on them, or lie in the planes of triangles; some ignore the triangle they are aimed at.
std::vector<Segment> exact_segments(const truth::Tracer& scene, std::size_t n, Random& random);

}  // namespace gridrt::adversarial
