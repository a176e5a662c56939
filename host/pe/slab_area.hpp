// Voxels of one slab.
#pragma once

namespace gridrt {

/// A rectangle of voxels across the axis of a frustum, bounds included.
struct SlabArea {
  int lo_a = 0, hi_a = 0;
  int lo_b = 0, hi_b = 0;

  [[nodiscard]] bool empty() const { return hi_a < lo_a || hi_b < lo_b; }
};

}  // namespace gridrt
