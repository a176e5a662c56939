// One rank's PEs at work on batches, whichever the schedule.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "host/pe/pes_worker.hpp"
#include "host/pe/schedule.hpp"

namespace gridrt {

class RankWorker {
 public:
  RankWorker() = default;
  RankWorker(const RankWorker&) = delete;
  RankWorker& operator=(const RankWorker&) = delete;
  virtual ~RankWorker() = default;

  /// Every rank gets every batch, with numbers that ascend by one.
  virtual void add_batch(std::uint32_t batch, std::vector<BatchRay> rays) = 0;

  virtual void take(std::span<const PesRecord> records) = 0;

  /// Does a little; false if there is nothing to do.
  virtual bool work() = 0;

  /// Messages to rank `to`; whoever carries them empties it.
  virtual std::vector<PesRecord>& outbox(std::size_t to) = 0;

  /// Rank 0's next batch that is settled, once.
  virtual std::optional<PesWorker::Finished> take_finished() = 0;

  /// True while a batch is not done.
  [[nodiscard]] virtual bool busy() const = 0;

  virtual PeCounters& counters() = 0;
};

/// `exchange` is called in the midst of long work to deliver and fetch messages; it may call take()
/// and empties outboxes. `engine` outlives the worker.
std::unique_ptr<RankWorker> make_rank_worker(const Engine& engine, const PesTeam& team,
                                             Schedule schedule, std::function<void()> exchange);

}  // namespace gridrt
