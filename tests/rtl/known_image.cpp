#include "tests/rtl/known_image.hpp"

#include <array>
#include <chrono>
#include <memory>
#include <random>
#include <utility>
#include <variant>

#include <gtest/gtest.h>

#include "hal/loopback.hpp"
#include "host/image/image_frames.hpp"
#include "host/pe/capabilities.hpp"
#include "host/pe/software_device.hpp"
#include "tests/rtl/payloads.hpp"

namespace gridrt::rtl {

using protocol::FrameType;

namespace {

constexpr std::uint32_t kTag = 4711;

/// The answer of software PEs to the frames.
std::vector<std::byte> software_hits(std::span<const std::byte> frames) {
  LoopbackTransport link(std::make_unique<SoftwareDevice>(
      SoftwareDeviceOptions{.name = "board", .capabilities = board_capabilities()}));
  EXPECT_TRUE(link.send(frames));
  FrameReader reader;
  std::array<std::byte, 4096> piece{};
  for (;;) {
    const auto got = link.receive(piece, std::chrono::milliseconds(1000));
    EXPECT_TRUE(got && *got > 0) << "no answer of the software PEs";
    if (!got || *got == 0) return {};
    reader.push(std::span(piece).first(*got));
    while (const auto event = reader.next()) {
      const auto* frame = std::get_if<Frame>(&*event);
      if (frame != nullptr && frame->type() == FrameType::kHits) {
        return {frame->payload.begin(), frame->payload.end()};
      }
    }
  }
}

}  // namespace

std::span<const protocol::RayCompact> known_rays() {
  static const std::vector<protocol::RayCompact> only = [] {
    constexpr std::uint32_t kBox = (1U << GRIDRT_RTL_B) * 2 / 3;  // within that of both images
    std::vector<protocol::RayCompact> rays(60);
    std::mt19937 random(23);
    for (protocol::RayCompact& ray : rays) {
      for (std::size_t a = 0; a < 3; ++a) {
        ray.p0[a] = static_cast<std::uint32_t>(random()) % kBox;
        ray.p1[a] = static_cast<std::uint32_t>(random()) % kBox;
      }
      ray.ignore = protocol::kNoIdCompact;
      ray.any_hit = random() % 8 == 0;
    }
    return rays;
  }();
  return only;
}

std::vector<std::byte> known_trace(std::uint32_t sequence) {
  std::vector<std::byte> frame;
  EXPECT_TRUE(append_frame(frame, FrameType::kTrace, protocol::Layout::kCompact, sequence,
                           trace_payload(known_rays(), kTag)));
  return frame;
}

KnownImage make_known(Image image) {
  KnownImage out{std::move(image), {}, {}};
  std::uint32_t sequence = 1;
  auto frames = image_frames(out.image, board_capabilities().max_payload, sequence);
  EXPECT_TRUE(frames);
  out.frames = std::move(*frames);
  std::vector<std::byte> all = out.frames;
  const auto trace = known_trace(sequence);
  all.insert(all.end(), trace.begin(), trace.end());
  out.hits = software_hits(all);
  return out;
}

Reply ask(Transport& link, FrameReader& reader, std::span<const std::byte> frame,
          std::uint32_t sequence) {
  EXPECT_TRUE(link.send(frame));
  std::array<std::byte, 4096> piece{};
  for (;;) {
    while (const auto event = reader.next()) {
      const auto* got = std::get_if<Frame>(&*event);
      if (got == nullptr || got->header.sequence != sequence) continue;
      return {true, got->type(), {got->payload.begin(), got->payload.end()}};
    }
    const auto got = link.receive(piece, {});
    EXPECT_TRUE(got) << got.error().message;
    if (!got || *got == 0) return {};
    reader.push(std::span(piece).first(*got));
  }
}

void synchronise(Transport& link, FrameReader& reader, std::uint32_t sequence) {
  constexpr std::uint32_t kAttempts = 8;
  for (std::uint32_t i = 0; i < kAttempts; ++i) {
    std::vector<std::byte> frame;
    EXPECT_TRUE(append_frame(frame, FrameType::kNoOp, protocol::Layout::kNone, sequence + i, {}));
    const Reply reply = ask(link, reader, frame, sequence + i);
    if (reply.came && reply.type == FrameType::kNoOp) return;
    if (testing::Test::HasFailure()) return;
  }
  ADD_FAILURE() << "no NoOp is answered";
}

}  // namespace gridrt::rtl
