// Firmware as the shell's host: frames in, answers out, a word and a byte at a time.
#pragma once

#include <stdint.h>

#include "firmware/registers.hpp"
#include "gridrt_firmware_protocol.hpp"

namespace gridrt::firmware {

/// Every wait here is so many reads of a register, each of some ten clocks.
inline constexpr uint32_t kGrantPolls = 1U << 16U;   ///< until the link is quiet
inline constexpr uint32_t kRoomPolls = 1U << 14U;    ///< until the shell takes a word
inline constexpr uint32_t kAnswerPolls = 1U << 16U;  ///< until it answers

class Feed {
 public:
  explicit Feed(Registers& registers) : registers_(registers) {}

  /// Waits until no frame of the link is under way and takes its place; false if that lasts.
  bool take();
  /// The link's turn again, at once: what the shell still has to say goes to the host.
  void give_back();

  /// Whether put() may be called; takes up to kRoomPolls calls while the shell is at work.
  [[nodiscard]] bool has_room() { return registers_.read(wire::registers::Feed::kRoom) != 0; }
  void put(uint32_t word);

  /// Takes a byte of the answers; -1 if there is none.
  int byte();

 private:
  Registers& registers_;
};

}  // namespace gridrt::firmware
