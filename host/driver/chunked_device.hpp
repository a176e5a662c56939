// A device under a scene that is larger than it: chunk after chunk is loaded, and asked about the
// rays that it may still have something to say about.
#pragma once

#include <memory>

#include "host/driver/device.hpp"
#include "host/image/chunks.hpp"

namespace gridrt {

/// Loads a scene's images: one as it is, several chunks one after the other as rays need them; then
/// the device that is returned answers for the whole scene, and uploads within trace(). A call with
/// many rays costs fewer uploads than many calls. Errors: those of Device::load; kLimit or
/// kUnsupported if any chunk does not fit the device, before anything is sent.
Result<std::unique_ptr<Device>> load_images(std::unique_ptr<Device> device,
                                            std::shared_ptr<const SceneImages> images);

class ChunkedDevice final : public Device {
 public:
  /// `images` has more than one chunk, and each fits the device.
  ChunkedDevice(std::unique_ptr<Device> device, std::shared_ptr<const SceneImages> images);

  /// Gives up the chunks for this image.
  Result<void> load(const Image& image) override;
  Result<void> trace(std::span<const Segment> segments, Query query, std::span<Hit> hits) override;
  Result<DeviceCounters> counters() override { return device_->counters(); }
  Result<std::vector<ExplainEvent>> explain(const Image& image, const Segment& segment) override;
  [[nodiscard]] std::string name() const override { return device_->name(); }
  [[nodiscard]] const protocol::CapabilitiesReport& capabilities() const override {
    return device_->capabilities();
  }

 private:
  struct Work;
  [[nodiscard]] std::vector<std::size_t> visiting_order(const Work& work) const;
  Result<void> visit(std::size_t chunk, Work& work);
  Result<void> load_chunk(std::size_t chunk);
  Result<void> merge(Work& work, std::size_t i);

  std::unique_ptr<Device> device_;
  std::shared_ptr<const SceneImages> images_;  ///< none: a single image is loaded, or nothing
  std::vector<std::uint32_t> triangle_by_id_;  ///< index in images_->triangles by global id
  std::optional<std::size_t> loaded_;          ///< the chunk on the device
};

}  // namespace gridrt
