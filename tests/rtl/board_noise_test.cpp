// A hostile host at the whole board, with its firmware on the soft core: after the noise and the
// recovery that is documented, a known image and known rays have the right answers; what was loaded
// before has the right answers still, or the board says that it is not there. Prints seeds that
// fail. GRIDRT_NOISE_SCHEDULES sets how many schedules (12), GRIDRT_NOISE_SEED the first.
#include <array>
#include <bit>
#include <cstdio>
#include <memory>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "tests/rtl/board_bench.hpp"
#include "tests/rtl/environment.hpp"
#include "tests/rtl/hostile_board.hpp"

namespace gridrt::rtl {
namespace {

using protocol::DeviceState;
using protocol::FrameType;

constexpr std::uint64_t kMix = 12;           ///< seeds that go through all kinds of harm and start
constexpr std::uint32_t kIdleClocks = 2000;  ///< an unfinished frame is given up
constexpr std::uint32_t kSequence = 0x5EED0000U;  ///< and some behind it: of NoOps
constexpr std::uint32_t kTraceSequence = kSequence + 100;
constexpr std::uint32_t kSessionSequence = kSequence + 200;

const KnownImage& first() {
  static const KnownImage only = make_known(image());
  return only;
}

const KnownImage& second() {
  static const KnownImage only = make_known(board_image({4, 5, 3}, 30, 8, 0.7F));
  return only;
}

struct Sum {
  NoiseCounts noise;
  std::uint64_t kept = 0, replaced = 0, empty = 0, uploads = 0;
};

void expect_as_new(std::unique_ptr<SimTransport> link, bool resident, Sum& sum) {
  auto session = Session::open(std::move(link), {.name = "sim"});
  ASSERT_TRUE(session) << session.error().message;
  (*session)->connection().set_next_sequence(kSessionSequence);
  const auto loaded = (*session)->load(image());
  ASSERT_TRUE(loaded) << loaded.error().message;
  const std::uint64_t uploads = (*session)->counters()->uploads;
  EXPECT_EQ(uploads, resident ? 0U : 1U);
  sum.uploads += uploads;
  const auto bits = [](double x) { return std::bit_cast<std::uint64_t>(x); };
  const std::vector<Hit> hits = trace(**session);
  for (std::size_t i = 0; i < hits.size(); ++i) {
    const Hit& right = expected()[i];
    ASSERT_EQ(hits[i].id, right.id) << "ray " << i;
    ASSERT_EQ(bits(hits[i].t), bits(right.t)) << "ray " << i;
    ASSERT_EQ(bits(hits[i].u), bits(right.u)) << "ray " << i;
    ASSERT_EQ(bits(hits[i].v), bits(right.v)) << "ray " << i;
  }
}

/// How a schedule begins.
enum class Start { kEmpty, kFlash, kUploaded };

void run(std::uint64_t seed, Sum& sum) {
  std::mt19937_64 random(seed * 7907 + 5);
  const auto harm = static_cast<Harm>(seed % 4);
  const auto start = static_cast<Start>(seed / 4 % 3);
  const bool resets = random() % 2 == 0;
  static const std::vector<std::byte> content = flash();
  auto made = std::make_unique<VerilatedBoard<Vgridrt_board>>();
  if (start == Start::kFlash) made->set_flash(content);
  made->power_up();
  HostileBoard hostile(std::move(made), random(), first(), second(), harm, sum.noise);
  if (start == Start::kUploaded) hostile.load();
  hostile.make_noise(15 + static_cast<int>(random() % 30));
  hostile.calm_down();
  if (testing::Test::HasFailure()) return;

  auto owned = std::make_unique<SimTransport>(
      hostile.release(), SimTransportOptions{.silent_clocks = 5000, .most_silences = 20});
  SimTransport& link = *owned;
  if (resets) {
    ASSERT_TRUE(set_report(link, protocol::ResetReport{.key = protocol::kResetKey}));
  }
  ASSERT_TRUE(set_report(link, protocol::ControlReport{.idle_clocks = kIdleClocks, .log = 0}));
  FrameReader reader;
  synchronise(link, reader, kSequence);
  const auto status = get_report<protocol::StatusReport>(link);
  ASSERT_TRUE(status);
  const auto boot = get_report<protocol::BootReport>(link);
  ASSERT_TRUE(boot);
  const bool ready = status->state == static_cast<std::uint8_t>(DeviceState::kReady);
  EXPECT_FALSE(resets && ready);
  EXPECT_FALSE(boot->resident == 1 && !ready);
  const Reply reply = ask(link, reader, known_trace(kTraceSequence), kTraceSequence);
  ASSERT_TRUE(reply.came) << "known rays have no answer";
  EXPECT_EQ(reply.type, ready ? FrameType::kHits : FrameType::kError);
  if (reply.type == FrameType::kHits) {
    const bool old = reply.payload == first().hits;
    EXPECT_TRUE(old || boot->resident == 0) << "the image in flash is not what the board says";
    EXPECT_TRUE(harm == Harm::kImages || hostile.is_right(reply.payload));
    (old ? sum.kept : sum.replaced) += 1;
  } else {
    ++sum.empty;
    EXPECT_TRUE(harm != Harm::kNone || start == Start::kEmpty || resets)
        << "an image was lost to frames that load nothing";
  }
  expect_as_new(std::move(owned), boot->resident == 1, sum);
}

TEST(BoardNoise, AnImageIsRightOrNotThereAndTheBoardIsAsNew) {
  ASSERT_NE(first().hits, second().hits);
  const Seeds seeds(kMix);
  Sum sum;
  seeds.run([&](std::uint64_t seed) { run(seed, sum); });
  const auto n = [](std::uint64_t x) { return static_cast<unsigned long long>(x); };
  const NoiseCounts& c = sum.noise;
  std::printf(
      "seeds %llu to %llu: %llu frames of %llu bytes, %llu reports (%llu refused, %llu given "
      "up), %llu Resets, %llu commands, %llu hangs\n",
      n(seeds.begin), n(seeds.begin + seeds.count - 1), n(c.frames), n(c.bytes), n(c.reports),
      n(c.refused), n(c.given_up), n(c.resets), n(c.commands), n(c.hangs));
  std::printf(
      "known rays meanwhile: %llu times right, %llu times an error; afterwards the image of "
      "before %llu times, another %llu times, none %llu times; %llu uploads\n",
      n(c.right), n(c.errors), n(sum.kept), n(sum.replaced), n(sum.empty), n(sum.uploads));
  if (seeds.count < kMix) return;
  EXPECT_GT(c.right, 0U);
  EXPECT_GT(sum.kept, 0U);
  EXPECT_GT(sum.empty, 0U);
}

}  // namespace
}  // namespace gridrt::rtl
