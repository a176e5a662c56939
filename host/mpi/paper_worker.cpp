#include "host/mpi/paper_worker.hpp"

#include <algorithm>
#include <utility>

namespace gridrt {

PaperWorker::PaperWorker(const Engine& engine, const PesTeam& team, std::function<void()> exchange)
    : engine_(engine), team_(team), exchange_(std::move(exchange)), outboxes_(team.workers) {}

void PaperWorker::add_batch(std::uint32_t number, std::vector<BatchRay> rays) {
  Batch batch{number, std::move(rays), {}};
  if (team_.worker == 0) batch.answers.resize(batch.rays.size());
  batches_.push_back(std::move(batch));
  if (batches_.size() > 1) return;
  std::vector<PesRecord> early;
  early.swap(early_);
  take(early);
}

void PaperWorker::take(std::span<const PesRecord> records) {
  for (const PesRecord& record : records) {
    const Place about{record.batch, record.ray};
    if (batches_.empty() || about > here()) {
      early_.push_back(record);
      continue;
    }
    if (about < here()) continue;  // a hit that is known by now
    switch (record.kind) {
      case PesKind::kInterrupt:
        others_ = std::min(others_, record.key);
        break;
      case PesKind::kSettled:  // another rank is at the barrier
        barrier_key_ = std::min(barrier_key_, record.key);
        ++arrived_;
        break;
      default:
        released_ = true;
    }
  }
}

bool PaperWorker::work() {
  if (batches_.empty()) return false;
  const BatchRay& r = batches_.front().rays[ray_];
  if (r.ray.p0 == r.ray.p1) {  // needs nobody
    release({});
    return true;
  }
  if (!waiting_) {
    test_own(r);
    arrive();
    return true;
  }
  if (team_.worker == 0) released_ = arrived_ == team_.workers;
  if (!released_) return false;
  counters_.barrier_ns += now_ns() - arrived_at_;
  if (team_.worker == 0) {
    ++counters_.barriers;
    for (std::size_t to = 1; to < team_.workers; ++to) tell(to, PesKind::kDone, {});
  }
  release(barrier_key_);
  return true;
}

void PaperWorker::test_own(const BatchRay& r) {
  list_voxels(engine_, r.ray, list_, counters_);
  for (const ListedVoxel& v : list_) {
    if (v.cell.pe % team_.workers != team_.worker) continue;
    const Pe* pe = engine_.pe(v.cell.pe);
    if (pe == nullptr) continue;
    const std::uint32_t enter = v.visit.enter.quotient();
    // As on threads: a hit whose quotient is below that of this voxel's entry is one of an earlier
    // voxel and below everything that this one can hold.
    const auto behind = [&] {
      exchange_();
      const HitKey known = std::min(mine_, others_);
      return known.id != kNoTriangle && (known.quotient < enter || r.any_hit);
    };
    const HitKey before = mine_;
    if (!test_until(*pe, engine_.traversal().grid(), r, v, mine_, counters_, behind)) return;
    if (!(mine_ < before)) continue;
    for (std::size_t to = 0; to < team_.workers; ++to) {
      if (to == team_.worker) continue;
      ++counters_.interrupts_sent;
      tell(to, PesKind::kInterrupt, mine_);
    }
  }
}

void PaperWorker::arrive() {
  waiting_ = true;
  arrived_at_ = now_ns();
  if (team_.worker == 0) {
    ++arrived_;
    barrier_key_ = std::min(barrier_key_, mine_);
  } else {
    tell(0, PesKind::kSettled, mine_);
  }
}

void PaperWorker::release(const HitKey& answer) {
  Batch& batch = batches_.front();
  if (team_.worker == 0) {
    batch.answers[ray_] = answer;
    ++counters_.rays;
  }
  waiting_ = false;
  released_ = false;
  arrived_ = 0;
  mine_ = others_ = barrier_key_ = {};
  if (++ray_ == batch.rays.size()) {
    ray_ = 0;
    if (team_.worker == 0) {
      finished_.push_back({batch.number, std::move(batch.rays), std::move(batch.answers)});
    }
    batches_.pop_front();
  }
  std::vector<PesRecord> early;
  early.swap(early_);
  take(early);
}

void PaperWorker::tell(std::size_t to, PesKind kind, const HitKey& key) {
  outboxes_[to].push_back({kind, batches_.front().number, ray_, 0, key});
}

std::optional<PesWorker::Finished> PaperWorker::take_finished() {
  if (finished_.empty()) return std::nullopt;
  PesWorker::Finished first = std::move(finished_.front());
  finished_.pop_front();
  return first;
}

}  // namespace gridrt
