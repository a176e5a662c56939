// GridRT from another program: one header, and one class that traces rays through a scene.
// Link GridRT::gridrt. Programs that need a step of their own (image files, partitions, counters,
// pictures) use the headers below it, which are included or installed beside this one.
#pragma once

#include <algorithm>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "hal/error.hpp"
#include "host/driver/chunked_device.hpp"
#include "host/driver/device.hpp"
#include "host/driver/image_options.hpp"
#include "host/grid/lattice.hpp"
#include "host/grid/segment.hpp"
#include "host/grid/segments.hpp"
#include "host/image/image.hpp"
#include "host/scene/scene.hpp"

namespace gridrt {

/// A scene loaded on a device, ready to answer rays. The answers are those of the scene on its
/// lattice (docs/numerics.md), the same on every device and with every option but `bits`.
class Tracer {
 public:
  /// Cuts the scene into images and loads them on a device; the scene is not needed afterwards.
  /// Only its positions and triangles count. Errors: those of open_device, build_scene_images and
  /// Device::load.
  static Result<Tracer> open(const Scene& scene, const DeviceOptions& device = {},
                             ImageOptions image = {}) {
    image.with_scene = false;
    auto opened = open_device(device);
    if (!opened) return std::unexpected(std::move(opened.error()));
    const protocol::CapabilitiesReport& capabilities = (*opened)->capabilities();
    image.pes = std::min<int>(image.pes, capabilities.pes);
    auto built = build_scene_images(scene, options_for(image, capabilities));
    if (!built) return std::unexpected(std::move(built.error()));
    const Lattice lattice = built->front().lattice();
    auto loaded =
        load_images(std::move(*opened), std::make_shared<const SceneImages>(std::move(*built)));
    if (!loaded) return std::unexpected(std::move(loaded.error()));
    return Tracer(std::move(*loaded), lattice);
  }

  /// Answers rays in their order: one Hit a ray, t in units of the ray's direction. Errors: those
  /// of validate for the first ray that is not valid (the message gives its index), and of
  /// Device::trace.
  Result<std::vector<Hit>> trace(std::span<const Ray> rays, Query query = Query::kClosestHit) {
    for (std::size_t i = 0; i < rays.size(); ++i) {
      if (auto valid = validate(rays[i]); !valid) {
        Error error = std::move(valid.error());
        error.message = "ray " + std::to_string(i) + ": " + error.message;
        return std::unexpected(std::move(error));
      }
    }
    std::vector<Segment> segments(rays.size());
    make_segments(lattice_, rays, segments);
    std::vector<Hit> hits(rays.size());
    if (auto traced = device_->trace(segments, query, hits); !traced) {
      return std::unexpected(std::move(traced.error()));
    }
    return hits;
  }

  /// The device itself, for its name and counters.
  [[nodiscard]] Device& device() const { return *device_; }

 private:
  Tracer(std::unique_ptr<Device> device, const Lattice& lattice)
      : device_(std::move(device)), lattice_(lattice) {}

  std::unique_ptr<Device> device_;
  Lattice lattice_;
};

}  // namespace gridrt
