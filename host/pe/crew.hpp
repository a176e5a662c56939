// Those who do a software device's work: threads of this process, or ranks elsewhere.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "gridrt_protocol.hpp"
#include "hal/error.hpp"
#include "host/pe/counters.hpp"
#include "host/pe/refusal.hpp"

namespace gridrt {

/// One Trace frame's rays.
struct TraceOrder {
  std::uint32_t sequence = 0;
  protocol::TraceHead head;
  std::span<const std::byte> records;  ///< head.count ray records in the image's layout
};

/// Its answer.
struct TraceAnswer {
  std::uint32_t sequence = 0;
  protocol::TraceHead head;
  std::vector<std::byte> hits;     ///< head.count hit records in the order of the rays
  std::optional<Refusal> refusal;  ///< instead of hits
};

/// Calls come from one thread. A crew that can go on no more says so in health(); what other calls
/// return then means nothing.
class Crew {
 public:
  Crew() = default;
  Crew(const Crew&) = delete;
  Crew& operator=(const Crew&) = delete;
  virtual ~Crew() = default;

  /// Takes a piece of a section, as ImageStore::add. No order is under way.
  virtual Accepted<void> load(const protocol::LoadHead& head, std::span<const std::byte> bytes) = 0;

  /// Makes the pieces the image that answers, as ImageStore::commit. No order is under way.
  virtual Accepted<void> commit(std::uint64_t pe_mask) = 0;

  /// The layout of the image that answers rays; kNone without one.
  [[nodiscard]] virtual protocol::Layout layout() const = 0;

  /// Begins an order; several may be under way. Refuses rays outside the box.
  virtual Accepted<void> start(const TraceOrder& order) = 0;

  /// Works until an order is answered, for about `patience` at the most. Nothing: not yet, or
  /// nothing is under way.
  virtual std::optional<TraceAnswer> finish(std::chrono::milliseconds patience) = 0;

  /// Totals since the beginning or reset().
  virtual PeCounters counters() = 0;

  /// Forgets image, orders and counters.
  virtual void reset() = 0;

  /// Errors: kDevice, once and for all.
  [[nodiscard]] virtual Result<void> health() const = 0;
};

}  // namespace gridrt
