// gridrt_pe with random images, rays, tasks, interrupts and pauses: each task ends once, with all
// of its hits unless it may be cancelled, and a test starts in nearly every clock with work.
#include <iostream>

#include "tests/rtl/pe_driver.hpp"

namespace gridrt::rtl {
namespace {

constexpr std::int64_t kWhole = (std::int64_t{1} << kPeBits) - 1;

using Pe = PeDriver;

// Without interrupts nothing may be left out: not a test, not a hit.
TEST_F(Pe, MakesEveryTestWithoutInterrupts) {
  for (const std::int64_t size : {std::int64_t{5}, std::int64_t{60}, kWhole}) {
    load(size, 5);
    run({.offer = 60, .take = 80}, 12'000);
    drain({});
    if (HasFatalFailure()) return;
    ASSERT_EQ(skipped_tests, 0);
    ASSERT_EQ(counts().tests, expected_tests);
    ASSERT_EQ(counts().masked, expected_masked);
    ASSERT_EQ(counts().cancelled, 0);
    ASSERT_EQ(counts().lasts + counts().drops, counts().tasks);
  }
  EXPECT_GT(counts().tasks, 3000);
  EXPECT_GT(counts().hits, 500);
  EXPECT_GT(counts().drops, 100) << "these masks leave something of every task";
}

TEST_F(Pe, EndsEveryTaskOnceUnderInterruptsAndPauses) {
  for (const int take : {100, 50, 8}) {
    for (const int interrupts : {20, 200, 1000}) {
      load(take == 50 ? 6 : 200, 5);
      const PeTraffic traffic{.offer = 90, .take = take, .interrupts = interrupts};
      run(traffic, 4000);
      drain(traffic);
      if (HasFatalFailure()) return;
    }
  }
  EXPECT_GT(counts().tasks, 3000);
  if (kCancels) {
    EXPECT_GT(counts().cancelled, 300);
  } else {
    EXPECT_EQ(counts().cancelled, 0);
    EXPECT_EQ(counts().tests, expected_tests);
  }
}

// Limits come from the PE's own hits, long tasks are cut short.
TEST_F(Pe, LivesWithItsOwnInterrupts) {
  load(kWhole, 3);
  const PeTraffic traffic{.offer = 100, .take = 90, .feedback = true, .list = 60, .near = 0};
  run(traffic, 30'000);
  drain(traffic);
  EXPECT_GT(counts().hits, 300);
}

// A reader that stops: the PE fills up to its bounds (its assertions watch them), loses nothing.
TEST_F(Pe, FillsUpAndRecovers) {
  load(40, 3);
  for (int round = 0; round < 20; ++round) {
    run({.offer = 100, .take = 0}, 1000);
    if (HasFatalFailure()) return;
    const long before = counts().tasks;
    run({.offer = 100, .take = 0}, 100);
    if (HasFatalFailure()) return;
    ASSERT_EQ(counts().tasks, before) << "a PE that is full takes tasks";
    // Waiting, in fetch (a task and rows), tests and their results, events in order.
    ASSERT_LE(pending(), 10 + 32 + 2 + 16);
    drain({});
    if (HasFatalFailure()) return;
  }
}

#ifndef GRIDRT_STALL
// A hit in ten tests is too much for one divider.
constexpr double kPace = GRIDRT_RTL_DIVIDERS >= 2 ? 0.9 : 0.6;

// The pace: tests for each clock in which there is work. Eight references are read in a clock, so a
// list of n takes (n + 7) / 8 clocks at the least if the mask leaves out most of it.
TEST_F(Pe, MakesATestAClock) {
  struct Load {
    const char* name;
    int list;
    unsigned sparse;
    int whole;
  };
  for (const Load& l : {Load{"lists of 1", 1, 0, 100}, Load{"lists of 1 to 3", 3, 0, 100},
                        Load{"lists of 1 to 12", 12, 0, 100},
                        Load{"lists of 1 to 12, a quarter masked", 12, 4, 100},
                        Load{"lists of 1 to 40, half of them masked", 40, 0, 0}}) {
    load(kWhole, l.sparse);
    const Counts before = counts();
    run({.list = l.list, .whole = l.whole}, 10'000);
    if (HasFatalFailure()) return;
    const auto clocks = static_cast<double>(counts().busy - before.busy);
    const auto tests = static_cast<double>(counts().tests - before.tests);
    const double pace = static_cast<double>(counts().work - before.work) / clocks;
    std::cout << l.name << ": " << tests / clocks << " tests and " << pace
              << " clocks' worth of tasks a clock with work, "
              << static_cast<double>(counts().hits - before.hits) / tests << " hits a test\n";
    if (l.whole == 100) {
      EXPECT_GE(tests / clocks, kPace) << l.name;
    }
    EXPECT_GE(pace, kPace) << l.name;
    drain({});
    if (HasFatalFailure()) return;
  }
}
#endif

}  // namespace
}  // namespace gridrt::rtl
