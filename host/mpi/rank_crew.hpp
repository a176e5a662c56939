// Rank 0's end of a device whose PEs are ranks: hands each rank its own PEs' sections and every
// rank every batch, works on batches itself, and notices when a rank or a message is gone.
#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <memory>
#include <string>

#include "host/mpi/patience.hpp"
#include "host/mpi/postbox.hpp"
#include "host/mpi/rank_groups.hpp"
#include "host/mpi/rank_member.hpp"
#include "host/mpi/split_orders.hpp"
#include "host/pe/crew.hpp"

namespace gridrt {

class RankCrew final : public Crew {
 public:
  /// Opens the device numbered `device` (> 0, unlike any before) on all ranks. `silence`: so long
  /// may a rank say nothing while work is under way, and so long may nothing go on. `groups` of
  /// ranks, a divisor of their number, get a part of each order.
  RankCrew(std::unique_ptr<Postbox> postbox, int device, const ScheduleOptions& schedule,
           const protocol::CapabilitiesReport& limits, std::chrono::milliseconds silence,
           int groups = 1);
  ~RankCrew() override;

  Accepted<void> load(const protocol::LoadHead& head, std::span<const std::byte> bytes) override;
  Accepted<void> commit(std::uint64_t pe_mask) override;
  [[nodiscard]] protocol::Layout layout() const override;
  Accepted<void> start(const TraceOrder& order) override;
  std::optional<TraceAnswer> finish(std::chrono::milliseconds patience) override;
  PeCounters counters() override;
  void reset() override;
  [[nodiscard]] Result<void> health() const override { return health_; }

 private:
  void send(int to, ParcelKind kind, std::uint64_t number, std::span<const std::byte> head,
            std::span<const std::byte> bytes = {});
  void send_all(ParcelKind kind, std::uint64_t number, std::span<const std::byte> content);
  std::size_t fetch();
  void take(Parcel& parcel);
  Accepted<void> await_replies(int replies);
  void tick();
  void check_silence();
  void give_up(std::string message, std::string advice);
  void listen_to(int group);
  Accepted<void> start_part(std::span<const std::byte> records, const OrderPart& part);
  void take_answer(std::uint32_t batch, std::span<const std::byte> hits);

  std::unique_ptr<Postbox> postbox_;
  int device_;
  int ranks_;
  RankGroups groups_;
  std::chrono::milliseconds silence_;
  RankMember member_;
  bool ready_ = false;
  std::uint32_t next_batch_ = 0;
  SplitOrders orders_;
  std::deque<Parcel> deferred_;  ///< fetched in the midst of work
  Patience patience_;

  // Replies to the question at hand.
  int replies_ = 0;
  Accepted<void> verdict_;
  PeCounters counts_;

  // Time that was spent with listening: a halt of the whole program is no silence.
  std::chrono::steady_clock::time_point last_tick_;
  std::chrono::nanoseconds listened_{0};
  std::vector<std::chrono::nanoseconds> heard_;  ///< when each rank was heard last
  std::chrono::nanoseconds progress_{0};         ///< when anything went on

  Result<void> health_;
};

}  // namespace gridrt
