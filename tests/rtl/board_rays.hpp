// The rays that measurements send to a device: views of a scene that fills the picture, and the
// waves that Whitted's ray tracing makes of them.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "hal/error.hpp"
#include "host/driver/device.hpp"
#include "host/grid/segment.hpp"
#include "host/scene/scene.hpp"

namespace gridrt::rtl {

/// In which order the rays of a wave go to the device.
enum class RayOrder {
  kSpread,  ///< as the driver sends them to a clocked device (host/driver/ray_order.hpp)
  kLines,   ///< as a picture is read
  kTiles,   ///< 8x8 pixels at a time; lines where rays have no pixel
};

/// Rays of one kind, those that meet the lattice box, and their answers as the software PEs give
/// them: global triangle ids or -1; 0 or -1 for any hit.
struct RayWave {
  std::string name;  ///< "primary 0" and so on, the number being the view's
  Query query = Query::kClosestHit;
  std::vector<Segment> segments;
  std::vector<std::int32_t> answers;
};

struct WaveOptions {
  int width = 640;
  int height = 480;
  int views = 4;           ///< 1 to 4
  std::uint64_t most = 0;  ///< rays of a wave, evenly chosen in its order; 0: all
  RayOrder order = RayOrder::kSpread;
};

/// A camera that looks at the scene against `toward` (not zero) from where its triangles fill
/// `share` of the picture's width or height.
Camera fill_view(const Scene& scene, const glm::dvec3& toward, int width, int height, double share);

/// For each view primary rays, shadow rays from what they hit (light after light), and mirror rays;
/// then random rays through the box. The views lie around the scene, the object fills 95 % of them.
Result<std::vector<RayWave>> make_waves(const Scene& scene, const WaveOptions& options);

}  // namespace gridrt::rtl
