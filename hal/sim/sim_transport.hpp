// The link to a simulated board. Time on the board passes only while the host waits for it.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "hal/sim/board.hpp"
#include "hal/transport.hpp"

namespace gridrt {

struct SimTransportOptions {
  /// Clocks without a byte in either direction after which the board counts as silent, >= 1. The
  /// longest that a board in order is silent is for a ray that meets every reference of it.
  std::uint64_t silent_clocks = 250'000;
  /// Times in a row that a silent board may be asked again, >= 1: more is an error.
  int most_silences = 4;
  /// Clocks that the firmware may take for a report, >= 1. Before the first it may load an image
  /// from flash, some 40 clocks a byte, and a self-test before any.
  std::uint64_t report_clocks = 4'000'000;
  /// A report waits until the board has taken what was sent before it. Without, it overtakes, as
  /// on USB, where reports have a pipe of their own.
  bool reports_wait = true;
};

/// Queues what the host sends and hands it to the board, a byte a clock, in receive() and before
/// a report is read. Feature and input reports pass through the board's firmware.
///
/// Time limits are clocks, since the speed of a simulation says nothing about the board: a
/// timeout given in milliseconds is not looked at. receive() returns 0 once the board is silent.
/// Errors: kTimeout, with the clocks, if the board is silent and has not taken all bytes, if it is
/// silent again and again, or if its firmware does not answer; kUnsupported and kProtocol if the
/// firmware refuses a report.
class SimTransport final : public Transport {
 public:
  explicit SimTransport(std::unique_ptr<SimBoard> board, SimTransportOptions options = {});

  Result<void> send(std::span<const std::byte> bytes) override;
  Result<std::size_t> receive(std::span<std::byte> out, std::chrono::milliseconds timeout) override;
  Result<void> get_feature(std::uint8_t id, std::span<std::byte> body) override;
  Result<void> set_feature(std::uint8_t id, std::span<const std::byte> body) override;
  /// Takes the input report that waits; if there is none, runs the board until it is silent, or
  /// until its answers pause, and looks again. Not while many answers wait for receive(): a board
  /// that cannot get rid of them stands.
  Result<std::optional<std::uint8_t>> read_input(std::span<std::byte> body,
                                                 std::chrono::milliseconds timeout) override;

  /// Runs the board until it has taken all but `left` of the bytes that were sent; receive() gives
  /// what it says meanwhile.
  Result<void> deliver(std::size_t left = 0);

  /// The board's time: its clocks at the 60 MHz of USB.
  [[nodiscard]] std::chrono::milliseconds now() const override {
    constexpr std::uint64_t kClocksPerMillisecond = 60'000;
    return std::chrono::milliseconds(clocks() / kClocksPerMillisecond);
  }

  /// Clocks since power-up.
  [[nodiscard]] std::uint64_t clocks() const { return board_->clocks(); }

 private:
  [[nodiscard]] std::span<const std::byte> queued() const;
  void drop(std::size_t taken);
  RunResult run_early(bool stop_if_sent);
  Result<void> exchange(ReportAccess& access);
  [[nodiscard]] std::unexpected<Error> stuck() const;

  std::unique_ptr<SimBoard> board_;
  SimTransportOptions options_;
  std::vector<std::byte> to_board_;  // sent by the host, not yet taken
  std::size_t taken_ = 0;            // of to_board_
  std::vector<std::byte> early_;     // came while a report was read
  std::size_t given_ = 0;            // of early_
  int silences_ = 0;
};

}  // namespace gridrt
