// A link that loses, damages, doubles and reorders frames changes nothing but the retry count.
#include <cstring>

#include <gtest/gtest.h>

#include "hal/loopback.hpp"
#include "host/driver/session.hpp"
#include "host/pe/software_device.hpp"
#include "tests/unit/pe_fixture.hpp"

namespace gridrt {
namespace {

std::unique_ptr<Session> open(const LoopbackOptions& link, const DeviceOptions& options) {
  auto transport = std::make_unique<LoopbackTransport>(
      std::make_unique<SoftwareDevice>(SoftwareDeviceOptions{}), link);
  Result<std::unique_ptr<Session>> session = Session::open(std::move(transport), options);
  if (!session) throw std::runtime_error(session.error().message);
  return std::move(*session);
}

std::vector<Hit> trace_all(Session& session, const Image& image,
                           std::span<const Segment> segments) {
  const Result<void> loaded = session.load(image);
  EXPECT_TRUE(loaded.has_value()) << loaded.error().message;
  std::vector<Hit> hits(segments.size());
  const Result<void> traced = session.trace(segments, Query::kClosestHit, hits);
  EXPECT_TRUE(traced.has_value()) << traced.error().message;
  return hits;
}

bool same(const std::vector<Hit>& a, const std::vector<Hit>& b) {
  if (a.size() != b.size()) return false;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (a[i].id != b[i].id || a[i].t != b[i].t || a[i].u != b[i].u || a[i].v != b[i].v) {
      return false;
    }
  }
  return true;
}

constexpr int kSeedsEach = 20;

class Recovery : public testing::TestWithParam<int> {
 protected:
  static FaultRates rates(double each) {
    FaultRates r;
    r.drop = r.flip = r.truncate = r.duplicate = r.reorder = r.garbage = each;
    return r;
  }
};

TEST_P(Recovery, SameHitsOverABadLink) {
  ImageOptions image_options;
  image_options.layout = protocol::Layout::kWide;
  const Image image = fixture::make_image("builtin:teapot?tessellation=5", image_options);
  const std::vector<Segment> segments = fixture::random_segments(image, 3000, 11);
  DeviceOptions options;
  options.rays_per_frame = 64;
  options.timeout_ms = 5;
  const std::unique_ptr<Session> good = open({}, options);
  const std::vector<Hit> expected = trace_all(*good, image, segments);
  EXPECT_EQ(good->counters()->frames_retried, 0U);

  LoopbackOptions link;
  link.max_transfer = 97;
  link.to_device = rates(0.02);
  link.to_host = rates(0.02);
  std::uint64_t retried = 0;
  for (int i = 0; i < kSeedsEach; ++i) {
    link.seed = static_cast<std::uint64_t>(GetParam() * kSeedsEach + i);
    const std::unique_ptr<Session> bad = open(link, options);
    ASSERT_TRUE(same(trace_all(*bad, image, segments), expected)) << "seed " << link.seed;
    retried += bad->counters()->frames_retried;
  }
  EXPECT_GT(retried, 0U) << "no fault was injected";
}

INSTANTIATE_TEST_SUITE_P(Seeds, Recovery, testing::Range(0, 10));

TEST(RecoveryLimits, ADeadLinkIsATimeoutNotAHang) {
  const Image image = fixture::make_image("builtin:cube");
  DeviceOptions options;
  options.timeout_ms = 1;
  LoopbackOptions link;
  link.to_host.drop = 1.0;
  const std::unique_ptr<Session> session = open(link, options);
  const Result<void> loaded = session->load(image);
  ASSERT_FALSE(loaded.has_value());
  EXPECT_EQ(loaded.error().kind, ErrorKind::kTimeout);
  EXPECT_NE(loaded.error().message.find("no answer to an image in 16 attempts"), std::string::npos)
      << loaded.error().message;
}

TEST(SequenceNumbers, RollOverInTheMiddleOfAPicture) {
  const Image image = fixture::make_image("builtin:teapot?tessellation=4");
  const std::vector<Segment> segments = fixture::random_segments(image, 2000, 13);
  DeviceOptions options;
  options.rays_per_frame = 16;
  const std::unique_ptr<Session> fresh = open({}, options);
  const std::vector<Hit> expected = trace_all(*fresh, image, segments);
  const std::unique_ptr<Session> old = open({}, options);
  old->connection().set_next_sequence(0xFFFFFFE0U);
  EXPECT_TRUE(same(trace_all(*old, image, segments), expected));
}

}  // namespace
}  // namespace gridrt
