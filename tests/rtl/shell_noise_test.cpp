// A hostile host at gridrt_shell: random bytes, frames with every field changed and their CRCs made
// right again, streams that do not end, registers at random. Nothing may be written beyond an image
// memory; and after a Reset, images and rays are taken as if nothing had been.
#include <cstdio>

#include <gtest/gtest.h>

#include "tests/rtl/environment.hpp"
#include "tests/rtl/hostile_frames.hpp"
#include "tests/rtl/shell_bench.hpp"

namespace gridrt::rtl {
namespace {

using protocol::FrameType;
using protocol::SectionKind;

constexpr std::uint32_t kIdleWindow = 0x1C0;
constexpr std::uint32_t kRegistersEnd = 0x240;

std::uint64_t schedules() { return number_of("GRIDRT_NOISE_SCHEDULES", 12); }

/// What a schedule has thrown, to know that it was something.
struct Thrown {
  std::uint64_t frames = 0, bytes = 0, records = 0, rays = 0, refusals = 0;
};

class Noise {
 public:
  Noise(std::uint64_t seed, const Image& image, Thrown& thrown)
      : hostile_(seed * 7919 + 3, image),
        bench_(static_cast<unsigned>(seed)),
        image_(image),
        thrown_(thrown) {
    const auto percent = [&] { return below(3) == 0 ? 20 + static_cast<int>(below(80)) : 100; };
    bench_.pace = {.rx = percent(), .tx = percent(), .ray = percent(), .hit = percent()};
    bench_.write(kIdleWindow, 500 + below(3000));
  }

  void make() {
    if (below(2) == 0) send_image(bench_, image_, 1, 512);
    for (std::uint32_t actions = 20 + below(60); actions > 0; --actions) {
      act();
      bench_.run(static_cast<int>(below(600)));
      look();
    }
  }

  /// A Reset, and a host in order finds a board in order.
  void recover() {
    bench_.reset_report();
    bench_.write(kIdleWindow, 4000);
    bench_.run_until_quiet(9000);
    look();
    bench_.from_device.clear();
    bench_.reset_report();
    bench_.pace = {};
    bench_.rays.clear();
    const std::uint32_t commit = send_image(bench_, image_, 1000);
    const auto rays = rays_in(image_, 60, 17);
    bench_.send(FrameType::kTrace, 5000, trace_payload(rays, 77), protocol::Layout::kCompact);
    bench_.run_until_quiet(1000);
    EXPECT_EQ(bench_.loads, records_of(image_));
    const std::vector<Answer> answers = take_answers(bench_);
    ASSERT_EQ(answers.size(), 2U);
    EXPECT_EQ(answers[0].type(), FrameType::kNoOp);
    EXPECT_EQ(answers[0].header.sequence, commit);
    EXPECT_EQ(answers[1].type(), FrameType::kHits);
    EXPECT_EQ(answers[1].payload, hits_payload(bench_, rays, 77));
  }

 private:
  std::uint32_t below(std::uint32_t bound) { return hostile_.below(bound); }

  /// All that has gone to the engine lies within its memories.
  void look() {
    for (const LoadedRecord& record : bench_.loads) {
      ASSERT_GE(record.kind, 1) << "a record of no kind";
      ASSERT_LT(record.kind, kHolds.size()) << "a record of no kind";
      EXPECT_LT(record.index, kHolds.at(record.kind)) << "a record beyond its memory";
      EXPECT_LT(record.pe, GRIDRT_RTL_PES) << "a record for no PE";
      const bool shared = record.kind <= static_cast<int>(SectionKind::kCells);
      EXPECT_TRUE(!shared || record.pe == 0) << "a shared record for one PE";
    }
    thrown_.records += bench_.loads.size();
    thrown_.rays += bench_.rays.size();
    bench_.loads.clear();
    bench_.rays.clear();
  }

  void send(std::span<const std::byte> frame) {
    ++thrown_.frames;
    thrown_.bytes += frame.size();
    bench_.send(frame);
  }

  void act() {
    switch (below(10)) {
      case 0:
        send(hostile_.bytes(below(300)));
        break;
      case 1:
      case 2:
        send(hostile_.load());
        break;
      case 3:
        send(hostile_.sections());
        break;
      case 4:
        send(hostile_.trace());
        break;
      case 5:
        send(hostile_.commit());
        break;
      case 6:
        send(hostile_.any());
        break;
      case 7:
        send(hostile_.promise());
        break;
      case 8:
        touch_register();
        break;
      default:
        commit_truly();
        break;
    }
  }

  void commit_truly() {
    bench_.send(FrameType::kCommit, 9, commit_payload((1U << GRIDRT_RTL_PES) - 1U));
    ++thrown_.frames;
    if (below(2) == 0) return;
    send_image(bench_, image_, 11, 1024);
    for (std::uint32_t i = below(4); i > 0; --i) send(hostile_.trace());
    bench_.run_until_quiet(200);
  }

  void touch_register() {
    const std::uint32_t address = 4 * below(kRegistersEnd / 4);
    if (below(2) == 0) {
      bench_.read(address);
    } else if (address == kIdleWindow) {
      bench_.write(address, 1 + below(4000));
    } else {
      bench_.write(address, below(4) == 0 ? protocol::kResetKey : hostile_.value());
    }
  }

  HostileFrames hostile_;
  ShellBench bench_;
  const Image& image_;
  Thrown& thrown_;
};

TEST(ShellNoise, NothingIsWrittenBeyondAMemoryAndAResetMakesTheShellAsNew) {
  const Image image = small_image(12, GRIDRT_RTL_PES);
  Thrown thrown;
  for (std::uint64_t seed = 0; seed < schedules(); ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Noise noise(seed, image, thrown);
    noise.make();
    noise.recover();
    if (HasFailure()) break;
  }
  const auto number = [](std::uint64_t n) { return static_cast<unsigned long long>(n); };
  std::printf("%llu schedules: %llu frames of %llu bytes, %llu records, %llu rays\n",
              number(schedules()), number(thrown.frames), number(thrown.bytes),
              number(thrown.records), number(thrown.rays));
  EXPECT_GT(thrown.records, 0U);
  EXPECT_GT(thrown.rays, 0U);
}

}  // namespace
}  // namespace gridrt::rtl
