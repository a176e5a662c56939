#include "host/image/ray_load.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include <glm/geometric.hpp>

#include "host/grid/quarters.hpp"
#include "host/grid/traversal.hpp"
#include "host/image/blocks.hpp"
#include "host/image/uniform.hpp"

namespace gridrt {
namespace {

/// More triangles are told apart by more rays.
constexpr std::size_t kFewestRays = 32;  // a view
constexpr std::size_t kMostRays = 400;
constexpr std::size_t kTrianglesPerRay = 8;
/// Cameras stand, rays from afar and lights come from around the view's direction: by so much of it
/// per axis.
constexpr double kSpread = 0.4;
/// Of a view's rays, one in so many comes from afar, the others from a camera close by.
constexpr std::size_t kFromAfar = 4;
/// From the box's middle to a camera, and half the width of its picture there, in radii of the
/// box's sphere.
constexpr double kDistance = 2.0;
constexpr double kPicture = 1.2;
/// To find a ray of a camera that meets the box, and then one from afar: needles are small.
constexpr int kAttempts = 50;
/// Of the lights, those of the scene, if it has so many.
constexpr std::size_t kOwnLights = kLights - 1;
/// Three units make three steps a clock, but in the dearest view rays make 1.6 times as many steps
/// as the sample's of that direction, some of which only cross a corner of the box.
constexpr double kStepsAClock = 1.8;
/// What a clock of a shadow ray counts against one of a primary ray: their budgets are 5.5
/// and 3.25.
constexpr double kShadowWeight = 0.6;
constexpr double kExpanders = 2.0;  ///< a voxel a clock each
constexpr std::size_t kRead = 8;    ///< references that a PE reads a clock

/// Where rays of a view go: to one of the 26 neighbours of a voxel.
glm::dvec3 direction_of(std::size_t view) {
  const auto cell = static_cast<int>(view < kViews / 2 ? view : view + 1);  // 13 is the middle
  return glm::normalize(glm::dvec3{cell % 3 - 1, cell / 3 % 3 - 1, cell / 9 - 1});
}

/// Towards light `number` of a view that is none of the scene's: from one of the view's sides, and
/// a little from where the viewer is, so that it shines on what he sees.
glm::dvec3 light_around(std::size_t view, std::size_t number) {
  const glm::dvec3 d = direction_of(view);
  const glm::dvec3 other = view % 2 == 0 ? glm::dvec3{0.36, 0.48, 0.8} : glm::dvec3{-0.8, 0.6, 0.0};
  const glm::dvec3 x = glm::normalize(glm::cross(d, other));
  const glm::dvec3 y = glm::cross(d, x);
  const double angle = 2.0 * std::numbers::pi * static_cast<double>(number) / kLights;
  return std::cos(angle) * x + std::sin(angle) * y - 0.4 * d;
}

constexpr double power4(double x) { return x * x * x * x; }

glm::dvec3 spread(const glm::dvec3& direction, Uniform& uniform) {
  const double wide = 2.0 * kSpread * glm::length(direction);
  glm::dvec3 out = direction;
  for (int a = 0; a < 3; ++a) out[a] += wide * (uniform() - 0.5);
  return out;
}

/// The lattice's box in scene units, by its longest side so that no product overflows.
struct SceneBox {
  explicit SceneBox(const Lattice& lattice) {
    for (int a = 0; a < 3; ++a) {
      lo[a] = static_cast<double>(lattice.lo[a]) - std::ldexp(2.0, -lattice.scale[a]);
      extent[a] = std::ldexp(static_cast<double>(lattice.box()[a]), -lattice.scale[a]);
    }
    length = std::max({extent.x, extent.y, extent.z});
    extent /= length;
  }
  /// A ray from `from`, in longest sides from the corner `lo`, along `direction`.
  [[nodiscard]] Ray ray(const glm::dvec3& from, const glm::dvec3& direction) const {
    Ray ray;
    for (int a = 0; a < 3; ++a) {
      ray.direction[a] = direction[a] * length;
      ray.origin[a] = lo[a] + from[a] * length;
    }
    return ray;
  }
  glm::dvec3 lo{0.0};
  glm::dvec3 extent{0.0};  ///< in longest sides
  double length = 1.0;
};

/// Enters the box at a point of the three faces that `direction` meets from outside, evenly over
/// what a viewer far away sees of them.
Ray ray_from_afar(const SceneBox& box, const glm::dvec3& direction, Uniform& uniform) {
  const glm::dvec3& e = box.extent;
  glm::dvec3 seen{0.0};
  for (int a = 0; a < 3; ++a) {
    seen[a] = std::abs(direction[a]) * e[(a + 1) % 3] * e[(a + 2) % 3];
  }
  double pick = uniform() * (seen.x + seen.y + seen.z);
  int face = 0;
  while (face < 2 && pick >= seen[face]) pick -= seen[face++];
  glm::dvec3 from{0.0};
  for (int a = 0; a < 3; ++a) {
    const double part = a == face ? (direction[a] > 0 ? 0.0 : 1.0) : uniform();
    from[a] = part * e[a] - direction[a];
  }
  return box.ray(from, direction);
}

/// Through a point of the picture of a camera that looks along `direction` at the box's middle from
/// so near that the box fills its picture: what is near it looks large. May miss the box.
Ray ray_of_camera(const SceneBox& box, const glm::dvec3& direction, Uniform& uniform) {
  const double radius = 0.5 * glm::length(box.extent);
  const glm::dvec3 d = glm::normalize(direction);
  const glm::dvec3 other = std::abs(d.x) < 0.6 ? glm::dvec3{1, 0, 0} : glm::dvec3{0, 1, 0};
  const glm::dvec3 x = glm::normalize(glm::cross(d, other));
  const glm::dvec3 y = glm::cross(d, x);
  const double wide = 2.0 * kPicture * radius;
  const double right = wide * (uniform() - 0.5);
  const double up = wide * (uniform() - 0.5);
  const glm::dvec3 eye = 0.5 * box.extent - kDistance * radius * d;
  return box.ray(eye, kDistance * radius * d + right * x + up * y);
}

/// A grid with what a traversal unit reads of it.
class Walk {
 public:
  Walk(const VoxelGrid& grid, const VoxelLists& lists)
      : grid_(grid),
        lists_(lists),
        blocks_(block_count(grid)),
        occupancy_(block_occupancy(grid, lists)),
        jumps_(skip_field(blocks_, occupancy_)) {}

  [[nodiscard]] std::size_t block(const glm::ivec3& voxel) const {
    const auto wide = [](int i) { return static_cast<std::size_t>(i); };
    return (wide(voxel.z >> 1) * wide(blocks_.y) + wide(voxel.y >> 1)) * wide(blocks_.x) +
           wide(voxel.x >> 1);
  }
  [[nodiscard]] int jump(const glm::ivec3& voxel, int direction) const {
    return jumps_[block(voxel)][static_cast<std::size_t>(direction)];
  }
  [[nodiscard]] std::span<const VoxelReference> list(const glm::ivec3& voxel) const {
    const std::size_t cell = grid_.index(voxel);
    return std::span(lists_.references)
        .subspan(lists_.first[cell], lists_.first[cell + 1] - lists_.first[cell]);
  }

  /// Calls visit(voxel visit) for the voxels met, up to the block-slab in which the ray has passed
  /// `quotient`: its voxels are on their way to the PEs before any of them can answer. Returns the
  /// number of blocks looked at.
  template <class Visit>
  int run(const Segment& s, std::uint32_t quotient, Visit&& visit) const {
    int steps = 0;
    SlabMarch march(grid_, s.p0, s.p1);
    const int direction = march.direction();
    const int axis = direction / 2;
    while (march.has_slab()) {
      std::span<const VoxelVisit> voxels = march.voxels();
      if (voxels.empty()) {
        march.next();
        continue;
      }
      if (voxels.front().enter.quotient() > quotient) break;
      const int ahead = jump(voxels.front().voxel, direction);
      if (ahead > 0) {
        ++steps;
        march.skip_blocks(ahead);
        continue;
      }
      const int slab = voxels.front().voxel[axis] >> 1;
      std::array<std::size_t, 32> met{};
      std::size_t count = 0;
      while (!voxels.empty() && (voxels.front().voxel[axis] >> 1) == slab) {
        for (const VoxelVisit& v : voxels) {
          const auto end = met.begin() + static_cast<std::ptrdiff_t>(count);
          const std::size_t here = block(v.voxel);
          if (std::find(met.begin(), end, here) == end) met[count++] = here;
          visit(v);
        }
        march.next();
        if (!march.has_slab()) break;
        voxels = march.voxels();
      }
      steps += static_cast<int>(count);
    }
    return steps;
  }

 private:
  const VoxelGrid& grid_;
  const VoxelLists& lists_;
  glm::ivec3 blocks_;
  std::vector<std::uint8_t> occupancy_;
  std::vector<Jumps> jumps_;
};

}  // namespace

RaySample::RaySample(const Lattice& lattice, std::span<const LatticeTriangle> triangles,
                     std::span<const Light> lights)
    : lattice_(lattice), triangles_(triangles), lights_(lights) {
  const std::size_t rays = std::clamp(triangles.size() / kTrianglesPerRay, kFewestRays, kMostRays);
  for (std::size_t view = 0; view < kViews; ++view) {
    for (std::size_t i = 0; i < rays; ++i) {
      const std::optional<Segment> segment = find_segment(view, i % kFromAfar == 0);
      if (!segment) continue;
      samples_.push_back({*segment, view, {}});
      rays_[view] += 1.0;
    }
  }
}

std::optional<Segment> RaySample::find_segment(std::size_t view, bool from_afar) {
  const SceneBox box(lattice_);
  for (int attempt = 0; attempt < 2 * kAttempts; ++attempt) {
    const glm::dvec3 direction = spread(direction_of(view), uniform_);
    const Ray ray = from_afar || attempt >= kAttempts ? ray_from_afar(box, direction, uniform_)
                                                      : ray_of_camera(box, direction, uniform_);
    if (!validate(ray)) continue;
    const Segment segment = make_segment(lattice_, ray);
    if (!segment.is_miss()) return segment;
  }
  return {};
}

Ray RaySample::towards_light(const Sample& primary, std::size_t number) {
  Ray ray;
  const std::size_t own = std::min(lights_.size(), kOwnLights);
  if (number >= own) {
    const glm::dvec3 way = spread(light_around(primary.group, number), uniform_);
    for (int a = 0; a < 3; ++a) {
      ray.direction[a] = std::ldexp(way[a], std::max(-1000, -lattice_.scale[a]));
    }
    return ray;
  }
  const Light& light = lights_[number * lights_.size() / own];
  ray.direction = -light.direction;
  if (light.kind == Light::Kind::kDirectional) return ray;
  const double along = std::ldexp(static_cast<double>(primary.hit.quotient), -24);
  const glm::dvec3 at =
      glm::dvec3{primary.segment.p0} + along * glm::dvec3{primary.segment.p1 - primary.segment.p0};
  for (int a = 0; a < 3; ++a) {
    ray.direction[a] = light.position[a] - static_cast<double>(lattice_.lo[a]) -
                       std::ldexp(at[a] - 2.0, -lattice_.scale[a]);
  }
  ray.tmax = 1.0;
  return ray;
}

void RaySample::add_shadow_ray(const Sample& primary, std::size_t number) {
  const LatticeTriangle& left = triangles_[primary.hit.id];
  Ray ray = towards_light(primary, number);
  // On the light, or farther from it than numbers reach.
  if (!validate(ray)) return;
  const int most = std::max({lattice_.scale[0], lattice_.scale[1], lattice_.scale[2]});
  glm::dvec3 light{0.0};  // along the lattice's axes, whatever its length
  for (int a = 0; a < 3; ++a) {
    light[a] = std::ldexp(ray.direction[a], lattice_.scale[a] - most);
  }
  const glm::dvec3 e1{left.v[1] - left.v[0]};
  const glm::dvec3 e2{left.v[2] - left.v[0]};
  const glm::dvec3 normal = glm::cross(e1, e2);
  const glm::dvec3 incoming{primary.segment.p1 - primary.segment.p0};
  // In shadow by itself: no ray.
  if (glm::dot(normal, light) * glm::dot(normal, incoming) >= 0.0) return;
  const auto origin = secondary_origin(lattice_, primary.segment, left, ray.direction);
  if (!origin) return;
  for (int a = 0; a < 3; ++a) {
    ray.origin[a] = static_cast<double>(lattice_.lo[a]) +
                    std::ldexp(static_cast<double>((*origin)[a] - 2), -lattice_.scale[a]);
  }
  if (!validate(ray)) return;
  const Segment segment = make_secondary_segment(lattice_, ray, *origin, left, primary.hit.id);
  if (segment.is_miss()) return;
  const std::size_t group = kViews * (1 + number) + primary.group;
  samples_.push_back({segment, group, {}});
  rays_[group] += 1.0;
}

void RaySample::find_hits(const VoxelGrid& grid, const VoxelLists& lists) {
  const Walk walk(grid, lists);
  for (std::size_t i = 0; i < samples_.size(); ++i) {
    Sample s = samples_[i];
    const glm::ivec3 d = s.segment.p1 - s.segment.p0;
    traverse(
        grid, s.segment.p0, s.segment.p1,
        [&](const glm::ivec3& voxel, int direction) { return walk.jump(voxel, direction); },
        [&](const VoxelVisit& v) {
          if (v.enter.quotient() > s.hit.quotient) return false;
          for (const VoxelReference& r : walk.list(v.voxel)) {
            if (r.triangle == s.segment.ignore) continue;
            const auto hit =
                intersect_narrow(s.segment.p0, d, EdgeTriangle(triangles_[r.triangle]));
            if (hit) s.hit = std::min(s.hit, HitKey{hit_quotient(*hit), r.triangle});
          }
          return true;
        });
    samples_[i] = s;
    if (s.group >= kViews || s.hit.id == kNoTriangle) continue;
    for (std::size_t light = 0; light < kLights; ++light) add_shadow_ray(s, light);
  }
  hits_known_ = true;
}

GridLoad RaySample::measure(const VoxelGrid& grid, const VoxelLists& lists) {
  if (!hits_known_) find_hits(grid, lists);
  const Walk walk(grid, lists);
  GridLoad load;
  for (std::vector<float>& work : load.work) work.assign(grid.cells(), 0.0F);
  if (samples_.empty()) return load;
  for (const Sample& s : samples_) {
    const double share = 1.0 / rays_[s.group];
    load.steps[s.group] += share * walk.run(s.segment, s.hit.quotient, [&](const VoxelVisit& v) {
      const std::span<const VoxelReference> list = walk.list(v.voxel);
      if (list.empty()) return;
      const CellSet cells = ray_cells(grid, s.segment.p0, s.segment.p1, v);
      std::size_t tests = 0;
      for (const VoxelReference& r : list) {
        if ((cells_of(r.quarters) & cells) != 0) ++tests;
      }
      load.tasks[s.group] += share;
      const std::size_t clocks = std::max((list.size() + kRead - 1) / kRead, tests);
      load.work[s.group][grid.index(v.voxel)] +=
          static_cast<float>(share * static_cast<double>(clocks));
    });
  }
  return load;
}

double estimate_clocks(const GridLoad& load, std::span<const std::uint8_t> owners, int pes) {
  double sum = 0.0;
  std::vector<double> busy(static_cast<std::size_t>(pes));
  for (std::size_t g = 0; g < kRayGroups; ++g) {
    std::ranges::fill(busy, 0.0);
    for (std::size_t i = 0; i < load.work[g].size(); ++i) busy[owners[i]] += load.work[g][i];
    double clocks = 0.0;
    for (const double part : {load.steps[g] / kStepsAClock, load.tasks[g] / kExpanders,
                              *std::ranges::max_element(busy)}) {
      clocks += power4(part);
    }
    // Means of fourth powers, of views and of lights.
    sum += g < kViews ? clocks : clocks * power4(kShadowWeight) / kLights;
  }
  return std::sqrt(std::sqrt(sum / (2.0 * kViews)));
}

}  // namespace gridrt
