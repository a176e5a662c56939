// The engine on its own: an image into its memories, rays in at its ray port, answers out at its
// hit port. What a shell would do, and nothing else.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "gridrt_protocol.hpp"
#include "host/grid/segment.hpp"
#include "host/image/image.hpp"

namespace gridrt::rtl {

/// Sums of counts_t over clocks.
struct EngineCounts {
  long rays = 0;
  long steps = 0;
  long tests = 0;
  long masked = 0;
  long interrupts = 0;
  long feedback_waits = 0;
  long in_flight = 0;
  long no_ray = 0;
  long no_slot = 0;
  long traversal_idle = 0;
  long queue_full = 0;
  long pe_idle = 0;
  long divider_busy = 0;
  long hit_wait = 0;
};

/// What gridrt_pace has seen of a PE.
struct PeWork {
  long tests = 0;
  long clocks = 0;  ///< in which a reference that was then tested had been waiting
};

/// How a run drives the two ports.
struct EngineRun {
  int offer = 100;  ///< percent of clocks in which a ray is offered; an offer stays until taken
  int take = 100;   ///< percent of clocks in which a hit is taken
  std::uint64_t seed = 1;
  long patience = 100000;  ///< clocks without a ray or hit after which the run is given up
};

/// What came of a run.
struct EngineAnswers {
  std::vector<protocol::HitCompact> hits;  ///< in order; fewer than rays if the engine hung
  long clocks = 0;                         ///< from the first ray taken to the last hit
  EngineCounts counts;
  std::vector<PeWork> pes;  ///< by PE; none if the model is without gridrt_pace
};

/// A ray record; `local_ignore` is a local id, or all ones.
protocol::RayCompact engine_ray(const Segment& segment, std::uint32_t local_ignore, bool any_hit);

class EngineHarness {
 public:
  explicit EngineHarness(int seed = 1);
  EngineHarness(const EngineHarness&) = delete;
  EngineHarness& operator=(const EngineHarness&) = delete;
  EngineHarness(EngineHarness&&) = delete;
  EngineHarness& operator=(EngineHarness&&) = delete;
  ~EngineHarness();

  /// Writes every record of a compact image and configures the grid.
  void load(const Image& image);

  EngineAnswers trace(std::span<const protocol::RayCompact> rays, const EngineRun& run = {});

 private:
  class Rtl;
  std::unique_ptr<Rtl> rtl_;
};

}  // namespace gridrt::rtl
