// Frames: what the builder writes, and what the reader takes and refuses.
#include <functional>

#include <gtest/gtest.h>

#include "hal/crc32c.hpp"
#include "hal/frame.hpp"

namespace gridrt {
namespace {

using protocol::ErrorCode;
using protocol::FrameHeader;
using protocol::FrameType;
using protocol::Layout;

std::vector<std::byte> counting(std::size_t size, unsigned first = 0) {
  std::vector<std::byte> bytes(size);
  for (std::size_t i = 0; i < size; ++i) bytes[i] = static_cast<std::byte>((first + i) & 0xFFU);
  return bytes;
}

std::vector<std::byte> frame_of(std::span<const std::byte> payload, std::uint32_t sequence = 1) {
  std::vector<std::byte> out;
  EXPECT_TRUE(append_frame(out, FrameType::kTrace, Layout::kWide, sequence, payload));
  return out;
}

/// A frame whose header was changed, its CRC made right again.
std::vector<std::byte> changed_frame(const std::function<void(FrameHeader&)>& change) {
  std::vector<std::byte> bytes = frame_of(counting(16));
  const auto raw = std::span(bytes).first<FrameHeader::kBytes>();
  FrameHeader header = protocol::load_frame_header(raw);
  change(header);
  store(header, raw);
  protocol::detail::put32(bytes.data() + 16, crc32c(raw.first(16)));
  return bytes;
}

/// The next event, which must be a good frame.
Frame expect_frame(FrameReader& reader) {
  const auto event = reader.next();
  if (!event || !std::holds_alternative<Frame>(*event)) {
    ADD_FAILURE() << "no frame";
    return {};
  }
  return std::get<Frame>(*event);
}

FrameFault expect_fault(FrameReader& reader) {
  const auto event = reader.next();
  if (!event || !std::holds_alternative<FrameFault>(*event)) {
    ADD_FAILURE() << "no fault";
    return {};
  }
  return std::get<FrameFault>(*event);
}

TEST(Frame, RoundTrip) {
  const std::vector<std::byte> payload = counting(24);
  FrameReader reader;
  reader.push(frame_of(payload, 77));
  const Frame frame = expect_frame(reader);
  EXPECT_EQ(frame.type(), FrameType::kTrace);
  EXPECT_EQ(frame.layout(), Layout::kWide);
  EXPECT_EQ(frame.header.sequence, 77U);
  EXPECT_TRUE(std::ranges::equal(frame.payload, payload));
  EXPECT_TRUE(std::ranges::equal(frame.bytes, frame_of(payload, 77)));
  EXPECT_FALSE(reader.next());
  EXPECT_EQ(reader.garbage_bytes(), 0U);
  EXPECT_EQ(reader.bad_frames(), 0U);
}

TEST(Frame, BytesAreAsTheProtocolSays) {
  const std::vector<std::byte> bytes = frame_of(counting(4), 5);
  ASSERT_EQ(bytes.size(), kFrameOverhead + 4);
  const auto at = [&](std::size_t i) { return protocol::detail::get32(bytes.data() + i); };
  EXPECT_EQ(at(0), 0x31465247U);
  EXPECT_EQ(at(8), 5U);
  EXPECT_EQ(at(12), 4U);
  EXPECT_EQ(at(16), crc32c_table(std::span(bytes).first(16)));
  EXPECT_EQ(at(24), crc32c_table(std::span(bytes).subspan(20, 4)));
}

TEST(Frame, EmptyPayloadHasCrcZero) {
  const std::vector<std::byte> bytes = frame_of({});
  ASSERT_EQ(bytes.size(), kFrameOverhead);
  EXPECT_EQ(protocol::detail::get32(bytes.data() + 20), 0U);
  FrameReader reader;
  reader.push(bytes);
  EXPECT_TRUE(expect_frame(reader).payload.empty());
}

TEST(Frame, PayloadIsPaddedWithZeros) {
  for (std::size_t size = 1; size <= 9; ++size) {
    FrameReader reader;
    reader.push(frame_of(std::vector(size, std::byte{0xFF})));
    const Frame frame = expect_frame(reader);
    ASSERT_EQ(frame.payload.size(), (size + 3) / 4 * 4);
    for (std::size_t i = 0; i < frame.payload.size(); ++i) {
      EXPECT_EQ(frame.payload[i], i < size ? std::byte{0xFF} : std::byte{0});
    }
  }
}

TEST(Frame, BuilderInPlaceEqualsAppend) {
  std::vector<std::byte> out = counting(3);
  FrameBuilder builder(out, FrameType::kTrace, Layout::kWide, 1);
  builder.append(counting(6));
  std::ranges::copy(counting(7, 6), builder.extend(7).begin());
  EXPECT_EQ(builder.payload_bytes(), 13U);
  ASSERT_TRUE(builder.finish());
  const std::vector<std::byte> expected = frame_of(counting(13));
  EXPECT_TRUE(std::ranges::equal(std::span(out).subspan(3), expected));
}

TEST(Frame, PayloadLimit) {
  std::vector<std::byte> out = counting(5);
  ASSERT_TRUE(append_frame(out, FrameType::kHits, Layout::kWide, 0,
                           std::vector<std::byte>(protocol::kMaxPayload)));
  FrameReader reader;
  reader.push(std::span(out).subspan(5));
  EXPECT_EQ(expect_frame(reader).payload.size(), protocol::kMaxPayload);
  out.resize(5);
  const auto done = append_frame(out, FrameType::kHits, Layout::kWide, 0,
                                 std::vector<std::byte>(protocol::kMaxPayload + 1));
  ASSERT_FALSE(done);
  EXPECT_EQ(done.error().kind, ErrorKind::kLimit);
  EXPECT_EQ(out, counting(5));
}

TEST(Frame, SequenceWraps) {
  std::vector<std::byte> stream;
  std::uint32_t sequence = 0xFFFFFFFE;
  for (int i = 0; i < 4; ++i) {
    const auto bytes = frame_of(counting(4), sequence++);
    stream.insert(stream.end(), bytes.begin(), bytes.end());
  }
  FrameReader reader;
  reader.push(stream);
  for (const std::uint32_t expected : {0xFFFFFFFEU, 0xFFFFFFFFU, 0U, 1U}) {
    EXPECT_EQ(expect_frame(reader).header.sequence, expected);
  }
}

TEST(Frame, BadPayloadCrcIsAFaultThatNamesTheFrame) {
  std::vector<std::byte> bytes = frame_of(counting(16), 9);
  bytes[24] ^= std::byte{0x10};
  FrameReader reader;
  reader.push(bytes);
  const FrameFault fault = expect_fault(reader);
  EXPECT_EQ(fault.code, ErrorCode::kBadPayloadCrc);
  EXPECT_EQ(fault.header.sequence, 9U);
  EXPECT_EQ(reader.bad_frames(), 1U);
  reader.push(frame_of(counting(4), 10));
  EXPECT_EQ(expect_frame(reader).header.sequence, 10U);
}

TEST(Frame, OtherVersionIsAFault) {
  FrameReader reader;
  reader.push(changed_frame([](FrameHeader& h) { h.version = 2; }));
  const FrameFault fault = expect_fault(reader);
  EXPECT_EQ(fault.code, ErrorCode::kBadVersion);
  EXPECT_EQ(fault.detail, protocol::kVersion);
  reader.push(frame_of(counting(4), 3));
  EXPECT_EQ(expect_frame(reader).header.sequence, 3U);
}

TEST(Frame, WrongHeadersAreSkipped) {
  const std::vector<std::vector<std::byte>> wrong{
      changed_frame([](FrameHeader& h) { h.length = protocol::kMaxPayload + 4; }),
      changed_frame([](FrameHeader& h) { h.length = 0xFFFFFFFC; }),
      changed_frame([](FrameHeader& h) { h.length = 15; }),
      changed_frame([](FrameHeader& h) { h.flags = 1; }),
      changed_frame([](FrameHeader& h) { h.magic ^= 0x100; })};
  for (const auto& bytes : wrong) {
    FrameReader reader;
    reader.push(bytes);
    reader.push(frame_of(counting(4), 8));
    EXPECT_EQ(expect_frame(reader).header.sequence, 8U);
    EXPECT_EQ(reader.garbage_bytes(), bytes.size());
  }
}

TEST(Frame, ReaderHasAPayloadLimitOfItsOwn) {
  FrameReader reader(16);
  reader.push(frame_of(counting(20), 1));
  reader.push(frame_of(counting(16), 2));
  EXPECT_EQ(expect_frame(reader).header.sequence, 2U);
}

TEST(Frame, ShortenedFrameDoesNotHideTheNext) {
  const std::vector<std::byte> bytes = frame_of(counting(64), 1);
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    FrameReader reader;
    reader.push(std::span(bytes).first(size));
    EXPECT_FALSE(reader.next());
    // The sender goes on; enough bytes come to fill what the lost part would have taken.
    reader.push(frame_of(counting(64), 2));
    reader.push(frame_of(counting(64), 3));
    if (size >= FrameHeader::kBytes) {
      EXPECT_EQ(expect_fault(reader).code, ErrorCode::kBadPayloadCrc);
    }
    EXPECT_EQ(expect_frame(reader).header.sequence, 2U) << size;
    EXPECT_EQ(expect_frame(reader).header.sequence, 3U) << size;
    EXPECT_EQ(reader.garbage_bytes(), size);
  }
}

TEST(Frame, ResynchroniseGivesUpAnUnfinishedFrame) {
  FrameReader reader;
  reader.push(std::span<const std::byte>(frame_of(counting(1000), 1)).first(100));
  EXPECT_FALSE(reader.next());
  reader.push(frame_of(counting(8), 2));
  EXPECT_FALSE(reader.next()) << "still counted as payload";
  reader.resynchronise();
  EXPECT_EQ(expect_frame(reader).header.sequence, 2U);
  EXPECT_EQ(reader.bad_frames(), 1U);
  reader.resynchronise();
  EXPECT_EQ(reader.bad_frames(), 1U) << "nothing to give up";
}

TEST(Frame, ClearForgets) {
  FrameReader reader;
  const std::vector<std::byte> bytes = frame_of(counting(100), 1);
  reader.push(std::span(bytes).first(60));
  EXPECT_FALSE(reader.next());
  reader.clear();
  EXPECT_EQ(reader.buffered(), 0U);
  EXPECT_EQ(reader.garbage_bytes(), 60U);
  reader.push(std::span(bytes).subspan(60));
  EXPECT_FALSE(reader.next());
}

TEST(Frame, FilledInPlace) {
  FrameReader reader;
  const std::vector<std::byte> bytes = frame_of(counting(40), 6);
  for (const std::byte b : bytes) {
    const std::span<std::byte> space = reader.space(100);
    ASSERT_EQ(space.size(), 100U);
    space[0] = b;
    reader.filled(1);
  }
  EXPECT_EQ(expect_frame(reader).header.sequence, 6U);
}

}  // namespace
}  // namespace gridrt
