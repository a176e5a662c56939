// The schedules pes and paper on threads: the answers of rays, interrupts that spare work and
// feedback without which answers are wrong.
#include <bit>
#include <span>
#include <string>

#include <gtest/gtest.h>

#include "host/driver/device.hpp"
#include "tests/unit/pe_fixture.hpp"

namespace gridrt {
namespace {

struct Answers {
  std::vector<Hit> hits;
  DeviceCounters counters;
};

Answers answers(const Image& image, std::span<const Segment> segments, DeviceOptions options,
                Query query = Query::kClosestHit) {
  Answers out;
  out.hits.resize(segments.size());
  auto device = open_device(options);
  EXPECT_TRUE(device) << device.error().message;
  if (!device) return out;
  EXPECT_TRUE((*device)->load(image));
  const auto done = (*device)->trace(segments, query, out.hits);
  EXPECT_TRUE(done) << done.error().message;
  out.counters = (*device)->counters().value();
  return out;
}

DeviceOptions options(const char* name, const char* schedule, int threads = 0) {
  DeviceOptions out;
  out.name = name;
  out.schedule = schedule;
  out.threads = threads;
  return out;
}

std::size_t differences(std::span<const Hit> a, std::span<const Hit> b) {
  const auto bits = [](double x) { return std::bit_cast<std::uint64_t>(x); };
  std::size_t n = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    n += a[i].id != b[i].id || bits(a[i].t) != bits(b[i].t) ? 1 : 0;
  }
  return n;
}

TEST(Schedules, AnswerLikeRaysWithAnyNumberOfThreadsAndPes) {
  for (const int pes : {1, 3, 8}) {
    ImageOptions cut;
    cut.pes = pes;
    const Image image = fixture::make_image("builtin:teapot", cut);
    const auto segments = fixture::random_segments(image, 4000, 7);
    // A parallel section a ray is slow where threads outnumber the processors.
    const auto fewer = std::span(segments).first(200);
    for (const Query query : {Query::kClosestHit, Query::kAnyHit}) {
      const Answers of_all = answers(image, segments, options("seq", "rays"), query);
      const Answers of_fewer = answers(image, fewer, options("seq", "rays"), query);
      for (const std::string schedule : {"rays", "pes", "paper"}) {
        const bool paper = schedule == "paper";
        const Answers& expected = paper ? of_fewer : of_all;
        for (const int threads : {1, 2, 5}) {
          const Answers got = answers(image, paper ? fewer : std::span(segments),
                                      options("omp", schedule.c_str(), threads), query);
          EXPECT_EQ(differences(got.hits, expected.hits), 0U)
              << schedule << ", " << threads << " threads, " << pes << " PEs";
          EXPECT_EQ(got.counters.rays, expected.counters.rays);
        }
      }
    }
  }
}

TEST(Schedules, WithoutInterruptTheEighteenTeapotsTakeHalfAsManyTestsAgain) {
  const Image image = fixture::make_image("builtin:teapots");
  const auto segments = fixture::random_segments(image, 20000, 11);
  for (const int threads : {1, 2, 4}) {
    DeviceOptions with = options("omp", "pes", threads);
    DeviceOptions without = with;
    without.pes_interrupt = false;
    const Answers fewer = answers(image, segments, with);
    const Answers more = answers(image, segments, without);
    EXPECT_EQ(differences(fewer.hits, more.hits), 0U);  // interrupts spare work and nothing else
    EXPECT_GE(2 * more.counters.tests, 3 * fewer.counters.tests) << threads << " threads";
    EXPECT_GT(fewer.counters.interrupts, 0U);
    EXPECT_EQ(more.counters.interrupts, 0U);
    EXPECT_EQ(more.counters.ahead.interrupts_sent, 0U);
    if (threads > 1) {
      EXPECT_GT(fewer.counters.ahead.interrupts_sent, 0U);
    }
  }
}

TEST(Schedules, WithoutFeedbackAnswersAreWrong) {
  const Image image = fixture::make_image("builtin:teapots");
  const auto segments = fixture::random_segments(image, 20000, 13);
  const Answers expected = answers(image, segments, options("seq", "rays"));
  for (const int threads : {1, 2, 4}) {
    DeviceOptions without = options("omp", "pes", threads);
    without.pes_feedback = false;
    const Answers got = answers(image, segments, without);
    EXPECT_GT(differences(got.hits, expected.hits), 0U) << threads << " threads";
    const Answers with = answers(image, segments, options("omp", "pes", threads));
    EXPECT_EQ(differences(with.hits, expected.hits), 0U) << threads << " threads";
    if (threads > 1) {
      EXPECT_GT(with.counters.feedback_waits, 0U);
      EXPECT_GT(with.counters.ahead.feedbacks_sent, 0U);
    }
  }
}

TEST(Schedules, PaperHasABarrierForEachRayAndAbortsLateVoxels) {
  ImageOptions cut;
  cut.pes = 8;
  cut.grid = glm::ivec3{2};
  const Image image = fixture::make_image("builtin:teapots", cut);
  auto segments = fixture::random_segments(image, 300, 17);
  const Answers got = answers(image, segments, options("omp", "paper", 1));
  const Answers expected = answers(image, segments, options("seq", "rays"));
  EXPECT_EQ(differences(got.hits, expected.hits), 0U);
  EXPECT_EQ(got.counters.exchange.barriers, got.counters.rays);
  EXPECT_GT(got.counters.interrupts, 0U);
  EXPECT_GT(got.counters.exchange.worker_ns, got.counters.exchange.barrier_ns);
}

TEST(Schedules, AreRefusedWhereTheyMakeNoSense) {
  EXPECT_EQ(open_device(options("seq", "pes")).error().kind, ErrorKind::kUsage);
  EXPECT_EQ(open_device(options("omp", "PES")).error().kind, ErrorKind::kUsage);
}

}  // namespace
}  // namespace gridrt
