// What --lattice writes: all that is needed to check the answers.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "hal/error.hpp"
#include "host/app/prepared_scene.hpp"
#include "host/grid/segment.hpp"

namespace gridrt {

/// Collects rays and their segments, and packs them with the lattice:
/// q int32 (T, 3, 3), every triangle's snapped vertices by global id; s int32 (3,), lattice scale;
/// lo float32 (3,); bits int32 (); box int32 (3,); vertices float32 (T, 3, 3); rays float64 (N, 8)
/// with tmin and tmax; P0, P1 int32 (N, 3), all -1 where the segment is a miss by definition.
class LatticeRecorder {
 public:
  void add(std::span<const Ray> rays, std::span<const Segment> segments);

  [[nodiscard]] Result<std::vector<std::byte>> pack(const PreparedScene& prepared) const;

 private:
  std::vector<double> rays_;
  std::vector<std::int32_t> p0_;
  std::vector<std::int32_t> p1_;
};

}  // namespace gridrt
