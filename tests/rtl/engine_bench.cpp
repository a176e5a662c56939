// The whole engine: same answers as seq on awkward scenes, whatever happens at its ports.
#include <unordered_map>

#include <gtest/gtest.h>

#include "host/driver/device.hpp"
#include "tests/contract/awkward.hpp"
#include "tests/rtl/engine_harness.hpp"

namespace gridrt::rtl {
namespace {

constexpr int kBits = GRIDRT_RTL_B;
constexpr int kPes = GRIDRT_RTL_PES;

/// A scene as a compact image, rays for it, and what seq answers.
struct Task {
  Image image;
  std::vector<protocol::RayCompact> rays;
  std::vector<std::uint32_t> global;  ///< ids by local id
  std::vector<std::int32_t> closest;  ///< global ids or -1
  std::vector<std::int32_t> any;      ///< 0 or -1
};

Task make_task(std::uint64_t seed, bool any_hit) {
  const Scene scene = contract::awkward_scene(seed);
  const std::vector<Segment> all = contract::awkward_segments(scene, kBits, seed + 1);
  ImageOptions options;
  options.bits = kBits;
  options.pes = kPes;
  options.layout = protocol::Layout::kCompact;
  options.with_scene = false;
  Task task;
  task.image = build_image(scene, options).value();
  task.global = decode_triangles(task.image).value().global_ids;
  std::unordered_map<std::uint32_t, std::uint32_t> local;
  for (std::uint32_t i = 0; i < task.global.size(); ++i) local[task.global[i]] = i;
  const std::vector<Hit> closest = contract::reference(scene, kBits, all, Query::kClosestHit);
  const std::vector<Hit> any = contract::reference(scene, kBits, all, Query::kAnyHit);
  for (std::size_t i = 0; i < all.size(); ++i) {
    const auto found = local.find(all[i].ignore);
    task.rays.push_back(
        engine_ray(all[i], found == local.end() ? ~std::uint32_t{0} : found->second, any_hit));
    task.closest.push_back(closest[i].id);
    task.any.push_back(any[i].id);
  }
  return task;
}

/// Checks every answer.
void expect_answers(const Task& task, const EngineAnswers& got, bool any_hit) {
  ASSERT_EQ(got.hits.size(), task.rays.size()) << "the engine hangs";
  for (std::size_t i = 0; i < task.rays.size(); ++i) {
    const protocol::HitCompact& hit = got.hits[i];
    const std::int32_t expected = any_hit ? task.any[i] : task.closest[i];
    ASSERT_EQ(hit.hit != 0, expected >= 0) << "ray " << i;
    if (expected < 0) {
      ASSERT_EQ(hit.id, protocol::kNoIdCompact) << "ray " << i;
    } else if (any_hit) {
      ASSERT_EQ(hit.id, 0U) << "ray " << i;
    } else {
      ASSERT_LT(hit.id, task.global.size()) << "ray " << i;
      ASSERT_EQ(task.global[hit.id], static_cast<std::uint32_t>(expected)) << "ray " << i;
    }
  }
  EXPECT_EQ(got.counts.rays, static_cast<long>(task.rays.size()));
  ASSERT_EQ(got.pes.size(), static_cast<std::size_t>(kPes));
  long tests = 0;
  for (const PeWork& pe : got.pes) {
    tests += pe.tests;
    EXPECT_GE(pe.clocks, pe.tests);  // a clock with a test is one with work
    EXPECT_LE(pe.clocks, got.clocks);
  }
  EXPECT_EQ(tests, got.counts.tests);
}

class Engine : public testing::TestWithParam<std::pair<int, int>> {};

TEST_P(Engine, AnswersAsSeqDoes) {
  const auto [offer, take] = GetParam();
  EngineHarness engine(offer + take);
  for (const bool any_hit : {false, true}) {
    const Task task = make_task(static_cast<std::uint64_t>(offer), any_hit);
    engine.load(task.image);
    EngineRun run;
    run.offer = offer;
    run.take = take;
    expect_answers(task, engine.trace(task.rays, run), any_hit);
    if (HasFatalFailure()) return;
  }
}

INSTANTIATE_TEST_SUITE_P(Stalls, Engine,
                         testing::Values(std::pair{100, 100}, std::pair{30, 100},
                                         std::pair{100, 30}, std::pair{50, 60}));

TEST(EngineState, OneImageAfterAnotherAndTheSameRaysTwice) {
  EngineHarness engine(7);
  const Task first = make_task(3, false);
  const Task second = make_task(4, false);
  for (const Task* task : {&first, &second, &first}) {
    engine.load(task->image);
    expect_answers(*task, engine.trace(task->rays), false);
    expect_answers(*task, engine.trace(task->rays), false);
    if (testing::Test::HasFatalFailure()) return;
  }
}

}  // namespace
}  // namespace gridrt::rtl
