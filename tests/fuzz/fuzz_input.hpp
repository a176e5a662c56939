// What fuzz targets share: the input as a row of choices, and a condition that must hold.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <source_location>
#include <span>
#include <vector>

namespace gridrt::fuzz {

inline void require(bool condition,
                    const std::source_location& where = std::source_location::current()) {
  if (condition) return;
  std::fprintf(stderr, "%s:%u: what must hold does not\n", where.file_name(),
               static_cast<unsigned>(where.line()));
  std::abort();
}

/// The input as a row of choices. Behind its end: zeros, the row again and again, or numbers that
/// look random and that its bytes decide.
class Input {
 public:
  explicit Input(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

  void repeat() { repeats_ = !bytes_.empty(); }
  void scatter() {
    scatters_ = true;
    for (const std::uint8_t b : bytes_) state_ = (state_ ^ b) * 0x100000001B3U;  // FNV-1a
  }
  /// Whether nothing but zeros is left.
  [[nodiscard]] bool empty() const { return at_ >= bytes_.size() && !repeats_ && !scatters_; }
  std::uint8_t byte() {
    if (at_ >= bytes_.size() && scatters_) {
      state_ = state_ * 6364136223846793005U + 1442695040888963407U;
      return static_cast<std::uint8_t>(state_ >> 56U);
    }
    if (at_ >= bytes_.size() && repeats_) at_ = 0;
    return at_ >= bytes_.size() ? std::uint8_t{0} : bytes_[at_++];
  }
  std::uint32_t word() {
    std::uint32_t out = 0;
    for (int i = 0; i < 4; ++i) out = out << 8U | byte();
    return out;
  }
  std::vector<std::byte> take(std::size_t count) {
    std::vector<std::byte> out(count);
    for (std::byte& b : out) b = std::byte{byte()};
    return out;
  }

 private:
  std::span<const std::uint8_t> bytes_;
  std::size_t at_ = 0;
  bool repeats_ = false;
  bool scatters_ = false;
  std::uint64_t state_ = 0xCBF29CE484222325U;
};

}  // namespace gridrt::fuzz
