// Rays that start where other rays hit: the engine's way beside the truth's.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "tests/adversarial/bench.hpp"

namespace gridrt::adversarial {

/// A ray under way: where it is in scene units, and its last segment in both worlds.
struct Path {
  Ray ray;
  Segment segment;
  truth::Segment expected;
  Hit hit;
};

/// Starts paths with primary rays and traces them.
std::vector<Path> start_paths(const Bench& bench, std::span<const Ray> rays, Tally& tally);

/// What a path does at a hit: the next ray (direction, tmax) from `point`, or nothing to end.
/// `normal` is the lattice normal of the triangle in scene units, not normalised.
struct Turn {
  glm::dvec3 direction{0.0};
  double tmax = std::numeric_limits<double>::infinity();
};

/// Normal of triangle `id`, in scene units up to a positive factor (exact up to rounding).
glm::dvec3 scene_normal(const Bench& bench, std::int32_t id);

/// Sends every path that hit on: its secondary start and segment are compared with the truth's,
/// then it is traced. Paths that missed, or for which `turn` gives nothing, are dropped.
template <class TurnRule>
std::vector<Path> next_paths(const Bench& bench, std::span<const Path> paths, const TurnRule& turn,
                             Tally& tally);

/// The same with turns already made; `turns[i]` belongs to `paths[i]`, which hit.
std::vector<Path> continue_paths(const Bench& bench, std::span<const Path> paths,
                                 std::span<const Turn> turns, Tally& tally);

template <class TurnRule>
std::vector<Path> next_paths(const Bench& bench, std::span<const Path> paths, const TurnRule& turn,
                             Tally& tally) {
  std::vector<Path> going;
  std::vector<Turn> turns;
  for (const Path& path : paths) {
    if (path.hit.id < 0) continue;
    const glm::dvec3 point = path.ray.origin + path.hit.t * path.ray.direction;
    const std::optional<Turn> next = turn(path, point, scene_normal(bench, path.hit.id));
    if (!next) continue;
    going.push_back(path);
    turns.push_back(*next);
  }
  return continue_paths(bench, going, turns, tally);
}

}  // namespace gridrt::adversarial
