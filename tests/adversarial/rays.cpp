#include "tests/adversarial/rays.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vector_relational.hpp>

#include "tests/adversarial/bridge.hpp"

namespace gridrt::adversarial {
namespace {

glm::dvec3 corner(const Scene& scene, std::size_t triangle, std::size_t k) {
  return glm::dvec3{scene.positions[scene.triangles[triangle][k]]};
}

/// A vertex, a point of an edge, or a point inside of one triangle.
glm::dvec3 point_of(const Scene& scene, Random& random) {
  const std::size_t t = random.below(scene.triangles.size());
  const std::size_t k = random.below(3);
  const glm::dvec3 a = corner(scene, t, k);
  const glm::dvec3 b = corner(scene, t, (k + 1) % 3);
  const glm::dvec3 c = corner(scene, t, (k + 2) % 3);
  switch (random.below(4)) {
    case 0:
      return a;
    case 1:
      return 0.5 * (a + b);
    case 2:
      return a + random.unit() * (b - a);
    default: {
      const double u = random.unit();
      const double v = random.unit() * (1.0 - u);
      return a + u * (b - a) + v * (c - a);
    }
  }
}

/// The box [0, far] plus its surroundings, in lattice steps; sometimes on a cell face.
double coordinate(const truth::Lattice& lattice, const VoxelGrid& grid, int axis, Random& random) {
  const double far = lattice.far[static_cast<std::size_t>(axis)];
  switch (random.below(5)) {
    case 0:
      return random.chance(0.5) ? 0.0 : far;
    case 1:
      return random.uniform(-0.2 * far, 1.2 * far);
    case 2:
      return random.between(0, grid.count[axis]) * static_cast<double>(grid.edge[axis]) + 0.5;
    default:
      return random.between(0, grid.count[axis]) * static_cast<double>(grid.edge[axis]);
  }
}

void cut_at_random(Ray& ray, double scale, Random& random) {
  if (random.chance(0.3)) ray.tmin = random.uniform(0.0, scale);
  if (random.chance(0.3)) ray.tmax = ray.tmin + random.uniform(0.0, 2.0 * scale);
}

}  // namespace

Bounds bounds_of(const Scene& scene) {
  if (scene.triangles.empty()) return {};
  Bounds b{glm::dvec3{std::numeric_limits<double>::infinity()},
           glm::dvec3{-std::numeric_limits<double>::infinity()}};
  for (const auto& t : scene.triangles) {
    for (const auto i : t) {
      b.lo = glm::min(b.lo, glm::dvec3{scene.positions[i]});
      b.hi = glm::max(b.hi, glm::dvec3{scene.positions[i]});
    }
  }
  return b;
}

glm::dvec3 in_scene(const truth::Lattice& lattice, const glm::dvec3& q) {
  glm::dvec3 p;
  for (int i = 0; i < 3; ++i) {
    const auto axis = static_cast<std::size_t>(i);
    p[i] = lattice.lo[axis].get_d() + std::ldexp(q[i] - 2.0, -lattice.shift[axis]);
  }
  return p;
}

std::vector<Ray> random_rays(const Bounds& bounds, std::size_t n, Random& random) {
  const glm::dvec3 margin = 0.5 * bounds.extent() + 1e-3 * glm::length(bounds.extent());
  std::vector<Ray> rays(n);
  for (Ray& ray : rays) {
    ray.origin = random.in_box(bounds.lo - margin, bounds.hi + margin);
    const glm::dvec3 target = random.in_box(bounds.lo, bounds.hi);
    ray.direction = (target - ray.origin) * std::exp2(random.uniform(-8.0, 8.0));
    if (ray.direction == glm::dvec3{0.0}) ray.direction.x = 1.0;
    cut_at_random(ray, 0.5, random);
  }
  return rays;
}

std::vector<Ray> aimed_rays(const Scene& scene, std::size_t n, Random& random) {
  const Bounds bounds = bounds_of(scene);
  const glm::dvec3 margin = bounds.extent() + 1e-3 * glm::length(bounds.extent());
  std::vector<Ray> rays(n);
  for (Ray& ray : rays) {
    ray.origin = random.chance(0.2) && !scene.triangles.empty()
                     ? point_of(scene, random)
                     : random.in_box(bounds.lo - margin, bounds.hi + margin);
    const glm::dvec3 target = scene.triangles.empty() ? glm::dvec3{0.5} : point_of(scene, random);
    ray.direction = target - ray.origin;
    if (random.chance(0.3)) ray.direction *= random.uniform(0.1, 3.0);
    if (ray.direction == glm::dvec3{0.0}) ray.direction = random.direction();
  }
  return rays;
}

std::vector<Ray> grid_rays(const truth::Lattice& lattice, const VoxelGrid& grid, std::size_t n,
                           Random& random) {
  std::vector<Ray> rays(n);
  for (Ray& ray : rays) {
    glm::dvec3 through;
    glm::dvec3 way{0.0};
    for (int i = 0; i < 3; ++i) through[i] = coordinate(lattice, grid, i, random);
    switch (random.below(3)) {
      case 0:  // parallel to an axis
        way[static_cast<int>(random.below(3))] = random.chance(0.5) ? 1.0 : -1.0;
        break;
      case 1:  // diagonals of the lattice: of a face or of the body
        for (int i = 0; i < 3; ++i) way[i] = random.between(-1, 1);
        break;
      default:  // diagonals of the cells
        for (int i = 0; i < 3; ++i) way[i] = random.between(-2, 2) * grid.edge[i];
    }
    if (way == glm::dvec3{0.0}) way.z = 1.0;
    const double back = random.chance(0.5) ? std::exp2(random.between(-1, 18)) : 0.0;
    ray.origin = in_scene(lattice, through - back * way);
    for (int i = 0; i < 3; ++i) {
      ray.direction[i] = std::ldexp(way[i], -lattice.shift[static_cast<std::size_t>(i)]);
      if (way[i] == 0.0 && random.chance(0.5)) ray.direction[i] = -0.0;
    }
    if (random.chance(0.2)) ray.tmax = back + 1.0;
  }
  return rays;
}

std::vector<Ray> origin_rays(const Scene& scene, const truth::Lattice& lattice,
                             const VoxelGrid& grid, std::size_t n, Random& random) {
  const Bounds bounds = bounds_of(scene);
  std::vector<Ray> rays(n);
  for (Ray& ray : rays) {
    glm::dvec3 at;
    for (int i = 0; i < 3; ++i) at[i] = coordinate(lattice, grid, i, random);
    ray.origin = random.chance(0.3) && !scene.triangles.empty() ? point_of(scene, random)
                                                                : in_scene(lattice, at);
    switch (random.below(4)) {
      case 0:  // anywhere
        ray.direction = random.direction() * glm::length(bounds.extent());
        break;
      case 1:  // at another special place, so often along the box
        for (int i = 0; i < 3; ++i) at[i] = coordinate(lattice, grid, i, random);
        ray.direction = in_scene(lattice, at) - ray.origin;
        break;
      case 2:  // away from the middle
        ray.direction = ray.origin - 0.5 * (bounds.lo + bounds.hi);
        break;
      default:  // at the scene
        ray.direction =
            (scene.triangles.empty() ? glm::dvec3{0.1, 0.2, 0.3} : point_of(scene, random)) -
            ray.origin;
    }
    if (ray.direction == glm::dvec3{0.0}) ray.direction.y = -1.0;
    cut_at_random(ray, 1.0, random);
  }
  return rays;
}

std::vector<Ray> any_rays(const Scene& scene, const truth::Lattice& lattice, const VoxelGrid& grid,
                          std::size_t n, Random& random) {
  std::vector<Ray> rays = random_rays(bounds_of(scene), n / 4, random);
  const auto append = [&](const std::vector<Ray>& more) {
    rays.insert(rays.end(), more.begin(), more.end());
  };
  append(aimed_rays(scene, n / 4, random));
  append(grid_rays(lattice, grid, n / 4, random));
  append(origin_rays(scene, lattice, grid, n - 3 * (n / 4), random));
  return rays;
}

std::vector<Segment> exact_segments(const truth::Tracer& scene, std::size_t n, Random& random) {
  const glm::ivec3 far = to_engine(scene.lattice().far);
  const auto inside = [&](const glm::ivec3& p) {
    return glm::all(glm::greaterThanEqual(p, glm::ivec3{0})) &&
           glm::all(glm::lessThanEqual(p, far));
  };
  const auto anywhere = [&] {
    const int x = random.between(0, far.x);
    const int y = random.between(0, far.y);
    return glm::ivec3{x, y, random.between(0, far.z)};
  };
  const auto nearby = [&](const glm::ivec3& p, int reach) {
    const int x = random.between(-reach, reach);
    const int y = random.between(-reach, reach);
    return glm::clamp(p + glm::ivec3{x, y, random.between(-reach, reach)}, glm::ivec3{0}, far);
  };
  std::vector<Segment> out(n);
  for (Segment& s : out) {
    s.t1 = 1.0;
    s.p0 = anywhere();
    s.p1 = anywhere();
    if (scene.triangles().empty()) continue;
    const std::size_t id = random.below(scene.triangles().size());
    const LatticeTriangle t = to_engine(scene.triangles()[id]);
    const std::size_t k = random.below(3);
    const glm::ivec3 a = t.v[k];
    const glm::ivec3 b = t.v[(k + 1) % 3];
    const glm::ivec3 c = t.v[(k + 2) % 3];
    for (int attempt = 0; attempt < 8; ++attempt) {
      const glm::ivec3 start = attempt < 4 ? anywhere() : nearby(a, 1 << random.between(0, 12));
      glm::ivec3 end = start;
      switch (random.below(6)) {
        case 0:  // through a vertex, and beyond by as much
          end = 2 * a - start;
          break;
        case 1:  // through the middle of an edge
          end = a + b - start;
          break;
        case 2:  // through the edge at a third
          end = 2 * a + b - 2 * start;
          break;
        case 3:  // through the centroid
          end = a + b + c - 2 * start;
          break;
        case 4:  // ends on a vertex
          end = a;
          break;
        default:  // in the plane of the triangle, or along an edge
          end = start + (random.chance(0.5) ? b - a : b + c - 2 * a);
      }
      if (!inside(end)) continue;
      s.p0 = start;
      s.p1 = end;
      break;
    }
    if (random.chance(0.3)) std::swap(s.p0, s.p1);
    if (random.chance(0.2)) s.ignore = static_cast<std::uint32_t>(id);
  }
  return out;
}

}  // namespace gridrt::adversarial
