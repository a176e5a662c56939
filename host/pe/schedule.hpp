// How software PEs share the work on a batch of rays. No choice here changes an answer, except
// `feedback` off, which is there to show that feedback is needed.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace gridrt {

enum class Schedule : std::uint8_t {
  kRays,   ///< a worker runs every PE that its ray needs; nothing is exchanged
  kPes,    ///< a worker is a PE; interrupt and feedback messages settle the hits
  kPaper,  ///< a parallel section and a barrier for each ray
};

inline std::optional<Schedule> schedule_of(std::string_view name) {
  if (name == "rays") return Schedule::kRays;
  if (name == "pes") return Schedule::kPes;
  if (name == "paper") return Schedule::kPaper;
  return std::nullopt;
}

struct ScheduleOptions {
  Schedule schedule = Schedule::kRays;
  bool plain = true;      ///< kRays: an exact test after the other, the reference; else vectors
  std::string simd = {};  ///< kind of vectors (ray_stream.hpp); empty: the widest
  int threads = 1;        ///< workers, >= 1; of kPaper 0: one for each PE of the image,
                          ///< and never more
  bool interrupt = true;  ///< kPes: a hit cancels the voxels behind it; for measurements
  bool feedback = true;   ///< kPes: a hit waits for the voxels before it; off: wrong answers
};

/// Nanoseconds since an arbitrary moment.
inline std::uint64_t now_ns() {
  return static_cast<std::uint64_t>(std::chrono::duration_cast<std::chrono::nanoseconds>(
                                        std::chrono::steady_clock::now().time_since_epoch())
                                        .count());
}

}  // namespace gridrt
