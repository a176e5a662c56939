// A device behind a transport: batches of rays in flight, answers matched by sequence number,
// what the link loses sent again.
#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "host/driver/answers.hpp"
#include "host/driver/connection.hpp"
#include "host/driver/device.hpp"
#include "host/driver/ray_records.hpp"

namespace gridrt {

class Session final : public Device {
 public:
  /// Asks the device who it is and what it can do. Errors: kUnsupported for a protocol version
  /// that this host does not speak.
  static Result<std::unique_ptr<Session>> open(std::unique_ptr<Transport> transport,
                                               const DeviceOptions& options);

  Result<void> load(const Image& image) override;
  Result<void> trace(std::span<const Segment> segments, Query query, std::span<Hit> hits) override;
  Result<DeviceCounters> counters() override;
  Result<std::vector<ExplainEvent>> explain(const Image& image, const Segment& segment) override;
  [[nodiscard]] std::string name() const override { return name_; }

  /// Another name than the device's own, where one kind of device is opened by several.
  void set_name(std::string name) { name_ = std::move(name); }
  [[nodiscard]] const protocol::CapabilitiesReport& capabilities() const override {
    return capabilities_;
  }

  /// Counts from here on; what the device did for others before is not told. Errors: the link's.
  Result<void> start_counting();

  /// The connection; for tests.
  [[nodiscard]] Connection& connection() { return connection_; }

 private:
  /// Rays of one Trace frame that has not been answered.
  struct Batch {
    std::uint32_t sequence = 0;
    std::size_t first = 0;  ///< range of `sent_` that it holds
    std::size_t count = 0;
    int attempts = 1;
    bool done = false;
    std::vector<std::byte> frame;
  };

  /// What one call of trace() works on.
  struct Work {
    const Answers& answers;  ///< of the loaded image
    std::span<const Segment> segments;
    Query query = Query::kClosestHit;
    std::span<Hit> hits;
    std::vector<std::size_t> sent;  ///< indices of the segments that go to the device
    std::deque<Batch> in_flight;    ///< in order of sending
  };

  Session(std::unique_ptr<Transport> transport, const DeviceOptions& options);
  bool is_resident(const Image& image);
  void choose(Work& work) const;
  static const char* settle(const Work& work, std::size_t index, const DeviceHit& answer);
  Result<Batch> make_batch(const Work& work, std::size_t first);
  [[nodiscard]] std::size_t batch_size() const;
  Result<void> collect(Work& work);
  Result<void> take(Work& work, const Frame& frame);
  Result<void> take_hits(Work& work, Batch& batch, const Frame& frame);
  Result<void> take_error(Batch& batch, const Frame& frame);
  Result<void> send_again(Batch& batch);

  DeviceOptions options_;
  int threads_;  ///< of packing rays and working out hits
  Connection connection_;
  std::string name_;
  protocol::CapabilitiesReport capabilities_{};
  protocol::Layout layout_ = protocol::Layout::kNone;
  std::optional<Answers> answers_;                    ///< of the loaded image
  std::vector<std::vector<std::byte>> spare_frames_;  ///< memory of answered batches
  protocol::CountersReport before_{};  ///< what the device had counted when it was opened
  std::uint64_t retries_ = 0;
  std::uint64_t uploads_ = 0;
  double upload_seconds_ = 0.0;
};

}  // namespace gridrt
