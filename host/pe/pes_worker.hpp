// One PE of the schedule `pes`, whoever carries its messages (threads or MPI ranks).
//
// A ray's traversal list is the row of voxels with references that it meets, in order of entry;
// each belongs to one worker. The list is answered by a feedback that runs along it: "all voxels
// before this place have answered, this is the smallest key so far". The worker that holds the
// feedback answers its own voxels from there on and passes it to the owner of the next one. A hit
// commits when the feedback reaches a voxel whose entry lies behind it, or the end of the list.
//
// A worker that holds no feedback tests its voxels of other rays in advance. A hit, committed or
// in advance, interrupts the others: they leave out what lies behind it. Interrupts spare work
// and nothing else; a late or lost one changes no answer.
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <span>
#include <vector>

#include "host/pe/engine.hpp"
#include "host/pe/ray_batch.hpp"

namespace gridrt {

enum class PesKind : std::uint32_t {
  kFeedback,   ///< voxels before `place` have answered, smallest key so far
  kInterrupt,  ///< the ray has a hit with this key; place kSettledPlace: it is settled
  kSettled,    ///< to the collector: the ray's answer
  kDone,       ///< from the collector: every ray of the batch is settled
};

/// A place on a traversal list: 16 times the slab's number from the start, plus the voxel's
/// number within the slab.
inline constexpr std::uint32_t kSettledPlace = 0xFFFFFFFFU;

/// One message; many travel together.
struct PesRecord {
  PesKind kind = PesKind::kFeedback;
  std::uint32_t batch = 0;
  std::uint32_t ray = 0;
  std::uint32_t place = 0;
  HitKey key;
};

/// Who is who: worker w owns the PEs p of the image with p mod workers = w.
struct PesTeam {
  std::uint32_t worker = 0;
  std::uint32_t workers = 1;
  bool interrupt = true;
  bool feedback = true;
  std::uint32_t first_batch = 0;  ///< batches are numbered from here on
};

/// Worker 0 is the collector: it gets every answer. Used by one thread.
class PesWorker {
 public:
  struct Finished {
    std::uint32_t batch = 0;
    std::vector<BatchRay> rays;
    std::vector<HitKey> answers;  ///< id kNoTriangle: a miss
  };

  /// `engine` outlives the worker. Only the team's own PEs are looked at.
  PesWorker(const Engine& engine, const PesTeam& team);

  /// Every worker gets every batch, with numbers that ascend by one.
  void add_batch(std::uint32_t batch, std::vector<BatchRay> rays);

  void take(std::span<const PesRecord> records);

  /// Answers voxels for some rays whose feedback is here; false if there are none.
  bool work();

  /// Tests own voxels of some rays in advance; false if there is nothing left to test.
  bool work_ahead();

  /// Messages to worker `to`; whoever carries them empties it.
  std::vector<PesRecord>& outbox(std::size_t to) { return outboxes_[to]; }

  /// The collector's next batch that is settled, once.
  std::optional<Finished> take_finished();

  /// True while a batch is not done.
  [[nodiscard]] bool busy() const { return !batches_.empty(); }

  [[nodiscard]] PeCounters& counters() { return counters_; }

 private:
  struct RayState {
    HitKey known;             ///< smallest key that was found here in advance or told to us
    std::uint32_t ahead = 0;  ///< own voxels before this place have been tested in advance
    bool touched = false;     ///< nothing (more) to test in advance
  };
  struct Batch {
    std::vector<BatchRay> rays;
    std::vector<RayState> states;
    std::size_t next_home = 0;  ///< next ray whose feedback starts here
    std::size_t ahead_left = 0;
    std::vector<HitKey> answers;  ///< collector only, like the next two
    std::vector<std::uint8_t> settled;
    std::size_t open = 0;
  };
  struct Run {
    std::uint32_t batch_number;
    Batch& batch;
    std::uint32_t ray;
  };

  void take_one(const PesRecord& record);
  void follow(const Run& run, std::uint32_t place, HitKey best);
  void test_ahead(const Run& run);
  bool test_voxel(const Run& run, const VoxelVisit& visit, const Cell& cell, HitKey& best);
  void settle(const Run& run, const HitKey& answer, bool cancels);
  void collect(std::uint32_t number, Batch& batch, std::uint32_t ray, const HitKey& answer);
  void interrupt_others(const Run& run, std::uint32_t place, const HitKey& key);
  [[nodiscard]] bool cancels(const HitKey& best, const VoxelVisit& visit) const {
    return team_.interrupt && best.id != kNoTriangle && visit.enter.quotient() > best.quotient;
  }

  const Engine& engine_;
  PesTeam team_;
  std::uint32_t next_batch_;
  std::map<std::uint32_t, Batch> batches_;
  std::vector<PesRecord> feedbacks_;  ///< received, not yet followed
  std::vector<PesRecord> early_;      ///< of batches that are still on their way
  std::vector<std::vector<PesRecord>> outboxes_;
  std::deque<Finished> finished_;
  PeCounters counters_;
};

}  // namespace gridrt
