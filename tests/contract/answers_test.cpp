// Cases 32, 33 and 35: nothing but the scene decides an answer.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <set>

#include "host/driver/session.hpp"
#include "tests/adversarial/devices.hpp"
#include "tests/contract/fixture.hpp"

namespace gridrt::contract {
namespace {

using protocol::Layout;

INSTANTIATE_TEST_SUITE_P(Devices, Contract, testing::ValuesIn(contract_devices()),
                         [](const auto& device) {
                           std::string name = device.param;  // gtest takes letters, digits and _
                           std::ranges::replace_if(
                               name, [](char c) { return c == '-' || c == ':' || c == '+'; }, '_');
                           return name;
                         });

struct Question {
  int bits = kDefaultBits;
  Scene scene;
  std::vector<Segment> segments;
  std::vector<Hit> closest;
  std::vector<Hit> any;
};

Question ask(int bits, std::uint64_t seed) {
  Question q;
  q.bits = bits;
  q.scene = awkward_scene(seed);
  q.segments = awkward_segments(q.scene, bits, seed + 1);
  q.closest = reference(q.scene, bits, q.segments, Query::kClosestHit);
  q.any = reference(q.scene, bits, q.segments, Query::kAnyHit);
  return q;
}

TEST_P(Contract, HitsDoNotDependOnPesGridMappingOrLayout) {
  const Question q = ask(bits(), 1);
  std::size_t taken = 0;
  std::size_t refusals = 0;
  for (const int pes : {1, 2, 4, 8}) {
    for (const Mapping mapping :
         {Mapping::kBoxes, Mapping::kContiguous, Mapping::kVoxel, Mapping::kMeasured}) {
      for (const glm::ivec3 grid : {glm::ivec3{0}, glm::ivec3{1}, glm::ivec3{7, 2, 12}}) {
        for (const Layout layout : {Layout::kCompact, Layout::kWide}) {
          // Compact images are measured where the grid is free: slow to make, so not more than
          // once.
          const bool free = grid.x == 0;
          if (layout == Layout::kCompact && free != (mapping == Mapping::kMeasured)) continue;
          ImageOptions options = plain(q.bits, pes);
          options.mapping = mapping;
          options.layout = layout;
          options.grid = free ? std::nullopt : std::optional(grid);
          const auto image = build_image(q.scene, options);
          if (!image) {  // eight PEs are beyond compact records
            ASSERT_EQ(image.error().kind, ErrorKind::kLimit) << image.error().message;
            ASSERT_EQ(layout, Layout::kCompact);
            continue;
          }
          std::string refused;
          const auto hits = answers({}, *image, q.segments, Query::kClosestHit, refused);
          if (!refused.empty()) {
            ++refusals;
            continue;
          }
          ++taken;
          const std::string what =
              std::to_string(pes) + " PEs, mapping " + std::string(mapping_name(mapping)) +
              ", grid " + std::to_string(grid.x) + ", " + std::string(protocol::name(layout));
          expect_same(hits, q.closest, what);
          expect_same(answers({}, *image, q.segments, Query::kAnyHit, refused), q.any,
                      what + ", any hit");
          if (HasFatalFailure()) return;
        }
      }
    }
  }
  EXPECT_GT(taken, 0U) << "the device takes no image at all";
  std::printf("%s: %zu kinds of image, %zu refused\n", GetParam().c_str(), taken, refusals);
}

TEST_P(Contract, HitsDoNotDependOnBatchesThreadsOrFramesInFlight) {
  const Question q = ask(bits(), 3);
  ImageOptions options = plain(q.bits);
  std::string refused;
  for (const Layout layout : {Layout::kCompact, Layout::kWide}) {
    options.layout = layout;
    const auto image = build_image(q.scene, options);
    ASSERT_TRUE(image) << image.error().message;
    for (const std::size_t batch : {1U, 7U, 64U, 8192U}) {
      for (const int threads : {1, 2, 3}) {
        DeviceOptions device;
        device.rays_per_frame = batch;
        device.threads = threads;
        device.frames_in_flight = threads == 2 ? 1 : 5;
        const auto hits = answers(device, *image, q.segments, Query::kClosestHit, refused);
        if (!refused.empty()) continue;
        expect_same(
            hits, q.closest,
            std::to_string(batch) + " rays a frame, " + std::to_string(threads) + " threads");
        if (HasFatalFailure()) return;
      }
    }
  }
}

TEST_P(Contract, HitsAtOtherLatticeBits) {
  std::size_t taken = 0;
  for (const int bits : {6, 11, 16, 20, 24}) {
    const Question q = ask(bits, static_cast<std::uint64_t>(bits));
    ImageOptions options = plain(bits);
    options.layout = bits <= kMaxCompactBits ? Layout::kCompact : Layout::kWide;
    // At few lattice bits the default grid of so many triangles may be too fine.
    options.grid = glm::ivec3{4};
    const auto image = build_image(q.scene, options);
    ASSERT_TRUE(image) << image.error().message;
    std::string refused;
    const auto hits = answers({}, *image, q.segments, Query::kClosestHit, refused);
    if (!refused.empty()) continue;
    ++taken;
    expect_same(hits, q.closest, std::to_string(bits) + " bits");
  }
  EXPECT_GT(taken, 0U);
}

TEST_P(Contract, AnyHitAgreesWithClosestHitAndSaysNothingElse) {
  const Question q = ask(bits(), 5);
  const auto image = build_image(q.scene, plain());
  ASSERT_TRUE(image);
  std::string refused;
  const auto closest = answers({}, *image, q.segments, Query::kClosestHit, refused);
  const auto any = answers({}, *image, q.segments, Query::kAnyHit, refused);
  if (!refused.empty()) GTEST_SKIP() << refused;
  std::size_t hits = 0;
  for (std::size_t i = 0; i < any.size(); ++i) {
    EXPECT_EQ(any[i].id, closest[i].id < 0 ? -1 : 0) << "ray " << i;
    EXPECT_TRUE(std::isnan(any[i].t) && std::isnan(any[i].u) && std::isnan(any[i].v));
    hits += closest[i].id < 0 ? 0 : 1;
  }
  EXPECT_GT(hits, any.size() / 5);
  EXPECT_LT(hits, any.size());
}

TEST_P(Contract, AnIgnoredTriangleIsNeverHit) {
  const Question q = ask(bits(), 7);
  for (const Layout layout : {Layout::kCompact, Layout::kWide}) {
    ImageOptions options = plain();
    options.layout = layout;
    const auto image = build_image(q.scene, options);
    ASSERT_TRUE(image);
    std::vector<Segment> without = q.segments;
    for (Segment& s : without) s.ignore = kNoTriangle;
    std::string refused;
    const auto first = answers({}, *image, without, Query::kClosestHit, refused);
    if (!refused.empty()) continue;
    // Ignoring what was hit: the answer of seq, and another triangle or a miss.
    std::vector<Segment> again = without;
    for (std::size_t i = 0; i < again.size(); ++i) {
      if (first[i].id >= 0) again[i].ignore = static_cast<std::uint32_t>(first[i].id);
    }
    const auto second = answers({}, *image, again, Query::kClosestHit, refused);
    for (std::size_t i = 0; i < again.size(); ++i) {
      if (first[i].id < 0) continue;
      EXPECT_NE(second[i].id, first[i].id);
      EXPECT_TRUE(second[i].id < 0 || second[i].t >= first[i].t * (1.0 - 1e-6)) << "ray " << i;
    }
    expect_same(second, reference(q.scene, q.bits, again, Query::kClosestHit), "ignoring");
    // A degenerate triangle, or one that does not exist, changes nothing.
    for (const std::uint32_t none : {static_cast<std::uint32_t>(q.scene.triangles.size() - 1),
                                     0xFFFFFEU, 0xFFFFFU, kNoTriangle - 1}) {
      std::vector<Segment> idle = without;
      for (Segment& s : idle) s.ignore = none;
      expect_same(answers({}, *image, idle, Query::kClosestHit, refused), first, "ignoring none");
    }
  }
}

TEST_P(Contract, SequenceNumbersRollOver) {
  const Question q = ask(bits(), 9);
  DeviceOptions options;
  options.rays_per_frame = 16;
  const auto device = open(options);
  ASSERT_TRUE(device);
  auto* session = dynamic_cast<Session*>(device.get());
  if (session == nullptr) GTEST_SKIP() << "no frames between the host and this device";
  const auto image = build_image(q.scene, plain());
  ASSERT_TRUE(image);
  for (const std::uint32_t start : {0xFFFFFFFFU, 0xFFFFFFF8U, 0xFFFFFFC0U, 0U}) {
    session->connection().set_next_sequence(start);
    if (!loads(*device, *image)) return;
    expect_same(trace(*device, q.segments, Query::kClosestHit), q.closest, "rolled over");
  }
  EXPECT_EQ(device->counters()->frames_retried, 0U);
}

TEST_P(Contract, ManyCallsOnOneDeviceAnswerAsOne) {
  const Question q = ask(bits(), 11);
  const auto image = build_image(q.scene, plain());
  const auto device = open();
  ASSERT_TRUE(image && device);
  if (!loads(*device, *image)) return;
  std::vector<Hit> hits(q.segments.size());
  std::size_t first = 0;
  for (std::size_t n = 0; first < hits.size(); first += n) {
    n = std::min(n + 13, hits.size() - first);
    const auto done = device->trace(std::span(q.segments).subspan(first, n), Query::kClosestHit,
                                    std::span(hits).subspan(first, n));
    ASSERT_TRUE(done) << done.error().message;
  }
  expect_same(hits, q.closest, "in many calls");
  EXPECT_TRUE(device->trace({}, Query::kClosestHit, {}));  // no rays, no error
}

TEST_P(Contract, CountersArePlausible) {
  const Question q = ask(bits(), 13);
  const auto image = build_image(q.scene, plain());
  const auto device = open();
  ASSERT_TRUE(image && device);
  if (!loads(*device, *image)) return;
  const auto before = device->counters();
  ASSERT_TRUE(before) << before.error().message;
  EXPECT_EQ(before->rays, 0U);
  EXPECT_GT(before->bytes_out, 0U);  // the image
  const auto hits = trace(*device, q.segments, Query::kClosestHit);
  const auto after = device->counters();
  ASSERT_TRUE(after) << after.error().message;
  std::uint64_t sent = 0;
  std::uint64_t met = 0;
  for (std::size_t i = 0; i < hits.size(); ++i) {
    sent += q.segments[i].is_miss() ? 0 : 1;
    met += hits[i].id >= 0 ? 1 : 0;
  }
  EXPECT_LT(sent, q.segments.size());  // some are misses by definition
  EXPECT_EQ(after->rays, sent);
  EXPECT_GE(after->steps, met);
  EXPECT_GE(after->tests, met);
  EXPECT_LE(after->tests, sent * q.scene.triangles.size() * image->grid().cells());
  EXPECT_GE(after->bytes_out - before->bytes_out, 16 * sent);
  EXPECT_GE(after->bytes_in - before->bytes_in, 4 * sent);
  EXPECT_LE(after->bytes_out - before->bytes_out, 40 * sent + 100000);
  trace(*device, q.segments, Query::kAnyHit);
  const auto last = device->counters();
  ASSERT_TRUE(last);
  EXPECT_EQ(last->rays, 2 * sent);
  EXPECT_GE(last->tests, after->tests);
  EXPECT_GE(last->steps, after->steps);
}

}  // namespace
}  // namespace gridrt::contract
