// The whole device against a USB host: LUNA, the firmware on the soft core, shell and engine, all
// at high speed through real packets. The software PEs say what the answers are.
#include <algorithm>
#include <array>
#include <memory>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "hal/loopback.hpp"
#include "host/driver/flash_image.hpp"
#include "host/driver/session.hpp"
#include "host/pe/software_device.hpp"
#include "tests/rtl/board_image.hpp"
#include "tests/rtl/usb_device_bench.hpp"
#include "tests/unit/image_support.hpp"

namespace gridrt::rtl {
namespace {

using protocol::BoardCommand;
using protocol::DeviceState;
using protocol::JournalCode;
using protocol::SelfTestState;

const Image& image() {
  static const Image made = board_image({5, 4, 5}, 60, 3, 0.5F);
  return made;
}

/// What a host sends and what a device answers.
struct Dialogue {
  std::vector<std::byte> to_device;
  Bytes to_host;
};
/// To load the image, and to trace rays.
struct Words {
  Dialogue load;
  Dialogue trace;
};

/// Writes down what passes.
class Recorder final : public Transport {
 public:
  Recorder(std::unique_ptr<Transport> link, Dialogue& heard)
      : link_(std::move(link)), heard_(heard) {}
  Result<void> send(std::span<const std::byte> bytes) override {
    heard_.to_device.insert(heard_.to_device.end(), bytes.begin(), bytes.end());
    return link_->send(bytes);
  }
  Result<std::size_t> receive(std::span<std::byte> out,
                              std::chrono::milliseconds timeout) override {
    auto got = link_->receive(out, timeout);
    for (std::size_t i = 0; i < got.value_or(0); ++i) {
      heard_.to_host.push_back(std::to_integer<std::uint8_t>(out[i]));
    }
    return got;
  }
  Result<void> get_feature(std::uint8_t id, std::span<std::byte> body) override {
    return link_->get_feature(id, body);
  }
  Result<void> set_feature(std::uint8_t id, std::span<const std::byte> body) override {
    return link_->set_feature(id, body);
  }

 private:
  std::unique_ptr<Transport> link_;
  Dialogue& heard_;
};

/// What `seq` says to a session of 1,200 rays, as a board with these capabilities.
Words seq_words(const protocol::CapabilitiesReport& capabilities) {
  Words words;
  Dialogue heard;
  SoftwareDeviceOptions software;
  software.capabilities = capabilities;
  auto link =
      std::make_unique<LoopbackTransport>(std::make_unique<SoftwareDevice>(std::move(software)));
  auto session =
      Session::open(std::make_unique<Recorder>(std::move(link), heard), {.name = "seq-board"});
  if (!session || !(*session)->load(image())) {
    ADD_FAILURE() << "no session with seq";
    return words;
  }
  words.load = std::exchange(heard, {});
  std::mt19937 random(5);
  std::vector<Segment> rays(600);
  for (Segment& s : rays) {
    for (int a = 0; a < 3; ++a) {
      const auto box = static_cast<unsigned>(image().header.max_q[static_cast<std::size_t>(a)]) + 3;
      s.p0[a] = static_cast<int>(random() % box);
      s.p1[a] = static_cast<int>(random() % box);
    }
    s.t1 = 1.0;
  }
  std::vector<Hit> hits(rays.size());
  for (const Query query : {Query::kClosestHit, Query::kAnyHit}) {
    EXPECT_TRUE((*session)->trace(rays, query, hits));
    EXPECT_GT(std::ranges::count_if(hits, [](const Hit& hit) { return hit.id >= 0; }), 100);
  }
  words.trace = std::move(heard);
  return words;
}

void expect_answers(DeviceBench& bench, const Dialogue& words) {
  EXPECT_EQ(bench.host.exchange(words.to_device, words.to_host.size()), words.to_host);
}

/// The same words with the device must get the same answers.
void expect_the_words(DeviceBench& bench) {
  const auto words = seq_words(bench.host.report<protocol::CapabilitiesReport>());
  expect_answers(bench, words.load);
  expect_answers(bench, words.trace);
}

DeviceState state(DeviceBench& bench) {
  return static_cast<DeviceState>(bench.host.report<protocol::StatusReport>().state);
}

/// The next event that the device sends by itself, of one kind.
bool hears_event(DeviceBench& bench, JournalCode code) {
  Bytes report;
  for (int i = 0; i < 8 && bench.host.read(2, report, 3000) == Outcome::kDone; ++i) {
    if (report.size() == 64 && report[0] == protocol::EventReport::kId &&
        report[1] == static_cast<std::uint8_t>(code)) {
      return true;
    }
  }
  return false;
}

TEST(UsbDevice, EnumeratesAtHighSpeedAndServesReportsBothWays) {
  DeviceBench bench;
  ASSERT_TRUE(bench.host.enumerate());
  EXPECT_EQ(bench.pins().speed_o, 0);
  expect_descriptors(bench.host, "SIM0");
  const auto identity = bench.host.report<protocol::IdentityReport>();
  EXPECT_EQ(identity.protocol_version, protocol::kVersion);
  EXPECT_STREQ(reinterpret_cast<const char*>(identity.serial.data()), "SIM0");
  const auto c = bench.host.report<protocol::CapabilitiesReport>();
  EXPECT_EQ(c.pes, GRIDRT_RTL_PES);
  EXPECT_EQ(c.max_bits, GRIDRT_RTL_B);
  EXPECT_EQ(state(bench), DeviceState::kEmpty);
  EXPECT_GT(bench.host.naks, 0);  // firmware takes its time
  EXPECT_TRUE(hears_event(bench, JournalCode::kStarted));

  // A self-test asked for with an output report; its end comes as an input report.
  EXPECT_EQ(bench.host.self_test(), SelfTestState::kNever);
  Bytes command(64);
  command[0] = protocol::CommandReport::kId;
  command[1] = static_cast<std::uint8_t>(BoardCommand::kSelfTest);
  ASSERT_EQ(bench.host.write(2, command), Outcome::kDone);
  EXPECT_TRUE(hears_event(bench, JournalCode::kSelfTestPassed));
  EXPECT_EQ(bench.host.self_test(), SelfTestState::kPassed);

  Bytes report;
  EXPECT_EQ(bench.host.get_report(200, report), Outcome::kStall);
  EXPECT_EQ(bench.host.set_report({protocol::ResetReport::kId, 1, 2, 3, 4}), Outcome::kStall);
  EXPECT_EQ(bench.host.set_report({protocol::ResetReport::kId, 'R', 'E', 'S', 'T'}),
            Outcome::kDone);
  EXPECT_EQ(state(bench), DeviceState::kEmpty);
}

TEST(UsbDevice, ImageRaysAndHitsAreTheBytesOfSeq) {
  DeviceBench bench;
  ASSERT_TRUE(bench.host.enumerate());
  const auto words = seq_words(bench.host.report<protocol::CapabilitiesReport>());
  expect_answers(bench, words.load);
  EXPECT_EQ(state(bench), DeviceState::kReady);
  bench.link() = {};
  bench.host.naks = 0;
  expect_answers(bench, words.trace);
  const LinkClocks link = bench.link();
  EXPECT_GT(bench.host.naks, 0);
  EXPECT_EQ(static_cast<std::size_t>(link.hears), words.trace.to_device.size());
  EXPECT_EQ(static_cast<std::size_t>(link.speaks), words.trace.to_host.size());

  // How much of the time the link takes.
  const auto counters = bench.host.report<protocol::CountersReport>();
  EXPECT_EQ(counters.rays, 1200U);
  fmt::print(
      "{} rays, {} bytes to the board, {} from it in {} clocks; rays were in the engine for {}, it "
      "was idle for {}; the board waited for USB for {}, USB took no answer for {}\n",
      counters.rays, link.hears, link.speaks, link.all, counters.cycles,
      link.all - static_cast<long>(counters.cycles), link.waits, link.blocked);
  RecordProperty("clocks", static_cast<int>(link.all));
  RecordProperty("waits", static_cast<int>(link.waits));
}

TEST(UsbDevice, LostAndSpoiltPacketsChangeNothing) {
  DeviceBench bench;
  ASSERT_TRUE(bench.host.enumerate());
  bench.host.faults = {.lose_ours = 6, .spoil_ours = 6, .lose_theirs = 6};
  expect_the_words(bench);
  EXPECT_EQ(bench.host.report<protocol::CountersReport>().rays, 1200U);
  ASSERT_EQ(bench.host.command(BoardCommand::kSelfTest), Outcome::kDone);
  EXPECT_EQ(bench.host.self_test(), SelfTestState::kPassed);
  expect_the_words(bench);
  EXPECT_GT(bench.host.retries, 50);
}

TEST(UsbDevice, SuspendResumeAndResetInFlight) {
  DeviceBench bench;
  ASSERT_TRUE(bench.host.enumerate());
  expect_suspend_and_resume(bench.host, [&] { return bench.pins().suspended_o != 0; });
  expect_the_words(bench);

  // A reset of the bus with rays in the engine, a frame half sent and answers not read; the image
  // is still there, and after a Reset none.
  const auto words = seq_words(bench.host.report<protocol::CapabilitiesReport>());
  const auto& to_device = words.trace.to_device;
  bench.host.exchange(std::span(to_device).first(to_device.size() - 700), 0);
  ASSERT_TRUE(bench.host.enumerate());
  EXPECT_EQ(state(bench), DeviceState::kReady);
  ASSERT_EQ(bench.host.set_report({protocol::ResetReport::kId, 'R', 'E', 'S', 'T'}),
            Outcome::kDone);
  EXPECT_EQ(state(bench), DeviceState::kEmpty);
  expect_the_words(bench);
}

TEST(UsbDevice, ReportsThatMeetAreBothWhole) {
  DeviceBench bench;
  ASSERT_TRUE(bench.host.enumerate());
  Bytes nothing(64);
  nothing[0] = protocol::CommandReport::kId;
  nothing[1] = 77;
  for (int delay = 0; delay < 2000; delay += 90) {
    // Firmware reads an output report when a feature report comes: it is NAKed and comes again.
    ASSERT_EQ(bench.host.write(2, nothing), Outcome::kDone);
    bench.host.idle(delay);
    const int naks = bench.host.naks;
    EXPECT_EQ(bench.host.set_report({protocol::ResetReport::kId, 'R', 'E', 'S', 'T'}),
              Outcome::kDone)
        << delay << ", NAKs: " << bench.host.naks - naks;
  }
}

TEST(UsbDevice, ARequestGivenUpDoesNotAnswerTheNext) {
  DeviceBench bench;
  ASSERT_TRUE(bench.host.enumerate());
  const auto identity = bench.host.report<protocol::IdentityReport>();
  const auto capabilities = bench.host.report<protocol::CapabilitiesReport>();
  for (int delay = 0; delay < 3000; delay += 30) {
    bench.host.give_up({0xA1, 1, 0x300 | protocol::IdentityReport::kId, usb::kHidInterface, 64});
    bench.host.idle(delay);
    EXPECT_EQ(bench.host.report<protocol::CapabilitiesReport>(), capabilities) << delay;
    bench.host.give_up({0x21, 9, 0x300 | protocol::ResetReport::kId, usb::kHidInterface, 64});
    bench.host.idle(delay);
    EXPECT_EQ(bench.host.report<protocol::IdentityReport>(), identity) << delay;
  }
}

TEST(UsbDevice, AnImageInFlashNeedsNoUpload) {
  protocol::CapabilitiesReport capabilities;
  {
    DeviceBench bench;
    ASSERT_TRUE(bench.host.enumerate());
    capabilities = bench.host.report<protocol::CapabilitiesReport>();
  }
  const auto flash = flash_image(image(), capabilities);
  ASSERT_TRUE(flash) << flash.error().message;
  DeviceBench bench(*flash);
  ASSERT_TRUE(bench.host.enumerate());
  EXPECT_EQ(state(bench), DeviceState::kReady);
  EXPECT_EQ(bench.host.report<protocol::BootReport>().resident, 1U);
}

}  // namespace
}  // namespace gridrt::rtl
