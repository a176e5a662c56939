// Numbers that longer runs of a bench get from outside.
#pragma once

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>

#include <gtest/gtest.h>

namespace gridrt {

/// What an environment variable says, or a value if it is not set.
inline std::uint64_t number_of(const char* variable, std::uint64_t otherwise) {
  const char* text = std::getenv(variable);
  return text == nullptr ? otherwise : std::strtoull(text, nullptr, 10);
}

/// Seeds of a bench of noise, from GRIDRT_NOISE_SEED and GRIDRT_NOISE_SCHEDULES.
struct Seeds {
  std::uint64_t begin = number_of("GRIDRT_NOISE_SEED", 0);
  std::uint64_t count = 0;

  explicit Seeds(std::uint64_t otherwise) : count(number_of("GRIDRT_NOISE_SCHEDULES", otherwise)) {}

  /// Runs a schedule for each until one fails. An assertion of the RTL ends the program, so that
  /// the seed is printed first.
  template <class Schedule>
  void run(Schedule schedule) const {
    for (std::uint64_t seed = begin; seed < begin + count && !testing::Test::HasFailure(); ++seed) {
      std::printf("seed %llu\n", static_cast<unsigned long long>(seed));
      std::fflush(stdout);
      SCOPED_TRACE("seed " + std::to_string(seed));
      schedule(seed);
    }
  }
};

}  // namespace gridrt
