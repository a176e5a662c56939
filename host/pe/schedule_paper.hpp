// The schedule `paper` on threads, the paper's Algorithm 2: a parallel section for each ray in
// which every PE tests its own voxels and writes to a shared result array. The baseline that it
// is: what its barriers and aborted tests cost is counted.
#pragma once

#include <span>

#include "host/grid/quarters.hpp"
#include "host/pe/ray_batch.hpp"
#include "host/pe/schedule.hpp"

namespace gridrt {

/// A voxel of a ray's traversal list.
struct ListedVoxel {
  VoxelVisit visit;
  Cell cell;
};

/// The voxels with references that the ray meets, in order of entry; replaces `list`.
void list_voxels(const Engine& engine, const PeRay& ray, std::vector<ListedVoxel>& list,
                 PeCounters& counters);

/// Tests one voxel a few references at a time; between them `behind()` says whether a hit before
/// everything that this voxel can hold is known by now, which aborts it. Returns false if aborted.
template <class Behind>
bool test_until(const Pe& pe, const VoxelGrid& grid, const BatchRay& r, const ListedVoxel& v,
                HitKey& best, PeCounters& counters, Behind&& behind) {
  constexpr std::uint32_t kSlice = 32;  ///< references
  const CellSet cells = ray_cells(grid, r.ray.p0, r.ray.p1, v.visit);
  const std::uint64_t tests = counters.tests;
  const std::uint64_t start = now_ns();
  for (std::uint32_t done = 0; done < v.cell.count; done += kSlice) {
    if (behind()) {
      ++counters.interrupts;
      counters.tests_aborted += counters.tests - tests;
      counters.aborted_ns += now_ns() - start;
      return false;
    }
    const std::uint32_t count = v.cell.count - done < kSlice ? v.cell.count - done : kSlice;
    if (!r.any_hit) {
      pe.test(r.ray, v.cell.first + done, count, cells, best, counters);
    } else if (pe.test_any(r.ray, v.cell.first + done, count, cells, counters)) {
      best = HitKey{0, 0};
      return true;
    }
  }
  return true;
}

/// Answers all rays, one after the other; a hit record each to `hits`.
void trace_paper(const CommittedImage& image, std::span<const BatchRay> rays,
                 std::span<std::byte> hits, const ScheduleOptions& options, PeCounters& counters);

}  // namespace gridrt
