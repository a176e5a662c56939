#include "host/pe/ray_stream.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "host/pe/ray_candidate.hpp"
#include "host/pe/ray_lanes.hpp"

// Highway compiles what follows once for each kind of vectors.
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_AVX3_DL)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "host/pe/ray_stream.cpp"
#include <hwy/cache_control.h>
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "host/pe/ray_filter-inl.hpp"
#include "host/pe/ray_march-inl.hpp"
#include "host/pe/ray_packet-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace gridrt {
namespace HWY_NAMESPACE {

/// Takes rays from a batch, those that `places` names, and answers them.
class Stream {
 public:
  Stream(const RayLayout& layout, std::span<const BatchRay> rays,
         std::span<const std::uint32_t> places, std::span<PeAnswer> answers, PeCounters& counters)
      : layout_(layout), rays_(rays), places_(places), answers_(answers), counters_(counters) {}

  void run() {
    const std::size_t lanes = hn::Lanes(Floats{});
    for (std::size_t lane = 0; lane < kMostLanes; ++lane) idle_lane(march_, lane);
    unsigned live = 0;
    while (true) {
      // Few empty lanes cost less than filling each at once.
      if (static_cast<std::size_t>(std::popcount(live)) * 4 <= lanes * 3) {
        for (std::size_t lane = 0; lane < lanes; ++lane) {
          if (((live >> lane) & 1U) == 0 && fill(lane)) live |= 1U << lane;
        }
        if (live == 0) break;
      }
      const Looked looked = look(layout_, march_);
      // The memory of all voxels first, then the work on each.
      for (unsigned with = looked.occupied & live; with != 0; with &= with - 1) {
        fetch(static_cast<std::size_t>(std::countr_zero(with)));
      }
      for (unsigned with = looked.occupied & live; with != 0; with &= with - 1) {
        test(static_cast<std::size_t>(std::countr_zero(with)));
      }
      counters_.steps += static_cast<std::uint64_t>(std::popcount(live));
      unsigned ended = advance(march_, looked.reach) & live;
      live &= ~ended;
      for (; ended != 0; ended &= ended - 1) end(static_cast<std::size_t>(std::countr_zero(ended)));
    }
  }

 private:
  bool fill(std::size_t lane) {
    while (next_ < places_.size()) {
      const std::size_t index = places_[next_++];
      const BatchRay& ray = rays_[index];
      ++counters_.rays;
      if (ray.ray.p0 == ray.ray.p1) {
        answers_[index] = std::nullopt;
        continue;
      }
      tests_[lane] = start_test(ray, index);
      start_march(layout_, ray.ray, march_, lane);
      return true;
    }
    return false;
  }

  void fetch(std::size_t lane) const {
    constexpr std::size_t kLine = 16;  // floats
    const LayoutCell& cell = layout_.cell(layout_.codes()[march_.voxel[lane]]);
    const float* const block = layout_.block(cell.first);
    for (std::size_t i = 0; i < kBlockRows * hn::Lanes(Floats{}); i += kLine) {
      hwy::Prefetch(block + i);
    }
    hwy::Prefetch(layout_.ids(cell.first));
  }

  void test(std::size_t lane) {
    TestLane& test = tests_[lane];
    const std::int32_t code = layout_.codes()[march_.voxel[lane]];
    const LayoutCell& cell = layout_.cell(code);
    counters_.tests += cell.triangles;
    if (!test_cell(layout_, cell, test)) return;
    march_.limit[lane] = test.ray->any_hit ? -1.0F : test.limit;
  }

  void end(std::size_t lane) {
    const TestLane& test = tests_[lane];
    answers_[test.index] = std::nullopt;
    if (test.best.id != kNoTriangle) {
      ++counters_.interrupts;
      answers_[test.index] = test.ray->any_hit ? HitKey{0, 0} : test.best;
    }
    idle_lane(march_, lane);
  }

  const RayLayout& layout_;
  std::span<const BatchRay> rays_;
  std::span<const std::uint32_t> places_;
  std::span<PeAnswer> answers_;
  PeCounters& counters_;
  std::size_t next_ = 0;
  MarchLanes march_{};
  std::array<TestLane, kMostLanes> tests_;
};

void trace_stream(const RayLayout& layout, std::span<const BatchRay> rays,
                  std::span<PeAnswer> answers, PeCounters& counters) {
  const std::size_t lanes = hn::Lanes(Floats{});
  std::vector<std::uint32_t> alone;
  alone.reserve(rays.size());
  Packet packet(layout);
  for (std::size_t first = 0; first < rays.size(); first += lanes) {
    const std::size_t count = std::min(lanes, rays.size() - first);
    if (count == lanes && packet.trace(&rays[first], &answers[first], counters)) continue;
    for (std::size_t i = 0; i < count; ++i) alone.push_back(static_cast<std::uint32_t>(first + i));
  }
  Stream(layout, rays, alone, answers, counters).run();
}

std::size_t stream_lanes() { return hn::Lanes(Floats{}); }

}  // namespace HWY_NAMESPACE
}  // namespace gridrt
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include "host/grid/vector_name.hpp"

namespace gridrt {
namespace {

HWY_EXPORT(trace_stream);
HWY_EXPORT(stream_lanes);

}  // namespace

std::vector<StreamKernel> stream_kernels() {
  std::vector<StreamKernel> kernels;
  // The best target has the lowest bit.
  for (std::int64_t left = hwy::SupportedTargets() & HWY_TARGETS; left != 0; left &= left - 1) {
    hwy::ChosenTarget target;
    target.Update(left & -left);
    const std::size_t index = target.GetIndex();
    kernels.push_back({vector_name(left & -left), HWY_DISPATCH_TABLE(stream_lanes)[index](),
                       HWY_DISPATCH_TABLE(trace_stream)[index]});
  }
  return kernels;
}

std::optional<StreamKernel> stream_kernel(std::string_view name) {
  for (const StreamKernel& kernel : stream_kernels()) {
    if (name.empty() || kernel.name == name) return kernel;
  }
  return std::nullopt;
}

}  // namespace gridrt
#endif  // HWY_ONCE
