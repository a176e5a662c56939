// The report windows of gridrt_shell, Reset, and the event log.
#include <algorithm>

#include <gtest/gtest.h>

#include "tests/rtl/shell_bench.hpp"

namespace gridrt::rtl {
namespace {

using protocol::DeviceState;
using protocol::FrameType;
using protocol::Layout;

constexpr std::uint32_t kIdentity = 0x040;
constexpr std::uint32_t kCapabilities = 0x080;
constexpr std::uint32_t kCounters = 0x100;
constexpr std::uint32_t kReset = 0x140;
constexpr std::uint32_t kLog = 0x180;
constexpr std::uint32_t kControl = 0x1C0;
constexpr std::uint32_t kStalls = 0x200;

TEST(ShellReports, SayWhoAndWhatTheDeviceIs) {
  ShellBench bench;
  const auto identity = bench.report<protocol::IdentityReport>(kIdentity);
  EXPECT_EQ(identity.protocol_version, protocol::kVersion);
  EXPECT_STREQ(reinterpret_cast<const char*>(identity.name.data()), "sim");
  const auto c = bench.report<protocol::CapabilitiesReport>(kCapabilities);
  EXPECT_EQ(c.layouts, 1U << static_cast<unsigned>(Layout::kCompact));
  EXPECT_EQ(c.max_bits, GRIDRT_RTL_B);
  EXPECT_EQ(c.pes, GRIDRT_RTL_PES);
  EXPECT_EQ(c.max_payload, 16384U);
  EXPECT_EQ(c.clock_hz, 60'000'000U);
  EXPECT_EQ(c.max_blocks, static_cast<unsigned>(GRIDRT_RTL_BLOCKS));
  EXPECT_EQ(c.max_cells, static_cast<unsigned>(GRIDRT_RTL_CELLS));
  EXPECT_EQ(c.max_references, static_cast<unsigned>(GRIDRT_RTL_REFS));
  EXPECT_EQ(c.max_triangles, static_cast<unsigned>(GRIDRT_RTL_TRIS));
  EXPECT_EQ(c.max_vertices, static_cast<unsigned>(GRIDRT_RTL_VERTS));
  EXPECT_EQ(bench.status().state, static_cast<int>(DeviceState::kEmpty));
  // What is not there reads as 0 and takes what is written.
  for (const std::uint32_t address : {0x000U, 0x03CU, 0x0A0U, 0x240U, 0xFFCU}) {
    bench.write(address, 0xFFFFFFFFU);
    EXPECT_EQ(bench.read(address), 0U) << address;
  }
}

TEST(ShellReports, CountersAreSums) {
  ShellBench bench;
  std::mt19937 source(3);
  const auto random = [&] {
    return (std::uint64_t{source()} << 32U | source()) & ((std::uint64_t{1} << 33U) - 1);
  };
  protocol::CountersReport counters;
  protocol::StallsReport stalls;
  for (int i = 0; i < 5000; ++i) {
    const std::uint64_t c = random();
    bench.counts = c;
    bench.tick();
    const auto field = [&](unsigned at, unsigned width) {
      return static_cast<std::uint32_t>(c >> at) & ((1U << width) - 1U);
    };
    const bool flying = field(15, 1) != 0;
    counters.rays += field(32, 1);
    counters.steps += field(29, 3);
    counters.tests += field(26, 3);
    counters.masked += field(20, 6);
    counters.interrupts += field(17, 3);
    counters.feedback_waits += field(16, 1);
    counters.cycles += flying ? 1 : 0;
    if (!flying) continue;
    stalls.no_ray += field(14, 1);
    stalls.no_slot += field(13, 1);
    stalls.traversal_idle += field(10, 3);
    stalls.queue_full += field(7, 3);
    stalls.pe_idle += field(4, 3);
    stalls.divider_busy += field(1, 3);
    stalls.hit_waits += field(0, 1);
  }
  bench.counts = 0;
  EXPECT_EQ(bench.report<protocol::CountersReport>(kCounters), counters);
  EXPECT_EQ(bench.report<protocol::StallsReport>(kStalls), stalls);
  bench.reset_report();
  EXPECT_EQ(bench.report<protocol::CountersReport>(kCounters), protocol::CountersReport{});
  EXPECT_EQ(bench.report<protocol::StallsReport>(kStalls), protocol::StallsReport{});
}

// A Reset at any time: within a frame of either direction, with rays in the engine.
TEST(ShellReports, ResetDropsWhatIsUnderWay) {
  const Image image = small_image(12, GRIDRT_RTL_PES);
  std::mt19937 source(4);
  const auto random = [&] {
    return (std::uint64_t{source()} << 32U | source()) & ((std::uint64_t{1} << 33U) - 1);
  };
  ShellBench bench;
  const auto rays = rays_in(image, 60, 2);
  std::uint32_t sequence = 1;
  for (int round = 0; round < 60; ++round) {
    bench.pace = {};
    sequence = send_image(bench, image, sequence + 1);
    if (round % 4 == 3) {
      bench.run(static_cast<int>(random() % bench.to_device.size()));  // within the image
    } else {
      bench.run_until_quiet();
      ASSERT_EQ(take_answers(bench).back().type(), FrameType::kNoOp);
      bench.pace = {.rx = 80, .tx = 30, .ray = 50, .hit = 20, .latency = 300};
      for (int i = 0; i < 3; ++i) {
        bench.send(FrameType::kTrace, ++sequence, trace_payload(rays, 9), Layout::kCompact);
        bench.send(FrameType::kCommit, ++sequence, commit_payload(0));
      }
      bench.run(static_cast<int>(random() % 6000));
    }
    bench.write(kReset, 12345);  // without the key: nothing
    bench.reset_report();
    const auto status = bench.status();
    EXPECT_EQ(status.state, static_cast<int>(DeviceState::kEmpty));
    EXPECT_EQ(status.last_error, 0);
    EXPECT_EQ(status.error_detail, 0U);
    // What the host still had to send of that frame is garbage by now.
    const std::size_t rest = std::min<std::size_t>(bench.to_device.size(), random() % 3000);
    bench.to_device.erase(bench.to_device.begin(),
                          bench.to_device.end() - static_cast<std::ptrdiff_t>(rest));
    bench.write(kControl, 500);
    bench.run_until_quiet(2000);
    bench.from_device.clear();
    bench.send(FrameType::kTrace, ++sequence, trace_payload(rays, 1), Layout::kCompact);
    bench.run_until_quiet();
    const auto answers = take_answers(bench);
    ASSERT_EQ(answers.size(), 1U);
    EXPECT_EQ(answers[0].code(), protocol::ErrorCode::kNotReady);
  }
}

/// All words of the log.
std::vector<std::uint32_t> read_log(ShellBench& bench, bool& overflow) {
  std::vector<std::uint32_t> words;
  overflow = false;
  for (;;) {
    const auto report = bench.report<protocol::LogReport>(kLog);
    EXPECT_LE(report.count, 14);
    overflow = overflow || report.overflow != 0;
    for (std::size_t i = 0; i < report.words.size(); ++i) {
      if (i < report.count) {
        words.push_back(report.words[i]);
      } else {
        EXPECT_EQ(report.words[i], 0U);
      }
    }
    if (report.count == 0) return words;
  }
}

/// Sets bits [at, at + width) of the tap.
void put(ShellBench& bench, unsigned at, unsigned width, std::uint64_t value) {
  for (unsigned i = 0; i < width; ++i) {
    const std::uint32_t bit = 1U << ((at + i) % 32);
    std::uint32_t& word = bench.tap[(at + i) / 32];
    word = (value >> i & 1U) != 0 ? word | bit : word & ~bit;
  }
}

TEST(ShellReports, TheLogTellsWhatTheTapTold) {
  ShellBench bench;
  bool overflow = false;
  put(bench, 21, 1, 1);  // a commit while the log is off
  bench.tick();
  bench.tap = {};
  bench.write(kControl + 4, 1);
  EXPECT_EQ(bench.read(kControl + 4), 1U);
  EXPECT_TRUE(read_log(bench, overflow).empty());
  // A step, a task and a test of PE 2 in one clock, then a hit, an interrupt and the commit.
  put(bench, 233, 1, 1);
  put(bench, 221, 12, 0xABC);  // block
  put(bench, 213, 8, 0x81);    // voxels
  put(bench, 205, 8, 7);       // jump
  put(bench, 204, 1, 1);
  put(bench, 202, 2, 3);         // PE
  put(bench, 188, 14, 0x2345);   // first
  put(bench, 178, 10, 0x155);    // count
  put(bench, 170, 8, 0xAA);      // octants
  put(bench, 152, 18, 0x31234);  // entry
  put(bench, 149, 1, 1);         // test_valid of PE 2
  put(bench, 99 + 24, 12, 0x777);
  put(bench, 95 + 2, 1, 1);
  bench.tick();
  bench.tap = {};
  put(bench, 151, 1, 1);  // expand_drop
  put(bench, 91, 4, 0b1010);
  put(bench, 87, 4, 0b1000);
  bench.tick();
  bench.tap = {};
  put(bench, 86, 1, 1);
  put(bench, 61, 25, 0x1000000);
  put(bench, 41, 20, 0x54321);
  put(bench, 40, 1, 1);
  put(bench, 22, 18, 0x20001);
  put(bench, 21, 1, 1);
  put(bench, 20, 1, 1);
  put(bench, 0, 20, 0x54321);
  bench.tick();
  bench.tap = {};
  bench.run(20);
  const std::vector<std::uint32_t> expected{0x1'07'81'ABC,
                                            0x20000000U | 0x155U << 16U | 0x2345U << 2U | 3U,
                                            0x30000000U | 0x31234U << 8U | 0xAAU,
                                            0x40000000U | 1U << 14U | 0x777U << 2U | 2U,
                                            0x50000000U | 1U,
                                            0x50000000U | 4U | 3U,
                                            0x60000000U,
                                            0x70000000U | 0x1000000U,
                                            0x80000000U | 0x54321U,
                                            0x90000000U | 0x20001U,
                                            0xA0000000U | 1U << 20U | 0x54321U};
  auto words = read_log(bench, overflow);
  std::ranges::sort(words.begin() + 3, words.begin() + 7);  // in any order
  EXPECT_EQ(words, expected);
  EXPECT_FALSE(overflow);
  // More than fits: what is there is in order, and the loss is told.
  put(bench, 233, 1, 1);
  for (unsigned i = 0; i < 600; ++i) {
    put(bench, 221, 12, i);
    bench.tick();
  }
  bench.tap = {};
  bench.run(20);
  words = read_log(bench, overflow);
  EXPECT_TRUE(overflow);
  ASSERT_GE(words.size(), 512U);
  for (unsigned i = 0; i < 512; ++i) EXPECT_EQ(words[i], 0x10000000U + i);
  // Off: no more; on again: empty, nothing lost.
  bench.write(kControl + 4, 0);
  EXPECT_EQ(bench.read(kControl + 4), 0U);
  bench.write(kControl + 4, 1);
  EXPECT_TRUE(read_log(bench, overflow).empty());
  EXPECT_FALSE(overflow);
}

}  // namespace
}  // namespace gridrt::rtl
