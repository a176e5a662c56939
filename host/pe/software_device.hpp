// Software PEs behind the packet protocol: reached through frames and reports and nothing else.
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "hal/endpoint.hpp"
#include "hal/frame.hpp"
#include "host/pe/capabilities.hpp"
#include "host/pe/crew.hpp"
#include "host/pe/schedule.hpp"

namespace gridrt {

struct SoftwareDeviceOptions {
  std::string name = "seq";  ///< told in the Identity report, at most 32 characters
  ScheduleOptions schedule = ScheduleOptions();
  /// What it tells about itself, and what it refuses to go beyond.
  protocol::CapabilitiesReport capabilities = software_capabilities();
  /// An unfinished frame is given up when it is asked for answers and no byte has come for so long.
  /// 0 suits a host that asks only when it has sent all it wants to.
  std::chrono::milliseconds frame_patience{0};
};

/// Answers frames in the order of their arrival, except that several Trace frames may be under way;
/// everything else waits for them. While they take long, a NoOp of sequence number 0 each second
/// tells the host that work goes on.
class SoftwareDevice final : public Endpoint {
 public:
  /// Threads of this process do the work.
  explicit SoftwareDevice(SoftwareDeviceOptions options);
  /// `crew` does the work; `options.schedule` means nothing.
  SoftwareDevice(SoftwareDeviceOptions options, std::unique_ptr<Crew> crew);

  /// True while a Trace frame is unanswered.
  [[nodiscard]] bool busy() const { return !under_way_.empty(); }

  Result<void> consume(std::span<const std::byte> bytes) override;
  Result<std::size_t> produce(std::span<std::byte> out, std::chrono::milliseconds timeout) override;
  Result<void> get_feature(std::uint8_t id, std::span<std::byte> body) override;
  Result<void> set_feature(std::uint8_t id, std::span<const std::byte> body) override;

 private:
  Result<void> handle_frames();
  Result<void> handle(const Frame& frame);
  Accepted<void> load_section(std::span<const std::byte> payload);
  Accepted<void> commit(std::span<const std::byte> payload);
  Result<void> trace(const Frame& frame);
  Accepted<void> start(const Frame& frame);
  Result<bool> answer_one(std::chrono::milliseconds patience);
  Result<void> answer_all();
  Result<void> answer_error(std::uint32_t sequence, const Refusal& refusal);
  void reset();

  SoftwareDeviceOptions options_;
  FrameReader reader_;
  std::unique_ptr<Crew> crew_;
  std::vector<std::uint32_t> under_way_;  ///< sequence numbers of unanswered Trace frames
  std::chrono::steady_clock::time_point last_word_;
  std::chrono::steady_clock::time_point last_byte_;
  protocol::DeviceState state_ = protocol::DeviceState::kEmpty;
  Refusal last_error_{protocol::ErrorCode::kNone, 0};
  std::vector<std::byte> out_;
  std::size_t taken_ = 0;  // of out_
};

}  // namespace gridrt
