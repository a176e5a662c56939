// The board with its firmware on the soft core, from its pins: reports, self-test, boot from flash,
// an engine that hangs.
#include <vector>

#include <gtest/gtest.h>

#include "tests/rtl/board_bench.hpp"

namespace gridrt {
namespace {

using protocol::BoardCommand;
using protocol::BootState;
using protocol::DeviceState;
using protocol::JournalCode;

void expect_the_reference(Device& device) {
  auto seq = open_device({.name = "seq-board"});
  ASSERT_TRUE(seq);
  ASSERT_TRUE((*seq)->load(image()));
  const auto expected = trace(**seq);
  const auto got = trace(device);
  int hits = 0;
  for (std::size_t i = 0; i < got.size(); ++i) {
    ASSERT_EQ(got[i].id, expected[i].id) << i;
    hits += got[i].id >= 0 ? 1 : 0;
  }
  EXPECT_GT(hits, 20);
}

TEST(BoardFirmware, ServesWhatTheShellAndTheBoardKnow) {
  Bench bench;
  const auto identity = bench.report<protocol::IdentityReport>();
  EXPECT_EQ(identity.protocol_version, protocol::kVersion);
  EXPECT_STREQ(reinterpret_cast<const char*>(identity.name.data()), "sim");
  EXPECT_STREQ(reinterpret_cast<const char*>(identity.serial.data()), "SIM0");
  const auto c = bench.report<protocol::CapabilitiesReport>();
  EXPECT_EQ(c.pes, GRIDRT_RTL_PES);
  EXPECT_EQ(c.max_bits, GRIDRT_RTL_B);
  EXPECT_EQ(bench.state(), DeviceState::kEmpty);
  EXPECT_EQ(bench.journal(), std::vector{JournalCode::kStarted});
  ReportBody body{};
  for (const int id : {0, 5, 12, 16, 17, 32, 33, 255}) {
    EXPECT_FALSE(bench.link().get_feature(static_cast<std::uint8_t>(id), body)) << id;
  }
  for (const int id : {0, 1, 3, 4, 6, 8, 9, 10, 11, 32}) {
    EXPECT_FALSE(bench.link().set_feature(static_cast<std::uint8_t>(id), body)) << id;
  }
  EXPECT_FALSE(set_report(bench.link(), protocol::ResetReport{.key = 3}));
  EXPECT_FALSE(set_report(bench.link(), protocol::ControlReport{.idle_clocks = 0}));
  ASSERT_TRUE(set_report(bench.link(), protocol::ControlReport{.idle_clocks = 777, .log = 1}));
  const auto control = bench.report<protocol::ControlReport>();
  EXPECT_EQ(control.idle_clocks, 777U);
  EXPECT_EQ(control.log, 1U);
  InputReport input;
  ASSERT_TRUE(bench.board().take_input(input));
  EXPECT_EQ(input.id, protocol::EventReport::kId);
  EXPECT_EQ(input.body[0], static_cast<std::byte>(JournalCode::kStarted));
}

TEST(BoardFirmware, AReportTakesSomeThousandClocks) {
  Bench bench;
  bench.report<protocol::StatusReport>();
  const std::uint64_t before = bench.board().clocks();
  bench.report<protocol::CountersReport>();
  EXPECT_LT(bench.board().clocks() - before, 4000U);
  RecordProperty("clocks", static_cast<int>(bench.board().clocks() - before));
}

TEST(BoardFirmware, TheSelfTestPassesAndLeavesNothing) {
  Bench bench;
  bench.state();
  const std::uint64_t before = bench.board().clocks();
  ASSERT_TRUE(bench.command(BoardCommand::kSelfTest));
  const auto result = bench.report<protocol::SelfTestReport>();
  RecordProperty("clocks", static_cast<int>(bench.board().clocks() - before));
  EXPECT_EQ(static_cast<protocol::SelfTestState>(result.state), protocol::SelfTestState::kPassed);
  EXPECT_EQ(result.runs, 1U);
  EXPECT_GT(result.total, 4 * result.rays);
  EXPECT_EQ(result.right, result.total);
  EXPECT_EQ(bench.state(), DeviceState::kEmpty);
  EXPECT_EQ(bench.journal(), (std::vector{JournalCode::kStarted, JournalCode::kSelfTestPassed}));
  const auto session = bench.open();
  ASSERT_TRUE(session->load(image()));
  expect_the_reference(*session);
}

TEST(BoardFirmware, AnImageInFlashAnswersRaysWithoutAnUpload) {
  Bench bench(flash());
  const auto boot = bench.report<protocol::BootReport>();
  EXPECT_EQ(static_cast<BootState>(boot.state), BootState::kBooted);
  EXPECT_EQ(boot.fingerprint, fingerprint(image()));
  EXPECT_EQ(boot.resident, 1U);
  RecordProperty("clocks", static_cast<int>(bench.board().clocks()));
  RecordProperty("bytes", static_cast<int>(boot.length));
  const auto session = bench.open();
  ASSERT_TRUE(session->load(image()));
  const auto counters = session->counters();
  ASSERT_TRUE(counters);
  EXPECT_EQ(counters->uploads, 0U);
  EXPECT_EQ(counters->bytes_out, 0U);
  expect_the_reference(*session);

  // Another image, the test's, or a Reset: it is not the one in flash any more.
  Image other = image();
  other.header.chunk = 0;
  other.header.margin += 1;
  auto loaded = session->load(other);
  EXPECT_EQ(session->counters()->uploads, loaded ? 1U : 0U);
  ASSERT_TRUE(session->load(image()));
  EXPECT_GE(session->counters()->uploads, 1U);
  expect_the_reference(*session);
}

TEST(BoardFirmware, ADamagedFlashIsRefusedByTheLoader) {
  auto damaged = flash();
  damaged[damaged.size() / 2] ^= std::byte{1};
  Bench bench(damaged);
  const auto boot = bench.report<protocol::BootReport>();
  EXPECT_EQ(static_cast<BootState>(boot.state), BootState::kFailed);
  EXPECT_EQ(static_cast<protocol::BootError>(boot.error), protocol::BootError::kRefused);
  EXPECT_NE(boot.refusal, 0);
  EXPECT_EQ(bench.state(), DeviceState::kEmpty);
  const auto session = bench.open();
  ASSERT_TRUE(session->load(image()));
  EXPECT_EQ(session->counters()->uploads, 1U);
  expect_the_reference(*session);
}

TEST(BoardFirmware, AHungEngineIsBroughtBackWithTheImageInFlash) {
  Bench bench(flash());
  ASSERT_EQ(bench.state(), DeviceState::kReady);
  ASSERT_TRUE(bench.link().send(trace_frame(kHangs)));
  ASSERT_EQ(bench.state(), DeviceState::kReady);
  bench.run(GRIDRT_RTL_HANG_CLOCKS - 5000);
  EXPECT_EQ(bench.journal(), (std::vector{JournalCode::kStarted, JournalCode::kBooted}));
  bench.run(GRIDRT_RTL_HANG_CLOCKS);
  EXPECT_EQ(bench.report<protocol::BootReport>().resident, 1U);
  EXPECT_EQ(bench.journal(), (std::vector{JournalCode::kEngineHung, JournalCode::kBooted}));
  const auto session = bench.open();
  ASSERT_TRUE(session->load(image()));
  EXPECT_EQ(session->counters()->uploads, 0U);
  expect_the_reference(*session);
}

TEST(BoardFirmware, TheHostsResetEndsAHangSooner) {
  Bench bench(flash());
  ASSERT_EQ(bench.state(), DeviceState::kReady);
  ASSERT_TRUE(bench.link().send(trace_frame(kHangs)));
  ASSERT_TRUE(set_report(bench.link(), protocol::ResetReport{.key = protocol::kResetKey}));
  EXPECT_EQ(bench.state(), DeviceState::kEmpty);
  EXPECT_EQ(bench.report<protocol::BootReport>().resident, 0U);
  const auto session = bench.open();
  ASSERT_TRUE(session->load(image()));
  expect_the_reference(*session);
}

TEST(BoardFirmware, AHostThatReadsNothingIsNoHang) {
  Bench bench(flash());
  ASSERT_EQ(bench.state(), DeviceState::kReady);
  for (int i = 0; i < 40; ++i) ASSERT_TRUE(bench.link().send(trace_frame(1)));
  // All of them are sent, but no answer is taken.
  std::vector<std::byte> frames;
  for (int i = 0; i < 40; ++i) {
    const auto frame = trace_frame(1);
    frames.insert(frames.end(), frame.begin(), frame.end());
  }
  bench.board().run(frames, {}, {.quiet = 3 * GRIDRT_RTL_HANG_CLOCKS, .gap = 1});
  ReportAccess access{.id = protocol::JournalReport::kId};
  bench.board().run({}, {}, {.quiet = 100'000, .gap = 1}, &access);
  ASSERT_TRUE(access.done && access.good);
  EXPECT_EQ(access.body[0], std::byte{2});  // started, booted
}

}  // namespace
}  // namespace gridrt
