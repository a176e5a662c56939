// The board with its firmware on the soft core, from its pins: reports, self-test, boot from flash,
// an engine that hangs.
#include <array>
#include <random>
#include <vector>

#include <Vgridrt_board.h>
#include <gtest/gtest.h>

#include "hal/frame.hpp"
#include "hal/sim/sim_transport.hpp"
#include "hal/sim/verilated_board.hpp"
#include "host/driver/flash_image.hpp"
#include "host/driver/session.hpp"
#include "host/image/image_file.hpp"
#include "tests/unit/image_support.hpp"

namespace gridrt {
namespace {

using protocol::BoardCommand;
using protocol::BootState;
using protocol::DeviceState;
using protocol::JournalCode;

constexpr std::uint32_t kHangs = 0xDEAD0;  ///< of GRIDRT_TEST_HANG in rtl/gridrt_core.sv

class Bench {
 public:
  explicit Bench(std::vector<std::byte> flash = {}) {
    auto board = std::make_unique<VerilatedBoard<Vgridrt_board>>();
    board->set_flash(std::move(flash));
    board->power_up();
    board_ = board.get();
    link_ = std::make_unique<SimTransport>(
        std::move(board), SimTransportOptions{.silent_clocks = 5000, .most_silences = 20});
  }

  SimTransport& link() { return *link_; }
  SimBoard& board() { return *board_; }

  template <class Report>
  Report report() {
    const auto got = get_report<Report>(*link_);
    EXPECT_TRUE(got) << got.error().message;
    return got.value_or(Report{});
  }
  bool command(BoardCommand what) {
    return set_report(*link_, protocol::CommandReport{.command = static_cast<std::uint8_t>(what)})
        .has_value();
  }
  DeviceState state() { return static_cast<DeviceState>(report<protocol::StatusReport>().state); }
  /// Codes of all that the journal holds.
  std::vector<JournalCode> journal() {
    std::vector<JournalCode> all;
    for (;;) {
      const auto part = report<protocol::JournalReport>();
      if (part.count == 0) return all;
      for (std::size_t i = 0; i < part.count; ++i) {
        all.push_back(static_cast<JournalCode>(part.codes[i]));
      }
    }
  }
  /// The link as a device that is open. The bench has no link of its own any more.
  std::unique_ptr<Session> open() {
    auto session = Session::open(std::move(link_), {.name = "sim"});
    EXPECT_TRUE(session) << session.error().message;
    return std::move(*session);
  }
  /// Lets so many clocks pass in silence, and reads what the board has to say before.
  void run(std::uint64_t clocks) {
    std::array<std::byte, 4096> read{};
    board_->run({}, read, {.quiet = clocks, .gap = clocks});
  }

 private:
  std::unique_ptr<SimTransport> link_;
  SimBoard* board_ = nullptr;
};

const Image& image() {
  static const Image made = [] {
    ImageOptions options;
    options.grid = glm::ivec3{5, 4, 5};
    options.bits = GRIDRT_RTL_B;
    options.pes = GRIDRT_RTL_PES;
    options.layout = protocol::Layout::kCompact;
    options.with_scene = false;
    auto built = build_image(random_scene(40, 3, 0.6F), options);
    EXPECT_TRUE(built) << built.error().message;
    return *built;
  }();
  return made;
}

protocol::CapabilitiesReport capabilities() {
  Bench bench;
  return bench.report<protocol::CapabilitiesReport>();
}

std::vector<std::byte> flash() {
  auto made = flash_image(image(), capabilities());
  EXPECT_TRUE(made) << made.error().message;
  return made.value_or(std::vector<std::byte>{});
}

std::vector<Segment> segments() {
  std::mt19937 random(5);
  std::vector<Segment> out(200);
  for (Segment& s : out) {
    for (int a = 0; a < 3; ++a) {
      const auto box = static_cast<unsigned>(image().header.max_q[static_cast<std::size_t>(a)]) + 3;
      s.p0[a] = static_cast<int>(random() % box);
      s.p1[a] = static_cast<int>(random() % box);
    }
    s.t1 = 1.0;
  }
  return out;
}

std::vector<Hit> trace(Device& device) {
  const auto rays = segments();
  std::vector<Hit> hits(rays.size());
  const auto done = device.trace(rays, Query::kClosestHit, hits);
  EXPECT_TRUE(done) << done.error().message;
  return hits;
}

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

std::vector<std::byte> trace_frame(std::uint32_t ignore) {
  std::vector<std::byte> frame;
  FrameBuilder builder(frame, protocol::FrameType::kTrace, protocol::Layout::kCompact, 99);
  std::array<std::byte, protocol::TraceHead::kBytes> head{};
  protocol::store(protocol::TraceHead{1, 1}, head);
  builder.append(head);
  std::array<std::byte, protocol::RayCompact::kBytes> ray{};
  protocol::pack(protocol::RayCompact{.p0 = {1, 1, 1}, .p1 = {9, 9, 9}, .ignore = ignore}, ray);
  builder.append(ray);
  EXPECT_TRUE(builder.finish());
  return frame;
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
