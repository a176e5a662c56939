// What rays cost on a device that tests triangles in several PEs at once, measured with sample rays
// on a grid that is considered.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "host/grid/intersect_narrow.hpp"
#include "host/grid/lattice.hpp"
#include "host/grid/segment.hpp"
#include "host/grid/voxel_grid.hpp"
#include "host/image/uniform.hpp"
#include "host/scene/scene.hpp"

namespace gridrt {

/// Groups of sample rays, each of which is to keep all PEs busy: primary rays from 26 directions,
/// then shadow rays from what each of these hits, light by light: some of the scene's, then
/// others from the sides of the view.
inline constexpr std::size_t kViews = 26;
inline constexpr std::size_t kLights = 4;
inline constexpr std::size_t kRayGroups = kViews * (1 + kLights);

/// What the sample rays do on one grid; numbers are means of a ray of a group. Work is the clocks
/// that a PE spends with a voxel's list: it reads eight references a clock and tests one.
struct GridLoad {
  std::array<double, kRayGroups> steps{};  ///< blocks looked at
  std::array<double, kRayGroups> tasks{};  ///< voxels with triangles that are met
  /// Work by voxel, for the rays of each group.
  std::array<std::vector<float>, kRayGroups> work;
};

/// Primary rays through the whole lattice box from each direction, as cameras that have the box in
/// view would send them, most of them close by and some far away, and shadow rays towards the
/// scene's lights and towards some that shine from other directions; the same ones for the same
/// scene.
class RaySample {
 public:
  /// `triangles` and `lights` outlive the sample; lattices of at most 17 bits.
  RaySample(const Lattice& lattice, std::span<const LatticeTriangle> triangles,
            std::span<const Light> lights);

  /// Walks every ray up to its closest hit. `lists` are those of bin_triangles for this grid.
  GridLoad measure(const VoxelGrid& grid, const VoxelLists& lists);

 private:
  struct Sample {
    Segment segment;
    std::size_t group = 0;
    HitKey hit;  ///< the closest one
  };
  /// A ray of a view that meets the box, unless none can be found.
  std::optional<Segment> find_segment(std::size_t view, bool from_afar);
  void find_hits(const VoxelGrid& grid, const VoxelLists& lists);
  /// From what `primary` hits towards light `number` (below kLights), in scene units but without an
  /// origin; it ends at a point light. Not a valid ray where the light is at the hit.
  Ray towards_light(const Sample& primary, std::size_t number);
  void add_shadow_ray(const Sample& primary, std::size_t number);

  Lattice lattice_;
  std::span<const LatticeTriangle> triangles_;
  std::span<const Light> lights_;
  std::vector<Sample> samples_;
  Uniform uniform_;
  std::array<double, kRayGroups> rays_{};  ///< number by group
  bool hits_known_ = false;
};

/// A measure of the clocks of a ray, to compare grids and dealings by: the parts of a device work
/// at the same time, so that the busiest one decides, and a little more the closer the others come.
/// Group by group, of which dear ones count more; views as much as lights. `owners` are in [0,
/// pes).
double estimate_clocks(const GridLoad& load, std::span<const std::uint8_t> owners, int pes);

}  // namespace gridrt
