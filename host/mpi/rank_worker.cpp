#include "host/mpi/rank_worker.hpp"

#include <utility>

#include "host/mpi/paper_worker.hpp"

namespace gridrt {
namespace {

/// The schedule `pes`: the same worker as on threads.
class PesRankWorker final : public RankWorker {
 public:
  PesRankWorker(const Engine& engine, const PesTeam& team) : worker_(engine, team) {}

  void add_batch(std::uint32_t batch, std::vector<BatchRay> rays) override {
    worker_.add_batch(batch, std::move(rays));
  }
  void take(std::span<const PesRecord> records) override { worker_.take(records); }
  bool work() override { return worker_.work() || worker_.work_ahead(); }
  std::vector<PesRecord>& outbox(std::size_t to) override { return worker_.outbox(to); }
  std::optional<PesWorker::Finished> take_finished() override { return worker_.take_finished(); }
  [[nodiscard]] bool busy() const override { return worker_.busy(); }
  PeCounters& counters() override { return worker_.counters(); }

 private:
  PesWorker worker_;
};

}  // namespace

std::unique_ptr<RankWorker> make_rank_worker(const Engine& engine, const PesTeam& team,
                                             Schedule schedule, std::function<void()> exchange) {
  if (schedule == Schedule::kPaper) {
    return std::make_unique<PaperWorker>(engine, team, std::move(exchange));
  }
  return std::make_unique<PesRankWorker>(engine, team);
}

}  // namespace gridrt
