// Random numbers that are the same on every machine.
#pragma once

#include <cstdint>

namespace gridrt {

/// Bits 11 to 63 of splitmix64 (S. Vigna), in [0, 1).
class Uniform {
 public:
  double operator()() {
    state_ += 0x9E3779B97F4A7C15U;
    std::uint64_t z = state_;
    z = (z ^ (z >> 30U)) * 0xBF58476D1CE4E5B9U;
    z = (z ^ (z >> 27U)) * 0x94D049BB133111EBU;
    return static_cast<double>((z ^ (z >> 31U)) >> 11U) * 0x1p-53;
  }

 private:
  std::uint64_t state_ = 1;
};

}  // namespace gridrt
