// Traversal and PEs together: the answer of an image to a ray.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "host/grid/traversal.hpp"
#include "host/pe/pe.hpp"
#include "host/pe/traversal_memory.hpp"

namespace gridrt {

/// The closest hit of a ray, or nothing. The id is local.
using PeAnswer = std::optional<HitKey>;

/// Told of each step of a ray's life (for --explain).
class EngineObserver : public PeObserver {
 public:
  virtual void on_voxel(const VoxelVisit& visit, const Cell* cell) = 0;
  virtual void on_cancel(const VoxelVisit& visit, const HitKey& best) = 0;
};

/// The schedule `rays`: the thread that has the ray runs every PE that the ray needs, voxel by
/// voxel in the order of traversal, and stops as soon as no later voxel can hold a smaller key.
/// Immutable, so any number of threads may trace at once.
class Engine {
 public:
  /// `pes[i]` empty: PE i is absent, its voxels are passed over (the answer is then that of the
  /// others alone). Checks that every cell's list lies within its owner's memory.
  static Accepted<Engine> assemble(TraversalMemory traversal, std::vector<std::optional<Pe>> pes);

  [[nodiscard]] const TraversalMemory& traversal() const { return traversal_; }

  [[nodiscard]] std::size_t pes() const { return pes_.size(); }

  /// PE `number`, or nullptr if it is absent.
  [[nodiscard]] const Pe* pe(std::size_t number) const {
    const std::optional<Pe>& pe = pes_[number];
    return pe ? &*pe : nullptr;
  }

  /// The smallest key over the triangles of the PEs present. p0 != p1, both within the box.
  [[nodiscard]] PeAnswer closest_hit(const PeRay& ray, PeCounters& counters,
                                     EngineObserver* observer = nullptr) const;

  /// True if any triangle is hit.
  [[nodiscard]] bool any_hit(const PeRay& ray, PeCounters& counters) const;

 private:
  TraversalMemory traversal_;
  std::vector<std::optional<Pe>> pes_;
};

}  // namespace gridrt
