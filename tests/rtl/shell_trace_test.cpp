// Rays and hits through gridrt_shell, and what happens when frames are wrong, cut or surrounded by
// garbage.
#include <algorithm>

#include <gtest/gtest.h>

#include "hal/crc32c.hpp"
#include "tests/rtl/shell_bench.hpp"

namespace gridrt::rtl {
namespace {

using protocol::ErrorCode;
using protocol::FrameType;
using protocol::Layout;
using protocol::RayCompact;
using protocol::SectionKind;

class ShellTrace : public testing::Test {
 protected:
  ShellTrace() : image_(small_image(12, GRIDRT_RTL_PES)) {
    send_image(bench_, image_, 1);
    bench_.run_until_quiet();
    take_answers(bench_);
  }
  void send_rays(std::span<const RayCompact> rays, std::uint32_t sequence) {
    bench_.send(FrameType::kTrace, sequence, trace_payload(rays, sequence + 5), Layout::kCompact);
  }
  void expect_hits(const Answer& answer, std::span<const RayCompact> rays,
                   std::uint32_t sequence) const {
    EXPECT_TRUE(answer.good);
    EXPECT_EQ(answer.type(), FrameType::kHits);
    EXPECT_EQ(answer.header.sequence, sequence);
    EXPECT_EQ(answer.header.layout, static_cast<int>(Layout::kCompact));
    EXPECT_EQ(answer.payload, hits_payload(bench_, rays, sequence + 5)) << "frame " << sequence;
  }
  static void expect_error(const Answer& answer, std::uint32_t sequence, ErrorCode code,
                           std::uint32_t detail = 0) {
    EXPECT_EQ(answer.header.sequence, sequence);
    EXPECT_EQ(answer.code(), code) << protocol::name(answer.code());
    EXPECT_EQ(answer.detail(), detail);
  }
  std::vector<Answer> all() {
    bench_.run_until_quiet();
    return take_answers(bench_);
  }
  /// The device still does its work.
  void expect_sound() {
    const auto rays = rays_in(image_, 5, 77);
    send_rays(rays, 900);
    const auto answers = all();
    ASSERT_EQ(answers.size(), 1U);
    expect_hits(answers[0], rays, 900);
  }

  ShellBench bench_;
  Image image_;
};

TEST_F(ShellTrace, AnswersInOrderAtAnyPace) {
  std::uint32_t sequence = 10;
  for (const Pace pace :
       {Pace{}, Pace{.rx = 30}, Pace{.tx = 20}, Pace{.ray = 10}, Pace{.hit = 10},
        Pace{.rx = 60, .tx = 60, .ray = 60, .hit = 60, .latency = 1}, Pace{.latency = 1500}}) {
    bench_.pace = pace;
    bench_.rays.clear();
    std::vector<std::vector<RayCompact>> batches;
    std::vector<RayCompact> sent;
    for (const std::size_t count : {1U, 2U, 7U, 100U, 1U, 60U}) {
      batches.push_back(rays_in(image_, count, sequence + static_cast<unsigned>(count)));
      sent.insert(sent.end(), batches.back().begin(), batches.back().end());
      send_rays(batches.back(), sequence + static_cast<unsigned>(2 * batches.size()));
      bench_.send(FrameType::kNoOp, sequence + static_cast<unsigned>(2 * batches.size()) + 1, {});
    }
    bench_.run_until_quiet(2000);
    const auto answers = take_answers(bench_);
    ASSERT_EQ(answers.size(), 2 * batches.size());
    for (std::size_t i = 0; i < batches.size(); ++i) {
      const std::uint32_t number = sequence + static_cast<unsigned>(2 * i + 2);
      expect_hits(answers[2 * i], batches[i], number);
      EXPECT_EQ(answers[2 * i + 1].type(), FrameType::kNoOp);
      EXPECT_EQ(answers[2 * i + 1].header.sequence, number + 1);
    }
    EXPECT_EQ(bench_.rays, sent);
    sequence += 100;
  }
}

TEST_F(ShellTrace, ARepeatedTraceIsAnsweredAgain) {
  const auto rays = rays_in(image_, 9, 4);
  send_rays(rays, 30);
  send_rays(rays, 30);
  const auto answers = all();
  ASSERT_EQ(answers.size(), 2U);
  expect_hits(answers[0], rays, 30);
  expect_hits(answers[1], rays, 30);
}

TEST_F(ShellTrace, WrongFramesAreAnsweredByErrors) {
  const auto rays = rays_in(image_, 4, 5);
  std::vector<std::byte> payload = trace_payload(rays, 1);
  const auto trace = [&](std::uint32_t sequence, std::span<const std::byte> bytes,
                         Layout layout = Layout::kCompact) {
    bench_.send(FrameType::kTrace, sequence, bytes, layout);
  };
  trace(1, payload, Layout::kWide);
  trace(2, payload, Layout::kNone);
  trace(3, std::span(payload).first(payload.size() - 4));
  trace(4, std::span(payload).first(8));
  trace(5, std::span(payload).first(4));
  trace(6, {});
  std::vector<std::byte> wrong = payload;
  wrong[0] = std::byte{5};  // five rays in the space of four
  trace(7, wrong);
  wrong[3] = std::byte{0x10};
  trace(8, wrong);
  bench_.send(static_cast<FrameType>(0x10), 9, payload);
  bench_.send(FrameType::kHits, 10, payload, Layout::kCompact);
  bench_.send(FrameType::kCommit, 11, commit_payload(15));  // good: it is committed already
  bench_.send(FrameType::kCommit, 12, payload);
  bench_.send(FrameType::kCommit, 13, {});
  bench_.send(FrameType::kLoadSection, 14, {});
  bench_.send(FrameType::kLoadSection, 15, std::span(payload).first(12));
  protocol::LoadHead head;
  head.kind = 1;
  head.bytes = 5;
  head.total = 5;
  bench_.send(FrameType::kLoadSection, 16, load_payload(head, {}));
  head.bytes = 0xFFFFFFFF;  // padded it would be 0
  bench_.send(FrameType::kLoadSection, 17, load_payload(head, {}));
  bench_.send(FrameType::kNoOp, 18, std::vector<std::byte>(16388));
  bench_.send(FrameType::kNoOp, 19, payload);
  const auto answers = all();
  ASSERT_EQ(answers.size(), 19U);
  expect_error(answers[0], 1, ErrorCode::kBadLayout, 2);
  expect_error(answers[1], 2, ErrorCode::kBadLayout, 0);
  expect_error(answers[2], 3, ErrorCode::kBadLength, 68);
  expect_error(answers[3], 4, ErrorCode::kBadLength, 8);
  expect_error(answers[4], 5, ErrorCode::kBadLength, 4);
  expect_error(answers[5], 6, ErrorCode::kBadLength, 0);
  expect_error(answers[6], 7, ErrorCode::kBadLength, 72);
  expect_error(answers[7], 8, ErrorCode::kBadLength, 72);
  expect_error(answers[8], 9, ErrorCode::kBadType, 0x10);
  expect_error(answers[9], 10, ErrorCode::kBadType, 4);
  EXPECT_EQ(answers[10].type(), FrameType::kNoOp);
  expect_error(answers[11], 12, ErrorCode::kBadLength, 72);
  expect_error(answers[12], 13, ErrorCode::kBadLength, 0);
  expect_error(answers[13], 14, ErrorCode::kBadLength, 0);
  expect_error(answers[14], 15, ErrorCode::kBadLength, 12);
  expect_error(answers[15], 16, ErrorCode::kBadLength, 16);
  expect_error(answers[16], 17, ErrorCode::kBadLength, 16);
  expect_error(answers[17], 18, ErrorCode::kBadLength, 16388);
  EXPECT_EQ(answers[18].type(), FrameType::kNoOp);
  EXPECT_TRUE(bench_.rays.empty());
  EXPECT_EQ(bench_.status().last_error, static_cast<int>(ErrorCode::kBadLength));
  EXPECT_EQ(bench_.status().bad_frames, 0U);
  expect_sound();
}

TEST_F(ShellTrace, RaysOutsideTheBoxAreRefused) {
  for (std::size_t a = 0; a < 6; ++a) {
    for (const std::size_t bad : {0U, 3U, 9U}) {
      auto rays = rays_in(image_, 10, 6);
      auto& end = a < 3 ? rays[bad].p0 : rays[bad].p1;
      end[a % 3] = static_cast<std::uint32_t>(image_.header.max_q[a % 3]) + 3U;
      bench_.rays.clear();
      send_rays(rays, 40);
      const auto answers = all();
      ASSERT_EQ(answers.size(), 2U);
      EXPECT_FALSE(answers[0].good);
      expect_error(answers[1], 40, ErrorCode::kBadRay, static_cast<std::uint32_t>(bad));
      EXPECT_EQ(bench_.rays.size(), bad);
    }
  }
  // Bits that a smaller lattice does not have are looked at, too.
  auto rays = rays_in(image_, 1, 6);
  rays[0].p0[0] = 1U << 16U;
  send_rays(rays, 41);
  const auto answers = all();
  ASSERT_EQ(answers.size(), 2U);
  expect_error(answers[1], 41, ErrorCode::kBadRay, 0);
  expect_sound();
}

TEST_F(ShellTrace, DamagedPayloadsAreAskedForAgain) {
  const auto rays = rays_in(image_, 20, 7);
  for (const std::size_t at : {20U, 24U, 29U, 60U, 347U, 350U}) {
    std::vector<std::byte> frame;
    ASSERT_TRUE(
        append_frame(frame, FrameType::kTrace, Layout::kCompact, 50, trace_payload(rays, 55)));
    frame[at] ^= std::byte{1};
    bench_.send(frame);
    bench_.send(FrameType::kNoOp, 51, {});
    const auto answers = all();
    ASSERT_GE(answers.size(), 2U);
    EXPECT_EQ(answers.size(), at == 20 ? 2U : 3U);  // a wrong count is no Trace at all
    for (std::size_t i = 0; i + 2 < answers.size(); ++i) EXPECT_FALSE(answers[i].good);
    expect_error(answers[answers.size() - 2], 50, ErrorCode::kBadPayloadCrc);
    EXPECT_EQ(answers.back().type(), FrameType::kNoOp);
    expect_sound();
  }
  for (const FrameType type : {FrameType::kNoOp, FrameType::kCommit, FrameType::kLoadSection}) {
    std::vector<std::byte> frame;
    ASSERT_TRUE(append_frame(frame, type, Layout::kNone, 52, commit_payload(15)));
    frame[22] ^= std::byte{1};
    bench_.send(frame);
    const auto answers = all();
    ASSERT_EQ(answers.size(), 1U);
    expect_error(answers[0], 52, ErrorCode::kBadPayloadCrc);
  }
  EXPECT_EQ(bench_.status().bad_frames, 9U);
  expect_sound();
}

TEST_F(ShellTrace, AnotherVersionIsToldOurs) {
  std::vector<std::byte> frame;
  ASSERT_TRUE(append_frame(frame, FrameType::kTrace, Layout::kCompact, 60, {}));
  frame[4] = std::byte{2};
  protocol::detail::put32(frame.data() + 16, crc32c(std::span(frame).first(16)));
  bench_.send(frame);
  const auto answers = all();
  ASSERT_EQ(answers.size(), 1U);
  expect_error(answers[0], 60, ErrorCode::kBadVersion, protocol::kVersion);
  expect_sound();
}

TEST_F(ShellTrace, FramesAreFoundWithinGarbage) {
  std::mt19937 source(8);
  const auto random = [&] { return static_cast<std::uint32_t>(source()); };
  std::vector<std::byte> start;
  ASSERT_TRUE(append_frame(start, FrameType::kNoOp, Layout::kNone, 61, {}));
  const auto rays = rays_in(image_, 3, 9);
  for (std::uint32_t round = 0; round < 300; ++round) {
    const std::uint32_t kind = random() % 3;
    for (std::uint32_t i = random() % 40; i > 0; --i) {
      bench_.to_device.push_back(kind == 0 ? static_cast<std::byte>(random())
                                           : start[random() % 4]);
    }
    if (kind == 2) {  // a header that breaks off, or is wrong somewhere
      std::vector<std::byte> part(start.begin(), start.begin() + 1 + random() % 19);
      if (random() % 2 == 0) {
        part.assign(start.begin(), start.begin() + 20);
        part[random() % 20] ^= static_cast<std::byte>(1U << random() % 8);
      }
      bench_.send(part);
    }
    send_rays(rays, 1000 + round);
    const auto answers = all();
    ASSERT_EQ(answers.size(), 1U) << round;
    expect_hits(answers[0], rays, 1000 + round);
  }
}

TEST_F(ShellTrace, HeadersThatLieAreGarbage) {
  const auto with = [&](std::size_t at, std::uint8_t value) {
    std::vector<std::byte> frame;
    ASSERT_TRUE(append_frame(frame, FrameType::kNoOp, Layout::kNone, 62, {}));
    frame[at] = static_cast<std::byte>(value);
    protocol::detail::put32(frame.data() + 16, crc32c(std::span(frame).first(16)));
    bench_.send(frame);
  };
  with(7, 1);      // flags
  with(12, 2);     // not a multiple of 4
  with(14, 0x41);  // above the protocol's limit
  with(15, 0x80);
  EXPECT_TRUE(all().empty());
  EXPECT_EQ(bench_.status().bad_frames, 4U);
  expect_sound();
}

TEST_F(ShellTrace, CutFramesAreGivenUp) {
  bench_.write(0x1C0, 300);
  EXPECT_EQ(bench_.read(0x1C0), 300U);
  const auto rays = rays_in(image_, 6, 10);
  std::vector<std::byte> frame;
  ASSERT_TRUE(
      append_frame(frame, FrameType::kTrace, Layout::kCompact, 70, trace_payload(rays, 75)));
  for (std::size_t bytes = 1; bytes < frame.size(); bytes += bytes < 60 ? 1 : 7) {
    bench_.rays.clear();
    bench_.send(std::span(frame).first(bytes));
    bench_.run_until_quiet(1000);
    const auto answers = take_answers(bench_);
    if (bytes < 20) {
      EXPECT_TRUE(answers.empty());
    } else {
      ASSERT_EQ(answers.size(), bytes < 28 ? 1U : 2U) << bytes;
      expect_error(answers.back(), 70, ErrorCode::kBadPayloadCrc);
      if (answers.size() == 2) {
        EXPECT_FALSE(answers[0].good);
      }
      EXPECT_EQ(bench_.rays.size(), bytes < 28 ? 0 : std::min<std::size_t>(6, (bytes - 28) / 16));
    }
    expect_sound();
  }
}

TEST_F(ShellTrace, SlowAnswersAreNotAPauseOfTheHost) {
  // The device itself holds the bytes back for longer than it waits for bytes.
  bench_.write(0x1C0, 50);
  bench_.pace = {.ray = 1, .latency = 300};
  const auto rays = rays_in(image_, 30, 11);
  send_rays(rays, 80);
  const auto answers = all();
  ASSERT_EQ(answers.size(), 1U);
  expect_hits(answers[0], rays, 80);
}

TEST_F(ShellTrace, ANewImageWaitsForTheRays) {
  bench_.pace = {.tx = 10, .hit = 5, .latency = 2000};
  std::uint32_t sequence = 100;
  for (int i = 0; i < 3; ++i) {
    const auto rays = rays_in(image_, 50, 12);
    send_rays(rays, sequence++);
    sequence = send_image(bench_, small_image(i % 2 == 0 ? 14 : 12, 2), sequence) + 1;
  }
  bench_.run_until_quiet(3000);  // the bench looks for records while rays are in flight
  const auto answers = take_answers(bench_);
  EXPECT_EQ(answers.size(), 6U);
  for (std::size_t i = 0; i < answers.size(); ++i) {
    EXPECT_EQ(answers[i].type(), i % 2 == 0 ? FrameType::kHits : FrameType::kNoOp);
  }
}

}  // namespace
}  // namespace gridrt::rtl
