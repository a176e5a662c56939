// Software PEs behind the packet protocol: reached through frames and reports and nothing else.
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "hal/endpoint.hpp"
#include "hal/frame.hpp"
#include "host/pe/image_store.hpp"
#include "host/pe/schedule.hpp"

namespace gridrt {

struct SoftwareDeviceOptions {
  std::string name = "seq";  ///< told in the Identity report, at most 32 characters
  ScheduleOptions schedule = ScheduleOptions();
  /// What it tells about itself, and what it refuses to go beyond.
  protocol::CapabilitiesReport capabilities = software_capabilities();
};

/// Answers frames in the order of their arrival, each before consume() returns.
class SoftwareDevice final : public Endpoint {
 public:
  explicit SoftwareDevice(SoftwareDeviceOptions options);

  Result<void> consume(std::span<const std::byte> bytes) override;
  Result<std::size_t> produce(std::span<std::byte> out, std::chrono::milliseconds timeout) override;
  Result<void> get_feature(std::uint8_t id, std::span<std::byte> body) override;
  Result<void> set_feature(std::uint8_t id, std::span<const std::byte> body) override;

 private:
  Result<void> handle_frames();
  Result<void> handle(const Frame& frame);
  Accepted<void> load_section(std::span<const std::byte> payload);
  Accepted<void> commit(std::span<const std::byte> payload);
  Accepted<void> trace(const Frame& frame, FrameBuilder& reply);
  Result<void> answer_error(std::uint32_t sequence, const Refusal& refusal);
  void reset();

  SoftwareDeviceOptions options_;
  FrameReader reader_;
  ImageStore store_;
  std::unique_ptr<CommittedImage> image_;
  protocol::DeviceState state_ = protocol::DeviceState::kEmpty;
  Refusal last_error_{protocol::ErrorCode::kNone, 0};
  PeCounters counters_;
  std::vector<std::byte> out_;
  std::size_t taken_ = 0;  // of out_
};

}  // namespace gridrt
