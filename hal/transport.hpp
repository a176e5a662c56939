// The host's end of a link to a device: two byte streams and the control reports.
#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "gridrt_protocol.hpp"
#include "hal/error.hpp"

namespace gridrt {

/// Moves bytes, knows nothing of frames. Used by one thread at a time.
class Transport {
 public:
  Transport() = default;
  Transport(const Transport&) = delete;
  Transport& operator=(const Transport&) = delete;
  virtual ~Transport() = default;

  /// Hands all bytes to the device or to a queue on the way there. May wait while the device takes
  /// none. Errors: kTransport (the link is gone), kTimeout (the device has stopped taking bytes).
  virtual Result<void> send(std::span<const std::byte> bytes) = 0;

  /// Waits until bytes have come or the timeout is over; returns how many were written to `out`,
  /// 0 after the timeout. Where a transfer ends means nothing. Errors: kTransport.
  virtual Result<std::size_t> receive(std::span<std::byte> out,
                                      std::chrono::milliseconds timeout) = 0;

  /// Reads a feature report: `body` receives the bytes behind the report's id, zeros where the
  /// device sent fewer; at most kReportBytes - 1. Errors: kTransport, kTimeout, kUnsupported (the
  /// device has no such report).
  virtual Result<void> get_feature(std::uint8_t id, std::span<std::byte> body) = 0;

  /// Writes a feature report, `body` being the bytes behind its id. Errors: as get_feature, and
  /// kProtocol if the device refuses the content.
  virtual Result<void> set_feature(std::uint8_t id, std::span<const std::byte> body) = 0;

  /// Waits for a report that the device sends by itself: returns its id and writes the bytes behind
  /// it to `body`, or returns nothing after the timeout. Errors: kTransport, and kUnsupported for
  /// links without such reports, which is what this one says.
  virtual Result<std::optional<std::uint8_t>> read_input(std::span<std::byte> /*body*/,
                                                         std::chrono::milliseconds /*timeout*/) {
    return fail(ErrorKind::kUnsupported, "this link has no reports that come by themselves");
  }

  /// The time in which a peer's patience is measured, from any start. A link to a simulated device
  /// has that device's.
  [[nodiscard]] virtual std::chrono::milliseconds now() const {
    return std::chrono::duration_cast<std::chrono::milliseconds>(
        std::chrono::steady_clock::now().time_since_epoch());
  }
};

/// Reads a report as its struct, as in get_report<protocol::StatusReport>(transport).
template <class Report>
Result<Report> get_report(Transport& transport) {
  std::array<std::byte, Report::kBytes> body{};
  if (auto done = transport.get_feature(Report::kId, body); !done) {
    return std::unexpected(std::move(done.error()));
  }
  Report report;
  protocol::load(body, report);
  return report;
}

/// Writes a report.
template <class Report>
Result<void> set_report(Transport& transport, const Report& report) {
  std::array<std::byte, Report::kBytes> body{};
  protocol::store(report, body);
  return transport.set_feature(Report::kId, body);
}

}  // namespace gridrt
