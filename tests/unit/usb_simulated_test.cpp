// The virtual board around the simulated RTL: its soft core's firmware answers reports and sends
// its own, and rays go through the host's USB code to the RTL and back.
#include <array>
#include <bit>
#include <cstdlib>
#include <optional>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "gridrt_usb.hpp"
#include "hal/frame.hpp"
#include "host/driver/device.hpp"
#include "host/driver/flash_image.hpp"
#include "host/image/image.hpp"
#include "host/pe/capabilities.hpp"
#include "tests/contract/awkward.hpp"
#include "tests/unit/image_support.hpp"
#include "tests/unit/usb_fake_bus.hpp"
#include "tools/virtual/board.hpp"

namespace gridrt {
namespace {

using protocol::JournalCode;
using Report = std::array<std::byte, protocol::kReportBytes>;

struct Traced {
  Scene scene;
  Image image;
  std::vector<Segment> segments;
  std::vector<Hit> right;
};

Traced make_traced(Scene scene) {
  ::setenv("GRIDRT_CONTRACT_RAYS", "60", 0);
  ImageOptions options;
  options.layout = protocol::Layout::kCompact;
  options.grid = glm::ivec3{6};
  options.with_scene = false;
  Traced out{std::move(scene), {}, {}, {}};
  out.image = build_image(out.scene, options).value();
  out.segments = contract::awkward_segments(out.scene, kDefaultBits, 72);
  out.right = contract::reference(out.scene, kDefaultBits, out.segments, Query::kClosestHit);
  return out;
}

class SimulatedBoard : public testing::Test {
 protected:
  void SetUp() override {
    ASSERT_TRUE(board) << board.error().message;
    ASSERT_TRUE(function.control({.request_type = 0, .request = 9, .value = 1}, {}));
  }

  ControlAnswer get(std::uint8_t id) {
    return function.control({.request_type = 0xA1,
                             .request = 1,
                             .value = static_cast<std::uint16_t>(0x0300 + id),
                             .index = 1,
                             .length = protocol::kReportBytes},
                            {});
  }
  ControlAnswer set(const Report& report) {
    return function.control(
        {.request_type = 0x21,
         .request = 9,
         .value = static_cast<std::uint16_t>(0x0300 + std::to_integer<int>(report[0])),
         .index = 1,
         .length = protocol::kReportBytes},
        report);
  }
  template <class Content>
  static Report packed(const Content& content) {
    Report report{static_cast<std::byte>(Content::kId)};
    protocol::store(content, std::span(report).subspan(1).template first<Content::kBytes>());
    return report;
  }
  /// The next event that the board sends by itself; Status reports come as well, as the state
  /// changes. A poll is 2,000 quiet clocks, and a self-test takes far fewer than all of them.
  std::optional<JournalCode> event(int polls = 2000) {
    Report report{};
    std::size_t given = 0;
    for (int i = 0; i < polls; ++i) {
      const TransferState state = function.interrupt_in(report, given);
      if (state == TransferState::kWaiting) continue;
      EXPECT_EQ(state, TransferState::kDone);
      EXPECT_EQ(given, report.size());
      if (report[0] == static_cast<std::byte>(protocol::StatusReport::kId)) continue;
      EXPECT_EQ(report[0], static_cast<std::byte>(protocol::EventReport::kId));
      return static_cast<JournalCode>(report[1]);
    }
    return std::nullopt;
  }

  Result<VirtualBoard> board = make_virtual_board({.core = "sim"});
  UsbFunction function{*board->endpoint, {.input = board->input}};
};

TEST_F(SimulatedBoard, FeatureAndInputReportsAreTheFirmwares) {
  EXPECT_EQ(event(), JournalCode::kStarted);
  const auto identity = get(protocol::IdentityReport::kId).value_or(std::vector<std::byte>{});
  ASSERT_EQ(identity.size(), protocol::kReportBytes);
  EXPECT_EQ(identity[1], static_cast<std::byte>(protocol::kVersion));
  EXPECT_FALSE(get(99));

  const protocol::ControlReport control{.idle_clocks = 777, .log = 1};
  ASSERT_TRUE(set(packed(control)));
  auto expected = std::vector<std::byte>(protocol::kReportBytes);
  std::ranges::copy(packed(control), expected.begin());
  EXPECT_EQ(get(protocol::ControlReport::kId), expected);
  EXPECT_FALSE(set(packed(protocol::ControlReport{.idle_clocks = 0}))) << "refused";

  // An output report through the interrupt pipe; its end comes by itself, and once.
  const protocol::CommandReport self_test{
      .command = static_cast<std::uint8_t>(protocol::BoardCommand::kSelfTest), .reserved = {}};
  ASSERT_EQ(function.interrupt_out(packed(self_test)), TransferState::kDone);
  EXPECT_EQ(event(), JournalCode::kSelfTestPassed);
  EXPECT_EQ(event(5), std::nullopt);
}

/// Loads the image through the device usb and compares all answers with seq's; returns how often an
/// image was sent.
std::uint64_t right_answers(UsbFunction& function, const Traced& traced) {
  fake::bus().plug_in(function);
  auto device = open_device({.name = "usb"});
  EXPECT_TRUE(device) << device.error().message;
  if (!device) return ~std::uint64_t{0};
  const auto loaded = (*device)->load(traced.image);
  EXPECT_TRUE(loaded) << loaded.error().message;
  const std::vector<Hit> hits = contract::trace(**device, traced.segments, Query::kClosestHit);
  const auto bits = [](double x) { return std::bit_cast<std::uint64_t>(x); };
  for (std::size_t i = 0; i < hits.size(); ++i) {
    EXPECT_EQ(hits[i].id, traced.right[i].id) << i;
    EXPECT_EQ(bits(hits[i].t), bits(traced.right[i].t)) << i;
  }
  EXPECT_EQ((*device)->counters()->frames_retried, 0U);
  return (*device)->counters()->uploads;
}

TEST_F(SimulatedBoard, TracesForTheDeviceUsb) {
  EXPECT_EQ(right_answers(function, make_traced(contract::awkward_scene(71))), 1U);
}

TEST(SimulatedBoardWithFlash, HasItsImageWhenItIsPluggedIn) {
  const Traced traced = make_traced(random_scene(40, 3, 0.6F));
  const auto flash = flash_image(traced.image, board_capabilities());
  ASSERT_TRUE(flash);
  const auto board = make_virtual_board({.core = "sim", .flash = *flash});
  ASSERT_TRUE(board) << board.error().message;
  UsbFunction function(*board->endpoint, {.input = board->input});
  ASSERT_TRUE(function.control({.request_type = 0, .request = 9, .value = 1}, {}));
  // It hears the host at once: while it boots it would not.
  std::vector<std::byte> frame;
  ASSERT_TRUE(append_frame(frame, protocol::FrameType::kNoOp, protocol::Layout::kNone, 1, {}));
  ASSERT_EQ(function.bulk_out(frame), TransferState::kDone);
  std::array<std::byte, 512> answer{};
  std::size_t given = 0;
  EXPECT_EQ(function.bulk_in(answer, given, {}), TransferState::kDone);
  EXPECT_EQ(given, frame.size());
  EXPECT_EQ(right_answers(function, traced), 0U);
}

}  // namespace
}  // namespace gridrt
