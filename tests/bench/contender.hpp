// What is timed: one way of answering rays.
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "host/driver/device.hpp"
#include "host/scene/scene.hpp"
#include "tests/bench/workload.hpp"

namespace gridrt::bench {

/// Answers rays of one scene, which it may prepare for beforehand.
class Contender {
 public:
  virtual ~Contender() = default;
  [[nodiscard]] virtual std::string name() const = 0;

  /// Builds whatever it needs, on `threads` threads, from triangles in memory.
  virtual void build(const Scene& scene, int threads) = 0;

  /// What the clock does not see: brings rays into the form that trace() takes.
  virtual void prepare(const RaySet& rays) = 0;

  /// Traces the prepared rays on `threads` threads.
  virtual void trace(int threads) = 0;

  /// Triangle ids of the last trace(), -1 for a miss, in the order of the rays.
  [[nodiscard]] virtual std::vector<std::int32_t> ids() const = 0;
};

/// GridRT, the device omp. What the clock sees:
enum class Part {
  kPes,      ///< packets of rays to ids, within the device
  kDevice,   ///< segments to hits with t, u, v, through the packets
  kProgram,  ///< rays of the scene to hits with t, u, v
};
struct GridrtChoice {
  Part part = Part::kProgram;
  std::string simd = {};  ///< as DeviceOptions::simd
  int bits = kDefaultBits;
};
std::unique_ptr<Contender> gridrt_contender(const GridrtChoice& choice);

/// GridRT's voxels and walk, but Moeller and Trumbore's test on the vertices and rays as they are
/// given, in plain float or double, one triangle after the other.
enum class Precision { kSingle, kDouble };
std::unique_ptr<Contender> floating_contender(Precision precision);

/// Embree 3: one ray a call (width 1) or packets of 4, 8 or 16.
std::unique_ptr<Contender> embree_contender(int width, bool robust);

}  // namespace gridrt::bench
