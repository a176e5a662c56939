// A link that misbehaves on purpose, by a schedule that a seed repeats: for tests of recovery.
#pragma once

#include <cstddef>
#include <cstdint>
#include <random>
#include <span>
#include <vector>

#include "hal/frame.hpp"

namespace gridrt {

/// How often each fault happens to a frame, in [0, 1] each, their sum at most 1.
struct FaultRates {
  double drop = 0.0;                        ///< the frame vanishes
  double flip = 0.0;                        ///< one bit of it is wrong
  double truncate = 0.0;                    ///< its end is missing
  double duplicate = 0.0;                   ///< it comes twice
  double reorder = 0.0;                     ///< it comes behind the next one
  double garbage = 0.0;                     ///< 1 to 64 random bytes come before it
  std::uint64_t limit = ~std::uint64_t{0};  ///< faults in all; none after these

  [[nodiscard]] bool any() const {
    return drop > 0 || flip > 0 || truncate > 0 || duplicate > 0 || reorder > 0 || garbage > 0;
  }
};

/// Applies faults to the frames of one direction of a link.
class FaultInjector {
 public:
  FaultInjector(const FaultRates& rates, std::uint64_t seed);

  /// Takes bytes of good frames, cut anywhere, and appends what arrives to `out`.
  void apply(std::span<const std::byte> in, std::vector<std::byte>& out);

  /// Faults so far.
  [[nodiscard]] std::uint64_t faults() const { return faults_; }

 private:
  void pass(std::span<const std::byte> frame, std::vector<std::byte>& out);
  std::size_t below(std::size_t bound);

  FaultRates rates_;
  std::mt19937_64 random_;
  FrameReader reader_;
  std::vector<std::byte> held_;  // a frame that waits for the next one to pass
  std::uint64_t faults_ = 0;
};

}  // namespace gridrt
