// A device that sends and sends, on virtual time: the driver ends with one clear error.
#include <algorithm>
#include <cstdint>
#include <vector>

#include <gtest/gtest.h>

#include "host/driver/session.hpp"
#include "host/pe/software_device.hpp"
#include "tests/unit/pe_fixture.hpp"

namespace gridrt {
namespace {

using protocol::FrameType;
using std::chrono::milliseconds;

constexpr int kTimeout = 10'000;

std::vector<std::byte> frame(FrameType type, std::uint32_t sequence) {
  std::vector<std::byte> out;
  EXPECT_TRUE(append_frame(out, type, protocol::Layout::kNone, sequence, {}));
  return out;
}

/// An honest device until a frame of type `from` comes, from then on one that says the same again
/// and again, a second apart.
class EndlessTransport final : public Transport {
 public:
  EndlessTransport(FrameType from, std::vector<std::byte> says, milliseconds& now)
      : from_(from), says_(std::move(says)), now_(now) {}

  Result<void> send(std::span<const std::byte> bytes) override {
    const auto header = protocol::load_frame_header(bytes.first<protocol::FrameHeader::kBytes>());
    if (header.type == static_cast<std::uint8_t>(from_)) endless_ = true;
    return device_.consume(bytes);
  }
  Result<std::size_t> receive(std::span<std::byte> out, milliseconds timeout) override {
    if (!endless_) {
      const auto got = device_.produce(out, milliseconds(0));
      if (got.value_or(1) == 0) now_ += timeout;
      return got;
    }
    now_ += std::chrono::seconds(1);
    std::ranges::copy(says_, out.begin());
    return says_.size();
  }
  Result<void> get_feature(std::uint8_t id, std::span<std::byte> body) override {
    if (id == protocol::ControlReport::kId) return {};
    if (id == protocol::LogReport::kId) {  // always one more word
      std::array<std::byte, protocol::LogReport::kBytes> log{};
      protocol::LogReport report;
      report.count = 1;
      protocol::store(report, log);
      std::ranges::copy(log, body.begin());
      return {};
    }
    return device_.get_feature(id, body);
  }
  Result<void> set_feature(std::uint8_t /*id*/, std::span<const std::byte> /*body*/) override {
    return {};
  }
  [[nodiscard]] milliseconds now() const override { return now_; }

 private:
  SoftwareDevice device_{SoftwareDeviceOptions{}};
  FrameType from_;
  std::vector<std::byte> says_;
  milliseconds& now_;
  bool endless_ = false;
};

/// Loads and traces over such a link; what came of it.
Result<void> run(FrameType from, std::vector<std::byte> says, milliseconds& now) {
  const Image image = fixture::make_image("builtin:cube");
  auto session = Session::open(std::make_unique<EndlessTransport>(from, std::move(says), now),
                               {.timeout_ms = kTimeout});
  if (!session) return std::unexpected(session.error());
  if (auto loaded = (*session)->load(image); !loaded) return loaded;
  const auto segments = fixture::random_segments(image, 64, 3);
  std::vector<Hit> hits(segments.size());
  return (*session)->trace(segments, Query::kClosestHit, hits);
}

TEST(EndlessDevice, BytesThatAreNoAnswerEndInTime) {
  const std::vector<std::vector<std::byte>> kinds{
      std::vector<std::byte>(100, std::byte{0x47}),  // garbage
      frame(FrameType::kNoOp, 0x12345678),           // an answer to nobody
      frame(FrameType::kHits, 0x12345678),
  };
  for (const FrameType from : {FrameType::kCommit, FrameType::kTrace}) {
    for (const auto& says : kinds) {
      milliseconds now{0};
      const auto done = run(from, says, now);
      ASSERT_FALSE(done.has_value());
      EXPECT_EQ(done.error().kind, ErrorKind::kTimeout);
      EXPECT_NE(done.error().message.find("keeps sending"), std::string::npos)
          << done.error().message;
      EXPECT_LE(now.count(), 10 * kTimeout);
    }
  }
}

TEST(EndlessDevice, WorkThatGoesOnIsBelievedForAnHour) {
  for (const FrameType from : {FrameType::kCommit, FrameType::kTrace}) {
    milliseconds now{0};
    const auto done = run(from, frame(FrameType::kNoOp, 0), now);
    ASSERT_FALSE(done.has_value());
    EXPECT_EQ(done.error().kind, ErrorKind::kTimeout);
    EXPECT_GE(now, std::chrono::hours(1));
    EXPECT_LE(now, std::chrono::hours(1) + milliseconds(10 * kTimeout));
  }
}

TEST(EndlessDevice, AnEventLogThatDoesNotEndIsRefused) {
  const Image image = fixture::make_image("builtin:cube");
  milliseconds now{0};
  auto session = Session::open(
      std::make_unique<EndlessTransport>(FrameType::kNoOp, std::vector<std::byte>{}, now), {});
  ASSERT_TRUE(session.has_value());
  ASSERT_TRUE((*session)->load(image).has_value());
  const auto told = (*session)->explain(image, fixture::random_segments(image, 1, 3).front());
  ASSERT_FALSE(told.has_value());
  EXPECT_EQ(told.error().kind, ErrorKind::kProtocol);
}

}  // namespace
}  // namespace gridrt
