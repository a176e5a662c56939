// The order in which rays go to a clocked device: all of them, once, neighbours far apart, and the
// answers where they belong.
#include <algorithm>
#include <numeric>

#include <gtest/gtest.h>

#include "hal/loopback.hpp"
#include "host/driver/ray_order.hpp"
#include "host/driver/session.hpp"
#include "host/pe/software_device.hpp"
#include "tests/unit/pe_fixture.hpp"

namespace gridrt {
namespace {

/// Writes down the rays that pass.
class Listener final : public Endpoint {
 public:
  Listener(SoftwareDeviceOptions options, std::vector<glm::ivec3>& starts)
      : inner_(std::move(options)), starts_(starts) {}

  Result<void> consume(std::span<const std::byte> bytes) override {
    reader_.push(bytes);
    while (const auto event = reader_.next()) {
      const Frame& frame = std::get<Frame>(*event);
      if (frame.type() != protocol::FrameType::kTrace) continue;
      constexpr std::size_t kBytes = protocol::RayWide::kBytes;
      for (std::size_t at = protocol::TraceHead::kBytes; at < frame.payload.size(); at += kBytes) {
        const auto ray = protocol::unpack_ray_wide(frame.payload.subspan(at).first<kBytes>());
        starts_.emplace_back(ray.p0[0], ray.p0[1], ray.p0[2]);
      }
    }
    return inner_.consume(bytes);
  }
  Result<std::size_t> produce(std::span<std::byte> out, std::chrono::milliseconds limit) override {
    return inner_.produce(out, limit);
  }
  Result<void> get_feature(std::uint8_t id, std::span<std::byte> body) override {
    return inner_.get_feature(id, body);
  }
  Result<void> set_feature(std::uint8_t id, std::span<const std::byte> body) override {
    return inner_.set_feature(id, body);
  }

 private:
  SoftwareDevice inner_;
  FrameReader reader_;
  std::vector<glm::ivec3>& starts_;
};

TEST(RayOrder, EveryPlaceComesOnce) {
  std::vector<std::size_t> numbers{0, 1, 2, 3, 4, 6, 210, 1023, 2310, 4096, 30030, 307200, 510510};
  for (std::size_t n = 5; n < 700; ++n) numbers.push_back(n);
  for (const std::size_t n : numbers) {
    std::vector<std::size_t> places(n);
    std::iota(places.begin(), places.end(), 7U);
    std::vector<std::size_t> order = spread(places);
    std::ranges::sort(order);
    ASSERT_EQ(order, places) << n;
  }
}

TEST(RayOrder, FewConsecutiveOnesAreNeighbours) {
  for (const std::size_t n : {500U, 1024U, 30030U, 131072U, 307200U, 510510U}) {
    const std::size_t stride = spreading_stride(n);
    EXPECT_EQ(std::gcd(stride, n), 1U);
    for (std::size_t i = 1; i < 13; ++i) {
      const std::size_t away = i * stride % n;
      EXPECT_GT(std::min(away, n - away), n / 50) << n << " after " << i;
    }
  }
}

struct Traced {
  std::vector<glm::ivec3> starts;
  std::vector<Hit> hits;
};

Traced run(std::uint32_t clock_hz, bool spread_rays, const Image& image,
           std::span<const Segment> segments) {
  Traced out;
  SoftwareDeviceOptions software;
  software.capabilities.clock_hz = clock_hz;
  DeviceOptions options;
  options.spread_rays = spread_rays;
  options.rays_per_frame = 100;
  auto session = Session::open(
      std::make_unique<LoopbackTransport>(std::make_unique<Listener>(software, out.starts)),
      options);
  EXPECT_TRUE(session && (*session)->load(image));
  out.hits.resize(segments.size());
  EXPECT_TRUE((*session)->trace(segments, Query::kClosestHit, out.hits));
  return out;
}

TEST(RayOrder, OnlyClockedDevicesGetSpreadRaysAndAnswersAreTheSame) {
  const Image image = fixture::make_image("builtin:teapot");
  const auto segments = fixture::random_segments(image, 1234, 5);
  std::vector<glm::ivec3> in_order;
  for (const Segment& s : segments) {
    if (!s.is_miss()) in_order.push_back(s.p0);
  }
  const Traced software = run(0, true, image, segments);
  const Traced clocked = run(1, true, image, segments);
  const Traced measured = run(1, false, image, segments);
  EXPECT_EQ(software.starts, in_order);
  EXPECT_EQ(measured.starts, in_order);
  ASSERT_EQ(clocked.starts.size(), in_order.size());
  const std::size_t stride = spreading_stride(in_order.size());
  for (std::size_t i = 0; i < in_order.size(); ++i) {
    ASSERT_EQ(clocked.starts[i], in_order[i * stride % in_order.size()]) << i;
  }
  for (std::size_t i = 0; i < segments.size(); ++i) {
    ASSERT_EQ(clocked.hits[i].id, software.hits[i].id) << i;
    ASSERT_EQ(clocked.hits[i].t, software.hits[i].t) << i;
  }
}

}  // namespace
}  // namespace gridrt
