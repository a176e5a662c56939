// A hostile host at the whole device, through real USB packets: whatever it does, the device can be
// enumerated afterwards; an image that was loaded answers rightly still, or is not there; after a
// Reset the device is as new. Prints seeds that fail. GRIDRT_NOISE_SCHEDULES sets how many
// schedules (3), GRIDRT_NOISE_SEED the first.
#include <bit>
#include <cstdio>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "host/driver/session.hpp"
#include "tests/rtl/board_image.hpp"
#include "tests/rtl/environment.hpp"
#include "tests/rtl/hostile_usb.hpp"
#include "tests/rtl/usb_cable.hpp"
#include "tests/rtl/usb_device_bench.hpp"

namespace gridrt::rtl {
namespace {

using protocol::DeviceState;
using protocol::FrameType;

constexpr std::uint64_t kKinds = 3;            ///< of harm
constexpr std::uint32_t kIdleClocks = 60'000;  ///< an unfinished frame is given up
constexpr std::uint32_t kSequence = 0x5EED0000U;

const KnownImage& known() {
  static const KnownImage only = make_known(board_image({5, 4, 5}, 40, 3, 0.6F));
  return only;
}

struct Sum {
  UsbNoiseCounts noise;
  std::uint64_t kept = 0, lost = 0;
};

/// The state that the device tells of, which is that of its answer to known rays.
bool expect_known_or_none(UsbCable& link, UsbHarm harm) {
  const auto set = set_report(link, protocol::ControlReport{.idle_clocks = kIdleClocks, .log = 0});
  EXPECT_TRUE(set) << set.error().message;
  FrameReader reader;
  synchronise(link, reader, kSequence);
  const auto status = get_report<protocol::StatusReport>(link);
  EXPECT_TRUE(status);
  if (testing::Test::HasFailure()) return false;
  const bool ready = status->state == static_cast<std::uint8_t>(DeviceState::kReady);
  EXPECT_TRUE(ready || harm == UsbHarm::kAll) << "an image was lost to what loads nothing";
  const Reply reply = ask(link, reader, known_trace(kSequence + 100), kSequence + 100);
  EXPECT_TRUE(reply.came) << "known rays have no answer";
  EXPECT_EQ(reply.type, ready ? FrameType::kHits : FrameType::kError);
  if (ready) {
    EXPECT_EQ(reply.payload, known().hits) << "a wrong answer without a word";
  }
  return ready;
}

/// The driver resets the device, loads the image and traces.
void expect_as_new(UsbBoardHost& host) {
  auto owned = std::make_unique<UsbCable>(host);
  ASSERT_TRUE(set_report(*owned, protocol::ResetReport{.key = protocol::kResetKey}));
  FrameReader reader;
  synchronise(*owned, reader, kSequence + 200);
  auto session = Session::open(std::move(owned), {.name = "cable"});
  ASSERT_TRUE(session) << session.error().message;
  (*session)->connection().set_next_sequence(kSequence + 300);
  const auto loaded = (*session)->load(known().image);
  ASSERT_TRUE(loaded) << loaded.error().message;
  EXPECT_EQ((*session)->counters()->uploads, 1U);
  FrameReader answers;
  Transport& link = (*session)->connection().transport();
  const Reply reply = ask(link, answers, known_trace(kSequence + 900), kSequence + 900);
  EXPECT_EQ(reply.payload, known().hits);
}

void run(std::uint64_t seed, Sum& sum) {
  std::mt19937_64 random(seed * 7907 + 5);
  const auto harm = static_cast<UsbHarm>(seed % kKinds);
  DeviceBench bench;
  ASSERT_TRUE(bench.host.enumerate());
  {
    auto session = Session::open(std::make_unique<UsbCable>(bench.host), {.name = "cable"});
    ASSERT_TRUE(session) << session.error().message;
    const auto loaded = (*session)->load(known().image);
    ASSERT_TRUE(loaded) << loaded.error().message;
  }
  HostileUsb hostile(bench.host, random(), known(), harm, sum.noise);
  hostile.make_noise(100 + static_cast<int>(random() % 200));
  if (testing::Test::HasFailure()) return;
  ASSERT_TRUE(bench.host.enumerate()) << "the device does not answer the bus any more";
  UsbCable link(bench.host);
  (expect_known_or_none(link, harm) ? sum.kept : sum.lost) += 1;
  if (testing::Test::HasFailure()) return;
  expect_as_new(bench.host);
}

TEST(UsbNoise, AnImageIsRightOrNotThereAndTheDeviceIsAsNew) {
  const Seeds seeds(kKinds);
  Sum sum;
  seeds.run([&](std::uint64_t seed) { run(seed, sum); });
  const auto n = [](std::uint64_t x) { return static_cast<unsigned long long>(x); };
  const UsbNoiseCounts& c = sum.noise;
  std::printf(
      "seeds %llu to %llu: %llu wrong packets, %llu requests, %llu frames, %llu reports, %llu "
      "resets of the bus; %llu packets of the device; the image was kept %llu times, lost %llu\n",
      n(seeds.begin), n(seeds.begin + seeds.count - 1), n(c.packets), n(c.requests), n(c.frames),
      n(c.reports), n(c.resets), n(c.answered), n(sum.kept), n(sum.lost));
  EXPECT_GT(c.answered, 0U);
  if (seeds.count < kKinds) return;
  EXPECT_GT(sum.kept, 0U);
}

}  // namespace
}  // namespace gridrt::rtl
