// A serial flash at a simulated board's pins: command 03 (read, 24-bit addresses), mode 0.
#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace gridrt {

/// Holds `content` from `base` on; all else is erased.
class SpiFlash {
 public:
  SpiFlash() = default;
  SpiFlash(std::vector<std::byte> content, std::uint32_t base)
      : content_(std::move(content)), base_(base) {}

  /// The pins once a clock of the board, when they have settled; returns the flash's output, which
  /// changes with the falling edge of its clock.
  bool step(bool selected, bool clock, bool input) {
    if (!selected) {
      bits_ = 0;
      clock_ = false;
      return true;
    }
    if (clock && !clock_) {
      shift_ = shift_ << 1U | (input ? 1U : 0U);
      if (++bits_ == kCommandBits) {
        reading_ = shift_ >> 24U == kRead;
        address_ = shift_ & 0xFFFFFFU;
      }
    } else if (!clock && clock_ && bits_ >= kCommandBits) {
      const unsigned bit = (bits_ - kCommandBits) % 8;
      output_ = ((byte_at(address_ + (bits_ - kCommandBits) / 8) >> (7 - bit)) & 1U) != 0;
    }
    clock_ = clock;
    return output_;
  }

 private:
  static constexpr unsigned kCommandBits = 32;
  static constexpr std::uint32_t kRead = 0x03;

  [[nodiscard]] std::uint32_t byte_at(std::uint32_t address) const {
    const std::size_t at = address - base_;
    return reading_ && address >= base_ && at < content_.size()
               ? std::to_integer<std::uint32_t>(content_[at])
               : 0xFFU;
  }

  std::vector<std::byte> content_;
  std::uint32_t base_ = 0;
  std::uint32_t shift_ = 0;
  std::uint32_t address_ = 0;
  unsigned bits_ = 0;
  bool clock_ = false;
  bool reading_ = false;
  bool output_ = true;
};

}  // namespace gridrt
