#include "host/pe/pes_worker.hpp"

#include <algorithm>
#include <utility>

#include "host/grid/quarters.hpp"

namespace gridrt {
namespace {

constexpr std::size_t kPiece = 64;      ///< rays whose feedback starts at one worker
constexpr std::uint32_t kAhead = 4;     ///< own voxels of a ray that are tested in advance
constexpr std::size_t kAheadRays = 16;  ///< rays looked at in one call of work_ahead()

/// Calls visit(const VoxelVisit&, place) for the voxels from `place` on, until it returns false.
/// Returns the number of slabs looked at.
template <class Visit>
std::uint64_t walk(const TraversalMemory& memory, const PeRay& ray, std::uint32_t place,
                   Visit&& visit) {
  std::uint64_t steps = 0;
  SlabMarch march(memory.grid(), ray.p0, ray.p1);
  march.seek(static_cast<int>(place >> 4U));
  std::size_t index = place & 15U;
  for (; march.has_slab(); index = 0) {
    ++steps;
    const std::span<const VoxelVisit> voxels = march.voxels();
    if (index == 0 && !voxels.empty()) {
      int jump = memory.jump(voxels[0].voxel, march.direction());
      for (const VoxelVisit& v : voxels.subspan(1)) {
        jump = std::min(jump, memory.jump(v.voxel, march.direction()));
      }
      if (jump > 0) {
        march.skip_blocks(jump);
        continue;
      }
    }
    for (; index < voxels.size(); ++index) {
      const auto here = static_cast<std::uint32_t>((march.step() << 4) | static_cast<int>(index));
      if (!visit(voxels[index], here)) return steps;
    }
    march.next();
  }
  return steps;
}

}  // namespace

PesWorker::PesWorker(const Engine& engine, const PesTeam& team)
    : engine_(engine), team_(team), next_batch_(team.first_batch), outboxes_(team.workers) {}

void PesWorker::add_batch(std::uint32_t number, std::vector<BatchRay> rays) {
  next_batch_ = number + 1;
  Batch& batch = batches_[number];
  batch.rays = std::move(rays);
  batch.states.resize(batch.rays.size());
  batch.next_home = team_.worker * kPiece;
  batch.ahead_left = batch.rays.size();
  if (team_.worker == 0) {
    batch.answers.resize(batch.rays.size());
    batch.settled.resize(batch.rays.size());
    batch.open = batch.rays.size();
  }
  std::vector<PesRecord> early;
  early.swap(early_);
  take(early);
}

void PesWorker::take(std::span<const PesRecord> records) {
  for (const PesRecord& record : records) take_one(record);
}

void PesWorker::take_one(const PesRecord& record) {
  const auto entry = batches_.find(record.batch);
  if (entry == batches_.end()) {
    // Messages overtake batches, and late interrupts are overtaken by the end of theirs.
    if (record.batch >= next_batch_) early_.push_back(record);
    return;
  }
  Batch& batch = entry->second;
  switch (record.kind) {
    case PesKind::kFeedback:
      feedbacks_.push_back(record);
      return;
    case PesKind::kInterrupt: {
      RayState& state = batch.states[record.ray];
      state.known = std::min(state.known, record.key);
      if (record.place == kSettledPlace) state.touched = true;
      return;
    }
    case PesKind::kSettled:
      collect(record.batch, batch, record.ray, record.key);
      return;
    case PesKind::kDone:
      batches_.erase(entry);
      return;
  }
}

bool PesWorker::work() {
  if (!feedbacks_.empty()) {
    for (std::size_t n = 0; n < kPiece && !feedbacks_.empty(); ++n) {
      const PesRecord record = feedbacks_.back();
      feedbacks_.pop_back();
      const auto entry = batches_.find(record.batch);
      if (entry == batches_.end()) continue;  // only without feedback: settled behind its back
      follow({record.batch, entry->second, record.ray}, record.place, record.key);
    }
    return true;
  }
  for (auto& [number, batch] : batches_) {
    if (batch.next_home >= batch.rays.size()) continue;
    const std::uint32_t id = number;
    const std::size_t first = batch.next_home;
    const std::size_t end = std::min(first + kPiece, batch.rays.size());
    batch.next_home += kPiece * team_.workers;
    for (std::size_t i = first; i < end; ++i) {
      follow({id, batch, static_cast<std::uint32_t>(i)}, 0, {});
      if (!batches_.contains(id)) break;  // that was the batch's last open ray
    }
    return true;
  }
  return false;
}

bool PesWorker::work_ahead() {
  // From the end of a batch, whose feedbacks come last.
  for (auto& [number, batch] : batches_) {
    if (batch.ahead_left == 0) continue;
    const std::uint64_t before = counters_.tests;
    const std::uint32_t id = number;
    for (std::size_t n = 0; n < kAheadRays && batch.ahead_left > 0; ++n) {
      const auto ray = static_cast<std::uint32_t>(--batch.ahead_left);
      if (batch.states[ray].touched || batch.rays[ray].ray.p0 == batch.rays[ray].ray.p1) continue;
      test_ahead({id, batch, ray});
      if (!batches_.contains(id)) break;  // that was the batch's last open ray
    }
    counters_.tests_ahead += counters_.tests - before;
    return true;
  }
  return false;
}

bool PesWorker::test_voxel(const Run& run, const VoxelVisit& visit, const Cell& cell,
                           HitKey& best) {
  const Pe* pe = engine_.pe(cell.pe);
  if (pe == nullptr) return false;
  const BatchRay& r = run.batch.rays[run.ray];
  const CellSet cells = ray_cells(engine_.traversal().grid(), r.ray.p0, r.ray.p1, visit);
  const HitKey before = best;
  if (!r.any_hit) {
    pe->test(r.ray, cell.first, cell.count, cells, best, counters_);
  } else if (pe->test_any(r.ray, cell.first, cell.count, cells, counters_)) {
    best = HitKey{0, 0};
  }
  return best < before;
}

void PesWorker::follow(const Run& run, std::uint32_t place, HitKey best) {
  RayState& state = run.batch.states[run.ray];
  const BatchRay& r = run.batch.rays[run.ray];
  state.touched = true;
  best = std::min(best, state.known);
  const bool settled_ahead = r.any_hit && team_.interrupt && best.id != kNoTriangle;
  if (r.ray.p0 == r.ray.p1 || settled_ahead) return settle(run, best, false);
  std::optional<std::uint32_t> next_owner;
  bool cancelled = false;
  counters_.steps +=
      walk(engine_.traversal(), r.ray, place, [&](const VoxelVisit& visit, std::uint32_t here) {
        // As in Engine::closest_hit: an equal quotient may hold a lower id.
        if (cancels(best, visit)) {
          ++counters_.interrupts;
          cancelled = true;
          return false;
        }
        const Cell* cell = engine_.traversal().find(visit.voxel);
        if (cell == nullptr) return true;
        place = here;
        const std::uint32_t owner = cell->pe % team_.workers;
        if (owner != team_.worker) {
          next_owner = owner;
          return false;
        }
        if (here < state.ahead) return true;  // answered in advance
        const bool hit = test_voxel(run, visit, *cell, best);
        cancelled = hit && ((r.any_hit && team_.interrupt) || !team_.feedback);
        return !cancelled;
      });
  if (!next_owner) return settle(run, best, cancelled);
  // From here on, only voxels behind `place` are of interest.
  state.ahead = std::max(state.ahead, place);
  if (best.id != kNoTriangle) ++counters_.feedback_waits;
  ++counters_.feedbacks_sent;
  outboxes_[*next_owner].push_back({PesKind::kFeedback, run.batch_number, run.ray, place, best});
}

void PesWorker::test_ahead(const Run& run) {
  RayState& state = run.batch.states[run.ray];
  const BatchRay& r = run.batch.rays[run.ray];
  state.touched = true;
  HitKey best = state.known;
  std::uint32_t tested = 0;
  std::uint32_t ahead = kSettledPlace;  // all of them, unless the walk stops before
  counters_.steps +=
      walk(engine_.traversal(), r.ray, 0, [&](const VoxelVisit& visit, std::uint32_t here) {
        if (cancels(best, visit)) {
          ++counters_.interrupts;
          return false;
        }
        const Cell* cell = engine_.traversal().find(visit.voxel);
        if (cell == nullptr || cell->pe % team_.workers != team_.worker) {
          return true;
        }
        if (tested++ == kAhead) {
          ahead = here;
          return false;
        }
        const bool hit = test_voxel(run, visit, *cell, best);
        return !(hit && r.any_hit && team_.interrupt);
      });
  state.ahead = ahead;
  if (!(best < state.known)) return;
  state.known = best;
  if ((r.any_hit && team_.interrupt) || !team_.feedback) return settle(run, best, true);
  ++counters_.feedback_waits;
  if (team_.interrupt) interrupt_others(run, 0, best);
}

void PesWorker::settle(const Run& run, const HitKey& answer, bool cancels) {
  if (cancels && team_.interrupt) interrupt_others(run, kSettledPlace, answer);
  if (team_.worker != 0) {
    outboxes_[0].push_back({PesKind::kSettled, run.batch_number, run.ray, 0, answer});
    return;
  }
  collect(run.batch_number, run.batch, run.ray, answer);
}

void PesWorker::collect(std::uint32_t number, Batch& batch, std::uint32_t ray,
                        const HitKey& answer) {
  if (batch.settled[ray] != 0) return;
  batch.settled[ray] = 1;
  batch.answers[ray] = answer;
  ++counters_.rays;
  if (--batch.open > 0) return;
  finished_.push_back({number, std::move(batch.rays), std::move(batch.answers)});
  for (std::uint32_t w = 1; w < team_.workers; ++w) {
    outboxes_[w].push_back({PesKind::kDone, number, 0, 0, {}});
  }
  batches_.erase(number);
}

void PesWorker::interrupt_others(const Run& run, std::uint32_t place, const HitKey& key) {
  for (std::uint32_t w = 0; w < team_.workers; ++w) {
    if (w == team_.worker) continue;
    ++counters_.interrupts_sent;
    outboxes_[w].push_back({PesKind::kInterrupt, run.batch_number, run.ray, place, key});
  }
}

std::optional<PesWorker::Finished> PesWorker::take_finished() {
  if (finished_.empty()) return std::nullopt;
  Finished first = std::move(finished_.front());
  finished_.pop_front();
  return first;
}

}  // namespace gridrt
