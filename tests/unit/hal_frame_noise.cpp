// The frame reader on streams that are cut, dirty or damaged, by many random schedules.
#include <random>

#include <gtest/gtest.h>

#include "hal/frame.hpp"

namespace gridrt {
namespace {

using protocol::FrameType;
using protocol::Layout;

std::size_t below(std::mt19937& random, std::size_t bound) { return random() % bound; }

std::vector<std::byte> random_bytes(std::mt19937& random, std::size_t size) {
  std::vector<std::byte> bytes(size);
  for (std::byte& b : bytes) b = static_cast<std::byte>(random() & 0xFFU);
  return bytes;
}

/// Garbage that looks like frames as often as not: magics, headers, pieces of frames.
std::vector<std::byte> nasty_garbage(std::mt19937& random) {
  std::vector<std::byte> frame;
  EXPECT_TRUE(append_frame(frame, FrameType::kHits, Layout::kCompact, 7,
                           random_bytes(random, below(random, 40))));
  switch (below(random, 4)) {
    case 0:
      return random_bytes(random, below(random, 50));
    case 1:
      frame.resize(1 + below(random, protocol::FrameHeader::kBytes - 1));
      return frame;
    case 2: {  // a header with one bit wrong
      frame.resize(protocol::FrameHeader::kBytes);
      const std::size_t bit = below(random, 8 * frame.size());
      frame[bit / 8] ^= static_cast<std::byte>(1U << (bit % 8));
      return frame;
    }
    default: {
      std::vector<std::byte> magics(9);
      for (std::byte& b : magics) b = frame[below(random, 4)];
      return magics;
    }
  }
}

struct Sent {
  std::uint32_t sequence;
  std::vector<std::byte> payload;
};

/// Pushes a stream in random pieces and collects the frames.
std::vector<Sent> read_in_pieces(FrameReader& reader, std::span<const std::byte> stream,
                                 std::size_t most, std::mt19937& random) {
  std::vector<Sent> got;
  while (!stream.empty()) {
    const std::size_t size = std::min(stream.size(), 1 + below(random, most));
    reader.push(stream.first(size));
    stream = stream.subspan(size);
    while (const auto event = reader.next()) {
      if (const auto* frame = std::get_if<Frame>(&*event)) {
        got.push_back({frame->header.sequence, {frame->payload.begin(), frame->payload.end()}});
      }
    }
  }
  return got;
}

TEST(FrameNoise, EveryFrameIsFoundInDirtyStreamsCutAnywhere) {
  for (unsigned seed = 0; seed < 60; ++seed) {
    std::mt19937 random(seed);
    std::vector<std::byte> stream;
    std::vector<Sent> sent;
    std::uint64_t garbage = 0;
    for (std::uint32_t i = 0; i < 100; ++i) {
      if (below(random, 3) == 0) {
        const std::vector<std::byte> dirt = nasty_garbage(random);
        garbage += dirt.size();
        stream.insert(stream.end(), dirt.begin(), dirt.end());
      }
      sent.push_back({0xFFFFFFD0U + i, random_bytes(random, 4 * below(random, 60))});
      ASSERT_TRUE(append_frame(stream, FrameType::kTrace, Layout::kWide, sent.back().sequence,
                               sent.back().payload));
    }
    FrameReader reader;
    const std::vector<Sent> got = read_in_pieces(reader, stream, seed % 2 == 0 ? 7 : 900, random);
    ASSERT_EQ(got.size(), sent.size()) << "seed " << seed;
    for (std::size_t i = 0; i < sent.size(); ++i) {
      EXPECT_EQ(got[i].sequence, sent[i].sequence);
      EXPECT_EQ(got[i].payload, sent[i].payload);
    }
    EXPECT_EQ(reader.garbage_bytes(), garbage) << "seed " << seed;
    EXPECT_EQ(reader.buffered(), 0U);
  }
}

TEST(FrameNoise, NoFlippedBitPasses) {
  std::mt19937 random(5);
  std::vector<std::byte> bytes;
  ASSERT_TRUE(append_frame(bytes, FrameType::kTrace, Layout::kWide, 1, random_bytes(random, 32)));
  std::vector<std::byte> after;
  ASSERT_TRUE(append_frame(after, FrameType::kTrace, Layout::kWide, 2, random_bytes(random, 64)));
  for (std::size_t bit = 0; bit < 8 * bytes.size(); ++bit) {
    std::vector<std::byte> stream = bytes;
    stream[bit / 8] ^= static_cast<std::byte>(1U << (bit % 8));
    stream.insert(stream.end(), after.begin(), after.end());
    FrameReader reader;
    const std::vector<Sent> got = read_in_pieces(reader, stream, 50, random);
    ASSERT_EQ(got.size(), 1U) << "bit " << bit;
    EXPECT_EQ(got[0].sequence, 2U);
    EXPECT_GE(reader.bad_frames() + reader.garbage_bytes(), 1U);
  }
}

TEST(FrameNoise, DroppedBytesLoseOnlyTheirFrame) {
  for (unsigned seed = 0; seed < 200; ++seed) {
    std::mt19937 random(seed);
    std::vector<std::byte> stream;
    std::vector<std::size_t> starts;
    for (std::uint32_t i = 0; i < 6; ++i) {
      starts.push_back(stream.size());
      ASSERT_TRUE(append_frame(stream, FrameType::kTrace, Layout::kWide, i,
                               random_bytes(random, 4 * (10 + below(random, 20)))));
    }
    starts.push_back(stream.size());
    const std::size_t victim = below(random, 3);
    const std::size_t size = starts[victim + 1] - starts[victim];
    const std::size_t first = below(random, size);
    const std::size_t count = 1 + below(random, size - first);
    const auto at = stream.begin() + static_cast<std::ptrdiff_t>(starts[victim] + first);
    stream.erase(at, at + static_cast<std::ptrdiff_t>(count));
    FrameReader reader;
    const std::vector<Sent> got = read_in_pieces(reader, stream, 40, random);
    ASSERT_EQ(got.size(), 5U) << "seed " << seed;
    std::uint32_t expected = 0;
    for (const Sent& frame : got) {
      if (expected == victim) ++expected;
      EXPECT_EQ(frame.sequence, expected++);
    }
  }
}

TEST(FrameNoise, MemoryStaysBounded) {
  std::mt19937 random(9);
  FrameReader reader(1024);
  for (int i = 0; i < 20000; ++i) {
    reader.push(nasty_garbage(random));
    while (reader.next()) {
    }
    ASSERT_LE(reader.buffered(), 1024 + kFrameOverhead);
  }
}

}  // namespace
}  // namespace gridrt
