#include "host/pe/schedule_paper.hpp"

#include <algorithm>
#include <atomic>
#include <memory>

#include <omp.h>

namespace gridrt {
namespace {

std::uint64_t as_word(const HitKey& key) { return (std::uint64_t{key.quotient} << 32U) | key.id; }

HitKey as_key(std::uint64_t word) {
  return {static_cast<std::uint32_t>(word >> 32U), static_cast<std::uint32_t>(word)};
}

/// The shared array: the smallest key that each PE has found for the ray at hand.
using Results = std::vector<std::atomic<std::uint64_t>>;

/// What one PE does about one ray.
void run_pe(const Engine& engine, const BatchRay& r, std::span<const ListedVoxel> list,
            std::uint32_t number, Results& results, PeCounters& counters) {
  const Pe* pe = engine.pe(number);
  if (pe == nullptr) return;
  const VoxelGrid& grid = engine.traversal().grid();
  HitKey best;
  for (const ListedVoxel& v : list) {
    if (v.cell.pe != number) continue;
    const std::uint32_t enter = v.visit.enter.quotient();
    // A hit of any PE whose quotient is below that of this voxel's entry is one of an earlier
    // voxel and below everything that this one can hold.
    const auto behind = [&] {
      return std::ranges::any_of(results, [&](const std::atomic<std::uint64_t>& word) {
        const HitKey key = as_key(word.load(std::memory_order_relaxed));
        return key.id != kNoTriangle && (key.quotient < enter || r.any_hit);
      });
    };
    if (!test_until(*pe, grid, r, v, best, counters, behind)) return;
    results[number].store(as_word(best), std::memory_order_relaxed);
    if (r.any_hit && best.id != kNoTriangle) return;
  }
}

}  // namespace

void list_voxels(const Engine& engine, const PeRay& ray, std::vector<ListedVoxel>& list,
                 PeCounters& counters) {
  list.clear();
  const TraversalMemory& memory = engine.traversal();
  counters.steps += traverse(
      memory.grid(), ray.p0, ray.p1,
      [&](const glm::ivec3& voxel, int direction) { return memory.jump(voxel, direction); },
      [&](const VoxelVisit& visit) {
        if (const Cell* cell = memory.find(visit.voxel)) list.push_back({visit, *cell});
        return true;
      });
}

void trace_paper(const CommittedImage& image, std::span<const BatchRay> rays,
                 std::span<std::byte> hits, const ScheduleOptions& options, PeCounters& counters) {
  const auto layout = static_cast<protocol::Layout>(image.header.layout);
  const std::uint32_t pes = image.header.pes;
  const int most = std::max(1, static_cast<int>(pes));  // a thread without a PE would only wait
  const int threads = options.threads > 0 ? std::min(options.threads, most) : most;
  std::vector<PeCounters> counts(static_cast<std::size_t>(threads));
  std::vector<std::uint64_t> arrivals(static_cast<std::size_t>(threads));
  Results results(pes);
  std::size_t team = 1;  // there may be fewer threads than asked for
  std::vector<ListedVoxel> list;
  const std::uint64_t start = now_ns();
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const BatchRay& r = rays[i];
    PeAnswer answer;
    if (r.ray.p0 != r.ray.p1) {
      list_voxels(image.engine, r.ray, list, counters);
      for (auto& word : results) word.store(as_word({}), std::memory_order_relaxed);
#pragma omp parallel num_threads(threads)
      {
        const auto me = static_cast<std::size_t>(omp_get_thread_num());
        if (me == 0) team = static_cast<std::size_t>(omp_get_num_threads());
        for (auto p = static_cast<std::uint32_t>(me); p < pes;
             p += static_cast<std::uint32_t>(omp_get_num_threads())) {
          run_pe(image.engine, r, list, p, results, counts[me]);
        }
        arrivals[me] = now_ns();
      }
      const std::uint64_t released = now_ns();
      ++counters.barriers;
      for (const std::uint64_t arrival : std::span(arrivals).first(team)) {
        counters.barrier_ns += released - std::min(arrival, released);
      }
      HitKey best;
      for (const auto& word : results) {
        best = std::min(best, as_key(word.load(std::memory_order_relaxed)));
      }
      if (best.id != kNoTriangle) answer = best;
    }
    ++counters.rays;
    pack_answer(layout, r, answer, i, hits);
  }
  counters.worker_ns += (now_ns() - start) * team;
  for (const PeCounters& mine : counts) counters += mine;
}

}  // namespace gridrt
