// The schedule `paper` on ranks, the paper's Algorithm 3: a barrier for each ray. All ranks work on
// the same ray; each tests its own voxels and tells the others what it hits, which makes those give
// up that are behind; then all wait for each other. The barrier is a message to rank 0, which
// brings the smallest key along, and one back.
#pragma once

#include <deque>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "host/mpi/rank_worker.hpp"
#include "host/pe/schedule_paper.hpp"

namespace gridrt {

class PaperWorker final : public RankWorker {
 public:
  PaperWorker(const Engine& engine, const PesTeam& team, std::function<void()> exchange);

  void add_batch(std::uint32_t batch, std::vector<BatchRay> rays) override;
  void take(std::span<const PesRecord> records) override;
  bool work() override;
  std::vector<PesRecord>& outbox(std::size_t to) override { return outboxes_[to]; }
  std::optional<PesWorker::Finished> take_finished() override;
  [[nodiscard]] bool busy() const override { return !batches_.empty(); }
  PeCounters& counters() override { return counters_; }

 private:
  struct Batch {
    std::uint32_t number = 0;
    std::vector<BatchRay> rays;
    std::vector<HitKey> answers;  ///< rank 0 only
  };
  /// A ray's place among all rays of all batches.
  struct Place {
    std::uint32_t batch = 0;
    std::uint32_t ray = 0;
    auto operator<=>(const Place&) const = default;
  };

  [[nodiscard]] Place here() const { return {batches_.front().number, ray_}; }
  void test_own(const BatchRay& r);
  void arrive();
  void release(const HitKey& answer);
  void tell(std::size_t to, PesKind kind, const HitKey& key);

  const Engine& engine_;
  PesTeam team_;
  std::function<void()> exchange_;
  std::deque<Batch> batches_;
  std::uint32_t ray_ = 0;  ///< of the first batch: the one that all work on
  bool waiting_ = false;   ///< at the barrier
  std::uint64_t arrived_at_ = 0;
  HitKey mine_;                ///< smallest key of own voxels
  HitKey others_;              ///< smallest key that others told
  HitKey barrier_key_;         ///< rank 0: smallest key that has arrived
  std::uint32_t arrived_ = 0;  ///< rank 0: ranks at the barrier
  bool released_ = false;
  std::vector<PesRecord> early_;  ///< about rays that this rank has not come to
  std::vector<ListedVoxel> list_;
  std::vector<std::vector<PesRecord>> outboxes_;
  std::deque<PesWorker::Finished> finished_;
  PeCounters counters_;
};

}  // namespace gridrt
