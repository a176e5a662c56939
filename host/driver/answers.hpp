// From a device's ids to the hits that the host reports.
#pragma once

#include <cstdint>
#include <vector>

#include "hal/error.hpp"
#include "host/driver/device.hpp"
#include "host/image/image.hpp"

namespace gridrt {

/// The triangles of an image on the host's side, by local id.
class Answers {
 public:
  static Result<Answers> make(const Image& image);

  /// Local id of a global one; kNoTriangle if it has none (degenerate, or none given).
  [[nodiscard]] std::uint32_t local_id(std::uint32_t global_id) const;

  [[nodiscard]] std::size_t size() const { return triangles_.triangles.size(); }

  /// t, u, v of a closest hit on local triangle `id` (< size()), from exact integers. Nothing if
  /// the segment does not hit that triangle: the device is wrong.
  [[nodiscard]] std::optional<Hit> hit(const Segment& segment, std::uint32_t id) const;

 private:
  ImageTriangles triangles_;
  bool narrow_ = true;                    ///< 64 bits hold every product
  std::vector<std::uint32_t> local_ids_;  ///< by global id; empty for a chunk, to spare its size
};

}  // namespace gridrt
