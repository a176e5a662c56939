// The loopback link: clean, cut and faulty, with an endpoint that echoes frames.
#include <algorithm>
#include <map>
#include <memory>

#include <gtest/gtest.h>

#include "hal/loopback.hpp"

namespace gridrt {
namespace {

using namespace std::chrono_literals;
using protocol::FrameType;
using protocol::Layout;

/// Sends every good frame back and keeps one feature report.
class Echo final : public Endpoint {
 public:
  Result<void> consume(std::span<const std::byte> bytes) override {
    ++transfers;
    reader_.push(bytes);
    while (const auto event = reader_.next()) {
      if (const auto* frame = std::get_if<Frame>(&*event)) {
        out_.insert(out_.end(), frame->bytes.begin(), frame->bytes.end());
      }
    }
    return {};
  }
  Result<std::size_t> produce(std::span<std::byte> out, std::chrono::milliseconds) override {
    const std::size_t size = std::min(out.size(), out_.size());
    std::copy_n(out_.begin(), size, out.begin());
    out_.erase(out_.begin(), out_.begin() + static_cast<std::ptrdiff_t>(size));
    return size;
  }
  Result<void> get_feature(std::uint8_t id, std::span<std::byte> body) override {
    if (id != protocol::StatusReport::kId) return fail(ErrorKind::kUnsupported, "no such report");
    protocol::StatusReport status;
    status.bad_frames = static_cast<std::uint32_t>(reader_.bad_frames());
    store(status, body.first<protocol::StatusReport::kBytes>());
    return {};
  }
  Result<void> set_feature(std::uint8_t id, std::span<const std::byte> body) override {
    set[id] = {body.begin(), body.end()};
    return {};
  }

  std::size_t transfers = 0;
  std::map<std::uint8_t, std::vector<std::byte>> set;

 private:
  FrameReader reader_;
  std::vector<std::byte> out_;
};

/// A link to an Echo that the test can look at.
struct Link {
  explicit Link(const LoopbackOptions& options = {}) {
    auto endpoint = std::make_unique<Echo>();
    echo = endpoint.get();
    transport = std::make_unique<LoopbackTransport>(std::move(endpoint), options);
  }
  Echo* echo;
  std::unique_ptr<LoopbackTransport> transport;
};

std::vector<std::byte> make_frame(std::uint32_t sequence) {
  std::vector<std::byte> bytes;
  EXPECT_TRUE(append_frame(bytes, FrameType::kNoOp, Layout::kNone, sequence,
                           std::vector(20, static_cast<std::byte>(sequence & 0xFFU))));
  return bytes;
}

/// Sends `count` frames and returns the sequence numbers that come back as good frames.
std::vector<std::uint32_t> exchange(Transport& transport, std::uint32_t count) {
  std::vector<std::uint32_t> got;
  FrameReader reader;
  std::array<std::byte, 512> buffer{};
  for (std::uint32_t i = 0; i < count; ++i) {
    EXPECT_TRUE(transport.send(make_frame(i)));
    while (true) {
      const auto size = transport.receive(buffer, 0ms);
      EXPECT_TRUE(size);
      if (!size || *size == 0) break;
      reader.push(std::span(buffer).first(*size));
      while (const auto event = reader.next()) {
        if (const auto* frame = std::get_if<Frame>(&*event)) got.push_back(frame->header.sequence);
      }
    }
  }
  return got;
}

std::vector<std::uint32_t> all_of(std::uint32_t count) {
  std::vector<std::uint32_t> sequence(count);
  for (std::uint32_t i = 0; i < count; ++i) sequence[i] = i;
  return sequence;
}

TEST(Loopback, CleanLinkGivesAllBack) {
  Link link;
  EXPECT_EQ(exchange(*link.transport, 100), all_of(100));
  EXPECT_EQ(link.echo->transfers, 100U);
  EXPECT_EQ(link.transport->faults(), 0U);
}

TEST(Loopback, CutTransfersChangeNothing) {
  Link link({.max_transfer = 5, .to_device = {}, .to_host = {}, .seed = 3});
  EXPECT_EQ(exchange(*link.transport, 100), all_of(100));
  EXPECT_GT(link.echo->transfers, 800U);
}

TEST(Loopback, Reports) {
  Link link;
  const auto status = get_report<protocol::StatusReport>(*link.transport);
  ASSERT_TRUE(status);
  EXPECT_EQ(status->bad_frames, 0U);
  const auto counters = get_report<protocol::CountersReport>(*link.transport);
  ASSERT_FALSE(counters);
  EXPECT_EQ(counters.error().kind, ErrorKind::kUnsupported);
  ASSERT_TRUE(set_report(*link.transport, protocol::ResetReport{.key = protocol::kResetKey}));
  EXPECT_EQ(link.echo->set[protocol::ResetReport::kId].size(), 4U);
  EXPECT_EQ(link.echo->set[protocol::ResetReport::kId][0], std::byte{'R'});
}

/// The frames that come back over a link with one kind of fault on the way out.
std::vector<std::uint32_t> exchange_with(const FaultRates& rates, std::uint64_t& faults,
                                         bool to_host = false) {
  LoopbackOptions options;
  (to_host ? options.to_host : options.to_device) = rates;
  options.max_transfer = 33;
  Link link(options);
  auto got = exchange(*link.transport, 400);
  faults = link.transport->faults();
  return got;
}

TEST(Faults, DropFlipAndTruncateLoseFrames) {
  for (const bool to_host : {false, true}) {
    for (const FaultRates& rates :
         {FaultRates{.drop = 0.2}, FaultRates{.flip = 0.2}, FaultRates{.truncate = 0.2}}) {
      std::uint64_t faults = 0;
      const auto got = exchange_with(rates, faults, to_host);
      EXPECT_GT(faults, 40U);
      EXPECT_LT(faults, 140U);
      // The last frames may still wait behind a shortened one; no other frame is lost.
      EXPECT_LE(got.size(), 400 - faults);
      EXPECT_GE(got.size() + 3, 400 - faults);
      EXPECT_TRUE(std::ranges::is_sorted(got));
    }
  }
}

TEST(Faults, DuplicateGivesFramesTwice) {
  std::uint64_t faults = 0;
  const auto got = exchange_with({.duplicate = 0.2}, faults);
  EXPECT_EQ(got.size(), 400 + faults);
  EXPECT_GT(faults, 40U);
}

TEST(Faults, ReorderKeepsEveryFrame) {
  std::uint64_t faults = 0;
  auto got = exchange_with({.reorder = 0.2}, faults);
  EXPECT_GT(faults, 40U);
  EXPECT_FALSE(std::ranges::is_sorted(got));
  std::ranges::sort(got);
  EXPECT_GE(got.size(), 399U);  // one may still be held back
  EXPECT_EQ(std::ranges::adjacent_find(got), got.end());
}

TEST(Faults, GarbageLosesNothing) {
  std::uint64_t faults = 0;
  EXPECT_EQ(exchange_with({.garbage = 0.3}, faults), all_of(400));
  EXPECT_GT(faults, 60U);
}

TEST(Faults, SeedRepeatsTheScheduleAndLimitEndsIt) {
  const FaultRates rates{
      .drop = 0.1, .flip = 0.1, .truncate = 0.1, .duplicate = 0.1, .reorder = 0.1, .garbage = 0.1};
  std::uint64_t first = 0;
  std::uint64_t second = 0;
  EXPECT_EQ(exchange_with(rates, first), exchange_with(rates, second));
  EXPECT_EQ(first, second);
  FaultRates limited = rates;
  limited.limit = 3;
  std::uint64_t faults = 0;
  const auto got = exchange_with(limited, faults);
  EXPECT_EQ(faults, 3U);
  EXPECT_GE(got.size(), 397U);
}

}  // namespace
}  // namespace gridrt
