// A simulated board as seen from its pins: a clock, two byte streams, control and input reports.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "gridrt_protocol.hpp"

namespace gridrt {

/// The body of a report, without its id.
using ReportBody = std::array<std::byte, protocol::kReportBytes - 1>;

/// A control report, as a USB device's endpoint 0 hands it to the board's firmware; it is held
/// until the firmware has answered.
struct ReportAccess {
  bool set = false;
  std::uint8_t id = 0;
  ReportBody body{};       ///< what is set, or what was got
  std::size_t length = 0;  ///< bytes of it
  bool done = false;       ///< the firmware has answered
  bool good = false;       ///< and has not refused
};

/// An input report.
struct InputReport {
  std::uint8_t id = 0;
  ReportBody body{};
};

/// When SimBoard::run() stops, besides a full `from_board` and an answered report.
struct RunLimits {
  std::uint64_t quiet = 1;    ///< after so many clocks in which no byte has moved, >= 1
  std::uint64_t gap = 1;      ///< after so many clocks without a byte from the board, if one has
                              ///< come; >= 1
  bool stop_if_sent = false;  ///< once all of `to_board` has been taken
};

/// What a run has moved.
struct RunResult {
  std::size_t taken = 0;  ///< bytes of `to_board`
  std::size_t given = 0;  ///< bytes written to `from_board`
};

/// Used by one thread at a time. Time passes in run() and take_input() only.
class SimBoard {
 public:
  SimBoard() = default;
  SimBoard(const SimBoard&) = delete;
  SimBoard& operator=(const SimBoard&) = delete;
  virtual ~SimBoard() = default;

  /// Runs clocks, at least one: offers `to_board` a byte a clock, takes bytes into `from_board`
  /// while there is room, and has `access` answered if it is not nullptr. A byte that was offered
  /// and not taken has to be the first one of the next run.
  virtual RunResult run(std::span<const std::byte> to_board, std::span<std::byte> from_board,
                        const RunLimits& limits, ReportAccess* access = nullptr) = 0;

  /// Takes the input report that waits for the host; false if there is none.
  virtual bool take_input(InputReport& report) = 0;

  /// Forgets the byte on offer, as a USB device does with what its buffers hold at a Reset.
  virtual void forget() = 0;

  /// Clocks since power-up.
  [[nodiscard]] virtual std::uint64_t clocks() const = 0;
};

}  // namespace gridrt
