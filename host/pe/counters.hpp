// What PEs, traversal and schedules count.
#pragma once

#include <array>
#include <cstdint>

namespace gridrt {

/// Totals since the device was opened or reset. Times are nanoseconds, summed over the workers
/// (threads or ranks).
struct PeCounters {
  std::uint64_t rays = 0;
  std::uint64_t steps = 0;           ///< slabs looked at
  std::uint64_t tests = 0;           ///< exact tests
  std::uint64_t masked = 0;          ///< references left out by their quarters
  std::uint64_t interrupts = 0;      ///< voxels, and all behind them, cancelled by a hit
  std::uint64_t feedback_waits = 0;  ///< hits that waited for the answer of an earlier voxel

  std::uint64_t barriers = 0;       ///< of `paper`: a ray each
  std::uint64_t barrier_ns = 0;     ///< waited in them
  std::uint64_t messages = 0;       ///< parcels between workers, whatever they hold
  std::uint64_t message_bytes = 0;  ///< in them
  std::uint64_t message_ns = 0;     ///< spent with sending and taking them
  std::uint64_t wait_ns = 0;        ///< of `pes`: nothing to do while rays were in flight
  std::uint64_t worker_ns = 0;      ///< from a batch's arrival to its answer

  std::uint64_t tests_ahead = 0;      ///< of `pes`: tests before all earlier voxels had answered
  std::uint64_t tests_aborted = 0;    ///< of `paper`: tests in a voxel that was then given up
  std::uint64_t aborted_ns = 0;       ///< spent in them
  std::uint64_t interrupts_sent = 0;  ///< interrupt messages
  std::uint64_t feedbacks_sent = 0;   ///< feedback messages

  PeCounters& operator+=(const PeCounters& o) {
    for (const auto field : kFields) this->*field += o.*field;
    return *this;
  }

  /// Every field, for sums and for sending.
  static const std::array<std::uint64_t PeCounters::*, 18> kFields;
};

inline constexpr std::array<std::uint64_t PeCounters::*, 18> PeCounters::kFields = {
    &PeCounters::rays,          &PeCounters::steps,           &PeCounters::tests,
    &PeCounters::masked,        &PeCounters::interrupts,      &PeCounters::feedback_waits,
    &PeCounters::barriers,      &PeCounters::barrier_ns,      &PeCounters::messages,
    &PeCounters::message_bytes, &PeCounters::message_ns,      &PeCounters::wait_ns,
    &PeCounters::worker_ns,     &PeCounters::tests_ahead,     &PeCounters::tests_aborted,
    &PeCounters::aborted_ns,    &PeCounters::interrupts_sent, &PeCounters::feedbacks_sent,
};

}  // namespace gridrt
