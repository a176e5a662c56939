// Case 34: workers of the schedule pes that stall at random, with messages that overtake each
// other, give the same answers; none is lost and none is given to another ray.
#include <gtest/gtest.h>

#include "host/pe/pes_worker.hpp"
#include "tests/unit/pe_fixture.hpp"

namespace gridrt {
namespace {

Engine make_engine(const Image& image) {
  const auto bytes = [&](protocol::SectionKind kind, int pe = 0) {
    return std::span<const std::byte>(image.find(kind, pe)->bytes);
  };
  using enum protocol::SectionKind;
  std::vector<std::optional<Pe>> pes;
  for (std::uint8_t p = 0; p < image.header.pes; ++p) {
    pes.emplace_back(Pe::decode(image.header, p, bytes(kReferences, p), bytes(kTriangles, p),
                                bytes(kVertices, p))
                         .value());
  }
  auto memory = TraversalMemory::decode(image.header, bytes(kBlocks), bytes(kCells));
  return Engine::assemble(std::move(memory.value()), std::move(pes)).value();
}

/// Workers and links of one process, run in an order that a random number generator chooses.
class Race {
 public:
  Race(const Engine& engine, std::uint32_t workers, std::uint64_t seed)
      : random_(seed), stalled_(random_.below(static_cast<int>(workers))) {
    for (std::uint32_t w = 0; w < workers; ++w) {
      workers_.emplace_back(engine, PesTeam{w, workers, true, true, 5});
    }
    waiting_.resize(workers);
    late_.resize(workers);
  }

  /// Every batch reaches every worker, each at its own time.
  std::vector<std::vector<HitKey>> run(const std::vector<std::vector<BatchRay>>& batches) {
    std::vector<std::vector<HitKey>> answers(batches.size());
    std::size_t finished = 0;
    for (int turn = 0; finished < batches.size(); ++turn) {
      if (turn > 50000000) {
        ADD_FAILURE() << "the workers do not come to an end";
        break;
      }
      const auto w = static_cast<std::size_t>(random_.below(static_cast<int>(workers_.size())));
      if (static_cast<int>(w) == stalled_ && random_.below(50) > 0) continue;
      PesWorker& worker = workers_[w];
      switch (random_.below(4)) {
        case 0:
          if (late_[w] < batches.size()) {
            worker.add_batch(static_cast<std::uint32_t>(5 + late_[w]), batches[late_[w]]);
            ++late_[w];
          }
          break;
        case 1:
          deliver(w);
          break;
        case 2:
          worker.work();
          break;
        default:
          worker.work_ahead();
      }
      for (std::size_t to = 0; to < workers_.size(); ++to) {
        auto& box = worker.outbox(to);
        waiting_[to].insert(waiting_[to].end(), box.begin(), box.end());
        box.clear();
      }
      while (auto done = worker.take_finished()) {
        answers[done->batch - 5] = done->answers;
        ++finished;
      }
    }
    return answers;
  }

 private:
  /// One waiting message, any.
  void deliver(std::size_t to) {
    auto& box = waiting_[to];
    for (int n = random_.below(100); n > 0 && !box.empty(); --n) {
      const auto pick = static_cast<std::size_t>(random_.below(static_cast<int>(box.size())));
      std::swap(box[pick], box.back());
      workers_[to].take(std::span(&box.back(), 1));
      box.pop_back();
    }
  }

  fixture::Random random_;
  int stalled_;
  std::vector<PesWorker> workers_;
  std::vector<std::vector<PesRecord>> waiting_;
  std::vector<std::size_t> late_;
};

TEST(Case34, StallsAndOvertakingChangeNoAnswer) {
  ImageOptions cut;
  cut.pes = 8;
  const Image image = fixture::make_image("builtin:teapot", cut);
  const Engine engine = make_engine(image);
  std::vector<std::vector<BatchRay>> batches;
  std::vector<std::vector<HitKey>> expected;
  PeCounters counters;
  for (std::uint64_t b = 0; b < 4; ++b) {
    auto& rays = batches.emplace_back();
    auto& keys = expected.emplace_back();
    for (const Segment& s : fixture::random_segments(image, 300 + 7 * b, b)) {
      BatchRay r{{s.p0, s.p1, s.ignore}, b == 3};
      if (rays.size() == 20) r.ray.p1 = r.ray.p0;
      rays.push_back(r);
      if (r.ray.p0 == r.ray.p1) {
        keys.emplace_back();
      } else if (r.any_hit) {
        keys.push_back(engine.any_hit(r.ray, counters) ? HitKey{0, 0} : HitKey{});
      } else {
        keys.push_back(engine.closest_hit(r.ray, counters).value_or(HitKey{}));
      }
    }
  }
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    const auto workers = static_cast<std::uint32_t>(1 + seed % 8);
    const auto got = Race(engine, workers, seed).run(batches);
    for (std::size_t b = 0; b < batches.size(); ++b) {
      ASSERT_EQ(got[b].size(), expected[b].size());
      for (std::size_t i = 0; i < got[b].size(); ++i) {
        ASSERT_EQ(got[b][i], expected[b][i])
            << "seed " << seed << ", " << workers << " workers, batch " << b << ", ray " << i;
      }
    }
  }
}

}  // namespace
}  // namespace gridrt
