// What a device refuses, when, and that it can go on afterwards. Case 36 in part: an image that is
// too large is refused before anything is sent.
#include "tests/contract/fixture.hpp"

namespace gridrt::contract {
namespace {

TEST_P(Contract, RaysBeforeAnImageAreAnError) {
  const auto device = open();
  ASSERT_TRUE(device);
  Segment segment;
  segment.p1 = {1, 1, 1};
  std::vector<Hit> hits(1);
  const auto done = device->trace(std::span(&segment, 1), Query::kClosestHit, hits);
  ASSERT_FALSE(done);
  EXPECT_NE(done.error().message.find("image"), std::string::npos) << done.error().message;
  // The device is not spoilt by it.
  const Scene scene = awkward_scene(20);
  const auto image = build_image(scene, plain());
  ASSERT_TRUE(image);
  if (!loads(*device, *image)) return;
  const auto segments = awkward_segments(scene, bits(), 21);
  expect_same(trace(*device, segments, Query::kClosestHit),
              reference(scene, bits(), segments, Query::kClosestHit), "after an error");
}

TEST_P(Contract, AsManyHitsAsSegmentsAreAskedFor) {
  const auto device = open();
  const auto image = build_image(awkward_scene(22), plain());
  ASSERT_TRUE(device && image);
  if (!loads(*device, *image)) return;
  std::vector<Segment> segments(3);
  std::vector<Hit> hits(2);
  EXPECT_FALSE(device->trace(segments, Query::kClosestHit, hits));
}

TEST_P(Contract, AnImageBeyondTheDeviceIsRefusedBeforeAnythingIsSent) {
  const auto device = open();
  const Scene scene = awkward_scene(23);
  auto image = build_image(scene, plain());
  ASSERT_TRUE(device && image);
  if (!loads(*device, *image)) return;
  const auto before = device->counters();
  ASSERT_TRUE(before);
  Image large = *image;
  large.header.bits = 200;  // no device has so many
  const auto refused = device->load(large);
  ASSERT_FALSE(refused);
  EXPECT_TRUE(refused.error().kind == ErrorKind::kLimit ||
              refused.error().kind == ErrorKind::kUnsupported)
      << refused.error().message;
  EXPECT_FALSE(refused.error().advice.empty());
  const auto after = device->counters();
  ASSERT_TRUE(after);
  EXPECT_EQ(after->bytes_out, before->bytes_out);
  // A refused image leaves none loaded: no answers of the scene before pass for those of this one.
  Segment segment;
  segment.p1 = {1, 1, 1};
  std::vector<Hit> hits(1);
  EXPECT_FALSE(device->trace(std::span(&segment, 1), Query::kClosestHit, hits));
  ASSERT_TRUE(device->load(*image));
  EXPECT_TRUE(device->trace(std::span(&segment, 1), Query::kClosestHit, hits));
}

TEST_P(Contract, ADamagedImageIsRefusedAndTheNextOneLoads) {
  const Scene scene = awkward_scene(24);
  const auto image = build_image(scene, plain());
  ASSERT_TRUE(image);
  const auto segments = awkward_segments(scene, bits(), 25);
  const auto expected = reference(scene, bits(), segments, Query::kClosestHit);
  const auto device = open();
  ASSERT_TRUE(device);
  if (!loads(*device, *image)) return;
  // A cell's list that reaches beyond its owner's references.
  Image damaged = *image;
  for (ImageSection& section : damaged.sections) {
    if (section.kind != protocol::SectionKind::kCells) continue;
    for (std::byte& b : section.bytes) b = std::byte{0xFF};
  }
  EXPECT_FALSE(device->load(damaged));
  ASSERT_TRUE(device->load(*image));
  expect_same(trace(*device, segments, Query::kClosestHit), expected, "after a damaged image");
}

TEST_P(Contract, ASecondImageReplacesTheFirst) {
  const auto device = open();
  ASSERT_TRUE(device);
  for (const std::uint64_t seed : {30U, 31U, 30U, 32U}) {
    const Scene scene = awkward_scene(seed);
    const auto image = build_image(scene, plain(bits() - static_cast<int>(seed % 4)));
    ASSERT_TRUE(image);
    if (!loads(*device, *image)) return;
    const int image_bits = image->header.bits;
    const auto segments = awkward_segments(scene, image_bits, seed);
    expect_same(trace(*device, segments, Query::kClosestHit),
                reference(scene, image_bits, segments, Query::kClosestHit), "after a reload");
  }
}

TEST_P(Contract, ASceneWithoutTrianglesIsAnsweredWithMisses) {
  const auto device = open();
  Scene empty;
  empty.materials.emplace_back();
  ImageOptions options = plain();
  options.grid.reset();  // nothing to lay one over
  const auto image = build_image(empty, options);
  ASSERT_TRUE(device && image);
  if (!loads(*device, *image)) return;
  std::vector<Segment> segments(5);
  for (int i = 0; i < 5; ++i) segments[static_cast<std::size_t>(i)].p1 = {i % 5, 4, 1};
  for (const Hit& hit : trace(*device, segments, Query::kClosestHit)) {
    EXPECT_TRUE(same(hit, Hit{}));
  }
}

TEST_P(Contract, RaysOutsideTheBoxAreRefused) {
  const auto device = open();
  const auto image = build_image(awkward_scene(26), plain());
  ASSERT_TRUE(device && image);
  if (!loads(*device, *image)) return;
  std::vector<Segment> segments(4);
  for (Segment& s : segments) s.p1 = {1, 1, 1};
  segments[2].p1 = image->lattice().box() + 1;
  std::vector<Hit> hits(4);
  EXPECT_FALSE(device->trace(segments, Query::kClosestHit, hits));
  segments[2].p1 = image->lattice().box();
  EXPECT_TRUE(device->trace(segments, Query::kClosestHit, hits));
}

TEST(Names, UnknownDevicesAndOptionsAreRefusedWithAdvice) {
  for (const char* name : {"fpga", "", "seq ", "SEQ"}) {
    DeviceOptions options;
    options.name = name;
    const auto device = open_device(options);
    ASSERT_FALSE(device) << name;
    EXPECT_EQ(device.error().kind, ErrorKind::kUsage);
    EXPECT_NE(device.error().advice.find("seq"), std::string::npos);
  }
  for (const char* name : {"mpi", "sim", "usb", "usb:123"}) {
    DeviceOptions options;
    options.name = name;
    const auto device = open_device(options);
    if (device) continue;  // built in
    const bool no_board = device.error().kind == ErrorKind::kTransport;
    EXPECT_TRUE(no_board || device.error().kind == ErrorKind::kUnsupported) << name;
    EXPECT_NE(device.error().advice.find(no_board ? "gridrt-board list" : "omp"),
              std::string::npos);
  }
  for (int wrong = 0; wrong < 4; ++wrong) {
    DeviceOptions options;
    options.name = "seq";
    if (wrong == 0) options.rays_per_frame = 0;
    if (wrong == 1) options.frames_in_flight = 0;
    if (wrong == 2) options.timeout_ms = 0;
    if (wrong == 3) options.schedule = "never";
    const auto device = open_device(options);
    ASSERT_FALSE(device);
    EXPECT_EQ(device.error().kind, ErrorKind::kUsage);
  }
}

}  // namespace
}  // namespace gridrt::contract
