// Scenes and rays that are timed: the same for every contender.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "host/driver/device.hpp"
#include "host/scene/scene.hpp"

namespace gridrt::bench {

/// Rays whose numbers are float32, so that contenders in single precision get the same ones.
struct RaySet {
  std::string name;
  bool coherent = false;  ///< neighbours in the set are neighbours in the picture
  std::vector<Ray> rays;
};

/// `copies` of a mesh side by side.
Scene repeat(const Scene& mesh, int copies);

/// One ray a pixel of a picture with the whole scene in view.
RaySet primary_rays(const Scene& scene, int width, int height);

/// The same rays in random order.
RaySet shuffled(const RaySet& rays);

/// From every hit a ray in a random direction (Lambert's law) off the surface; the order is that of
/// the hits. Starts are a little off the surface: contenders without exact integers need that.
RaySet bounced_rays(const Scene& scene, const RaySet& rays, const std::vector<Hit>& hits);

}  // namespace gridrt::bench
