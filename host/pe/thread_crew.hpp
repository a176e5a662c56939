// Software PEs in this process, on threads or none but the caller's.
#pragma once

#include <deque>
#include <memory>

#include "host/pe/crew.hpp"
#include "host/pe/image_store.hpp"
#include "host/pe/schedule.hpp"

namespace gridrt {

/// Answers each order before start() returns.
class ThreadCrew final : public Crew {
 public:
  ThreadCrew(const ScheduleOptions& schedule, const protocol::CapabilitiesReport& limits)
      : schedule_(schedule), store_(limits) {}

  Accepted<void> load(const protocol::LoadHead& head, std::span<const std::byte> bytes) override;
  Accepted<void> commit(std::uint64_t pe_mask) override;
  [[nodiscard]] protocol::Layout layout() const override;
  Accepted<void> start(const TraceOrder& order) override;
  std::optional<TraceAnswer> finish(std::chrono::milliseconds patience) override;
  PeCounters counters() override { return counters_; }
  void reset() override;
  [[nodiscard]] Result<void> health() const override { return {}; }

 private:
  ScheduleOptions schedule_;
  ImageStore store_;
  std::unique_ptr<CommittedImage> image_;
  std::deque<TraceAnswer> answers_;
  PeCounters counters_;
};

}  // namespace gridrt
