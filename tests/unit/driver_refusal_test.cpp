// A device that answers wrongly is found out: no wrong hit passes the driver in silence.
#include <gtest/gtest.h>

#include "hal/loopback.hpp"
#include "host/driver/session.hpp"
#include "host/driver/upload.hpp"
#include "host/pe/software_device.hpp"
#include "tests/unit/pe_fixture.hpp"
#include "tests/unit/rewriting_endpoint.hpp"

namespace gridrt {
namespace {

using fixture::LooseFrame;
using protocol::FrameType;

bool is_hits(const LooseFrame& frame) {
  return frame.header.type == static_cast<std::uint8_t>(FrameType::kHits);
}

struct Traced {
  Result<void> result;
  std::vector<Hit> hits;
  std::uint64_t retries = 0;
};

/// Loads a teapot and traces 256 rays through a device whose answers are rewritten.
Traced trace_through(const fixture::Rewrite& rewrite) {
  const Image image = fixture::make_image("builtin:teapot?tessellation=4");
  const std::vector<Segment> segments = fixture::random_segments(image, 256, 21);
  DeviceOptions options;
  options.rays_per_frame = 32;
  options.timeout_ms = 1;
  auto device = std::make_unique<fixture::RewritingEndpoint>(
      std::make_unique<SoftwareDevice>(SoftwareDeviceOptions{}), rewrite);
  auto session = Session::open(std::make_unique<LoopbackTransport>(std::move(device)), options);
  if (!session) throw std::runtime_error(session.error().message);
  Traced traced{(*session)->load(image), std::vector<Hit>(segments.size())};
  if (traced.result) {
    traced.result = (*session)->trace(segments, Query::kClosestHit, traced.hits);
  }
  traced.retries = (*session)->counters()->frames_retried;
  return traced;
}

std::vector<LooseFrame> unchanged(LooseFrame frame) { return {std::move(frame)}; }

std::vector<std::int32_t> ids(const Traced& traced) {
  std::vector<std::int32_t> list;
  for (const Hit& h : traced.hits) list.push_back(h.id);
  return list;
}

TEST(DriverRefusal, TheHonestDeviceIsBelieved) {
  const Traced traced = trace_through(unchanged);
  ASSERT_TRUE(traced.result.has_value()) << traced.result.error().message;
  EXPECT_EQ(traced.retries, 0U);
}

TEST(DriverRefusal, SilenceWhileTracingIsATimeout) {
  const Traced traced = trace_through([](LooseFrame frame) {
    return is_hits(frame) ? std::vector<LooseFrame>{} : unchanged(std::move(frame));
  });
  ASSERT_FALSE(traced.result.has_value());
  EXPECT_EQ(traced.result.error().kind, ErrorKind::kTimeout);
}

TEST(DriverRefusal, AnswersUnderAnotherSequenceNumberAreNotTaken) {
  // Each batch is first answered with the hits of the batch before under its own number plus a
  // large offset: taking them would give wrong ids.
  std::vector<LooseFrame> held;
  const Traced honest = trace_through(unchanged);
  const Traced traced = trace_through([&](LooseFrame frame) -> std::vector<LooseFrame> {
    if (!is_hits(frame)) return unchanged(std::move(frame));
    std::vector<LooseFrame> out;
    if (!held.empty()) {
      LooseFrame wrong = held.back();
      wrong.header.sequence = frame.header.sequence + 0x1000000U;
      out.push_back(wrong);
    }
    held.push_back(frame);
    out.push_back(std::move(frame));
    return out;
  });
  ASSERT_TRUE(traced.result.has_value());
  EXPECT_EQ(ids(traced), ids(honest));
}

TEST(DriverRefusal, AnotherBatchsHitsUnderThisNumberAreRefused) {
  std::vector<std::byte> first;
  const Traced traced = trace_through([&](LooseFrame frame) {
    if (is_hits(frame)) {
      if (first.empty()) first = frame.payload;
      frame.payload = first;  // its TraceHead carries the first batch's tag
    }
    return unchanged(std::move(frame));
  });
  ASSERT_FALSE(traced.result.has_value());
  EXPECT_EQ(traced.result.error().kind, ErrorKind::kProtocol);
}

TEST(DriverRefusal, TooFewHits) {
  const Traced traced = trace_through([](LooseFrame frame) {
    if (is_hits(frame)) frame.payload.resize(frame.payload.size() - 8);
    return unchanged(std::move(frame));
  });
  ASSERT_FALSE(traced.result.has_value());
  EXPECT_EQ(traced.result.error().kind, ErrorKind::kProtocol);
}

TEST(DriverRefusal, AnIdBeyondTheImageOrATriangleThatIsNotMet) {
  for (const std::uint32_t id : {0x7FFFFFFFU, 0U}) {
    const Traced traced = trace_through([&](LooseFrame frame) {
      if (is_hits(frame)) {
        for (std::size_t at = protocol::TraceHead::kBytes; at < frame.payload.size(); at += 8) {
          protocol::HitWide hit;
          hit.id = id;
          hit.hit = true;
          protocol::pack(hit, std::span(frame.payload).subspan(at).first<8>());
        }
      }
      return unchanged(std::move(frame));
    });
    ASSERT_FALSE(traced.result.has_value()) << id;
    EXPECT_EQ(traced.result.error().kind, ErrorKind::kProtocol) << id;
  }
}

TEST(DriverRefusal, AnImageTooLargeIsRefusedBeforeAnythingIsSent) {
  const Image image = fixture::make_image("builtin:teapot?tessellation=4");
  protocol::CapabilitiesReport small;
  small.layouts = 0xFF;
  small.max_bits = 24;
  small.pes = 64;
  small.max_payload = 4096;
  small.max_triangles = small.max_vertices = small.max_references = 1U << 30U;
  small.max_cells = small.max_blocks = 1U << 30U;
  ASSERT_TRUE(check_fits(image, small).has_value());
  small.max_triangles = 10;
  const Result<void> refused = check_fits(image, small);
  ASSERT_FALSE(refused.has_value());
  EXPECT_EQ(refused.error().kind, ErrorKind::kLimit);
  EXPECT_NE(refused.error().message.find("holds 10"), std::string::npos);
  EXPECT_FALSE(refused.error().advice.empty());
  small.max_triangles = 1U << 30U;
  small.max_bits = 12;
  EXPECT_FALSE(check_fits(image, small).has_value());
}

TEST(DriverRefusal, TracingWithoutAnImage) {
  auto session = Session::open(std::make_unique<LoopbackTransport>(
                                   std::make_unique<SoftwareDevice>(SoftwareDeviceOptions{})),
                               {});
  ASSERT_TRUE(session.has_value());
  std::vector<Hit> hits(1);
  const std::vector<Segment> segments(1);
  EXPECT_FALSE((*session)->trace(segments, Query::kClosestHit, hits).has_value());
}

TEST(Devices, NamesAreCheckedAndExplained) {
  DeviceOptions options;
  options.name = "usb:no such serial";
  const auto board = open_device(options);
  ASSERT_FALSE(board.has_value());
  EXPECT_EQ(board.error().kind, ErrorKind::kTransport);
  EXPECT_NE(board.error().message.find("no such serial"), std::string::npos);
  options.name = "quantum";
  EXPECT_EQ(open_device(options).error().kind, ErrorKind::kUsage);
  for (const std::string& name : built_in_devices()) {
    if (name == "usb") continue;  // no board is part of a machine that tests run on
    options.name = name;
    const auto device = open_device(options);
    ASSERT_TRUE(device.has_value()) << name;
    EXPECT_EQ((*device)->name(), name);
  }
}

}  // namespace
}  // namespace gridrt
