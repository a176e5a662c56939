#include "host/pe/schedule_pes.hpp"

#include <algorithm>
#include <atomic>
#include <mutex>
#include <thread>

#include <omp.h>

#include "host/pe/pes_worker.hpp"

namespace gridrt {
namespace {

/// What others have sent to one thread.
class Mailbox {
 public:
  void put(std::vector<PesRecord>& records) {
    const std::scoped_lock lock(mutex_);
    records_.insert(records_.end(), records.begin(), records.end());
    full_.store(true, std::memory_order_release);
  }
  /// Swaps the content with `out`, which is empty.
  void take(std::vector<PesRecord>& out) {
    if (!full_.load(std::memory_order_acquire)) return;
    const std::scoped_lock lock(mutex_);
    out.swap(records_);
    full_.store(false, std::memory_order_relaxed);
  }

 private:
  std::mutex mutex_;
  std::atomic<bool> full_{false};
  std::vector<PesRecord> records_;
};

/// Delivers what a worker has written, a parcel for each receiver.
void send_all(PesWorker& worker, std::size_t self, std::span<Mailbox> mailboxes) {
  PeCounters& counters = worker.counters();
  for (std::size_t to = 0; to < mailboxes.size(); ++to) {
    std::vector<PesRecord>& records = worker.outbox(to);
    if (to == self || records.empty()) continue;
    const std::uint64_t start = now_ns();
    mailboxes[to].put(records);
    counters.message_ns += now_ns() - start;
    ++counters.messages;
    counters.message_bytes += records.size() * sizeof(PesRecord);
    records.clear();
  }
}

/// One thread's part, until the collector has every answer.
void run_worker(PesWorker& worker, std::size_t self, std::span<Mailbox> mailboxes,
                std::atomic<bool>& done) {
  PeCounters& counters = worker.counters();
  const std::uint64_t start = now_ns();
  std::uint64_t idle_since = 0;
  std::vector<PesRecord> received;
  while (!done.load(std::memory_order_acquire)) {
    received.clear();
    mailboxes[self].take(received);
    worker.take(received);
    const bool worked = worker.work() || worker.work_ahead();
    send_all(worker, self, mailboxes);
    if (self == 0 && !worker.busy()) done.store(true, std::memory_order_release);
    if (worked || !received.empty()) {
      if (idle_since != 0) counters.wait_ns += now_ns() - idle_since;
      idle_since = 0;
      continue;
    }
    if (idle_since == 0) idle_since = now_ns();
    std::this_thread::yield();
  }
  const std::uint64_t end = now_ns();
  if (idle_since != 0) counters.wait_ns += end - idle_since;
  counters.worker_ns += end - start;
}

}  // namespace

void trace_pes(const CommittedImage& image, std::span<const BatchRay> rays,
               std::span<std::byte> hits, const ScheduleOptions& options, PeCounters& counters) {
  const int workers = std::clamp(options.threads, 1, static_cast<int>(image.header.pes));
  std::vector<Mailbox> mailboxes(static_cast<std::size_t>(workers));
  std::atomic<bool> done{false};
  PesWorker::Finished finished;
#pragma omp parallel num_threads(workers) if (workers > 1)
  {
    PesTeam team;
    team.worker = static_cast<std::uint32_t>(omp_get_thread_num());
    team.workers = static_cast<std::uint32_t>(omp_get_num_threads());
    team.interrupt = options.interrupt;
    team.feedback = options.feedback;
    PesWorker worker(image.engine, team);
    worker.add_batch(0, {rays.begin(), rays.end()});
    run_worker(worker, team.worker, std::span(mailboxes).first(team.workers), done);
    if (team.worker == 0) {
      if (auto all = worker.take_finished()) finished = std::move(*all);
    }
#pragma omp critical
    counters += worker.counters();
  }
  const auto layout = static_cast<protocol::Layout>(image.header.layout);
  for (std::size_t i = 0; i < finished.rays.size(); ++i) {
    const HitKey& key = finished.answers[i];
    pack_answer(layout, finished.rays[i], key.id == kNoTriangle ? PeAnswer{} : PeAnswer{key}, i,
                hits);
  }
}

}  // namespace gridrt
