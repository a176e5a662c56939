// A simulated board as seen from its pins: a clock, two byte streams and the register bus.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace gridrt {

/// An access to the register bus; it is held until the board has served it.
struct RegisterAccess {
  bool write = false;
  std::uint32_t address = 0;  ///< of a byte, a multiple of 4
  std::uint32_t data = 0;     ///< written, or what was read
  bool done = false;
};

/// When SimBoard::run() stops, besides a full `from_board` and a served register access.
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

/// Used by one thread at a time. Time passes in run() only.
class SimBoard {
 public:
  SimBoard() = default;
  SimBoard(const SimBoard&) = delete;
  SimBoard& operator=(const SimBoard&) = delete;
  virtual ~SimBoard() = default;

  /// Runs clocks, at least one: offers `to_board` a byte a clock, takes bytes into `from_board`
  /// while there is room, and serves `access` if it is not nullptr. A byte that was offered and not
  /// taken has to be the first one of the next run.
  virtual RunResult run(std::span<const std::byte> to_board, std::span<std::byte> from_board,
                        const RunLimits& limits, RegisterAccess* access = nullptr) = 0;

  /// Clocks since power-up.
  [[nodiscard]] virtual std::uint64_t clocks() const = 0;
};

}  // namespace gridrt
