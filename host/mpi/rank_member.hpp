// One rank's part of a device: its own PEs' image, its worker, and the parcels between them and the
// other ranks. Rank 0's belongs to a RankCrew, the others' to a RankServer.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "host/mpi/postbox.hpp"
#include "host/mpi/rank_groups.hpp"
#include "host/mpi/rank_worker.hpp"
#include "host/pe/image_store.hpp"

namespace gridrt {

/// Content of kOpen.
struct OpenOrder {
  Schedule schedule = Schedule::kPes;
  bool interrupt = true;
  bool feedback = true;
  std::uint32_t beat_ms = 1000;  ///< between two beats while batches are under way
  int groups = 1;                ///< of ranks, see RankGroups
  protocol::CapabilitiesReport limits;
};

/// Content of kCommit.
struct CommitOrder {
  std::uint64_t pe_mask = 0;
  std::uint32_t first_batch = 0;  ///< number of the next batch
  std::uint32_t reserved = 0;
};

/// kVerdict's number, and back.
std::uint64_t pack_verdict(const Accepted<void>& verdict);
Accepted<void> unpack_verdict(std::uint64_t number);

class RankMember {
 public:
  /// Member m of a group of M owns the PEs p of an image with p mod M = m. `postbox` outlives the
  /// member.
  RankMember(Postbox& postbox, int device, const OpenOrder& order);

  Accepted<void> load(const protocol::LoadHead& head, std::span<const std::byte> bytes);
  Accepted<void> commit(const CommitOrder& order);
  void reset();

  /// Unpacks and begins a batch. Refuses rays outside the box, and all without an image.
  Accepted<void> add_batch(std::uint32_t batch, std::span<const std::byte> records);

  /// A parcel of records.
  void take_records(std::span<const std::byte> content);

  /// Does a little; false if there was nothing to do.
  bool work();

  /// Sends what work() has left in order to fill a parcel. To be called before a pause.
  void flush();

  /// True while a batch is under way.
  [[nodiscard]] bool busy() const { return worker_ && worker_->busy(); }
  [[nodiscard]] const protocol::ImageHeader* image() const {
    return image_ ? &image_->header : nullptr;
  }

  /// A batch's hit records.
  struct Answer {
    std::uint32_t batch = 0;
    std::vector<std::byte> hits;
  };
  /// The next answered batch of a group whose first member this is, once.
  std::optional<Answer> take_answer();
  PeCounters counters();

  /// Sends and counts a parcel that belongs to the work on rays.
  void send(Parcel parcel);

  /// Errors: kTransport, the first that sending or fetching met.
  [[nodiscard]] const Result<void>& health() const { return health_; }

  /// Called in the midst of long work, so that parcels are fetched; set once.
  void on_exchange(std::function<void()> fetch) { fetch_ = std::move(fetch); }

 private:
  void deliver(std::size_t least);
  void measure(bool worked);

  Postbox& postbox_;
  int device_;
  OpenOrder order_;
  RankGroups groups_;
  ImageStore store_;
  std::unique_ptr<CommittedImage> image_;
  std::unique_ptr<RankWorker> worker_;
  std::function<void()> fetch_;
  PeCounters counters_;  ///< of what is gone, and of parcels
  int rounds_ = 0;       ///< of work since everything was delivered
  std::uint64_t busy_since_ = 0;
  std::uint64_t idle_since_ = 0;
  Result<void> health_;
};

}  // namespace gridrt
