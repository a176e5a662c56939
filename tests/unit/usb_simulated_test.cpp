// The virtual board around the simulated RTL: its soft core's firmware answers reports and sends
// its own, and rays go through the host's USB code to the RTL and back.
#include <array>
#include <bit>
#include <cstdlib>
#include <optional>
#include <vector>

#include <gtest/gtest.h>

#include "gridrt_usb.hpp"
#include "host/driver/device.hpp"
#include "host/image/image.hpp"
#include "tests/contract/awkward.hpp"
#include "tests/unit/usb_fake_bus.hpp"
#include "tools/virtual/board.hpp"

namespace gridrt {
namespace {

using protocol::JournalCode;
using Report = std::array<std::byte, protocol::kReportBytes>;

const Scene& scene() {
  static const Scene only = contract::awkward_scene(71);
  return only;
}

std::vector<Segment> rays() {
  ::setenv("GRIDRT_CONTRACT_RAYS", "60", 0);
  return contract::awkward_segments(scene(), kDefaultBits, 72);
}

const Image& image() {
  static const Image only = [] {
    ImageOptions options;
    options.layout = protocol::Layout::kCompact;
    options.grid = glm::ivec3{6};
    options.with_scene = false;
    return build_image(scene(), options).value();
  }();
  return only;
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
  const auto identity = get(protocol::IdentityReport::kId);
  ASSERT_TRUE(identity);
  EXPECT_EQ((*identity)[1], static_cast<std::byte>(protocol::kVersion));
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

TEST_F(SimulatedBoard, TracesForTheDeviceUsb) {
  const std::vector<Segment> segments = rays();
  const auto right = contract::reference(scene(), kDefaultBits, segments, Query::kClosestHit);
  fake::bus().plug_in(function);
  auto device = open_device({.name = "usb"});
  ASSERT_TRUE(device) << device.error().message;
  const auto loaded = (*device)->load(image());
  ASSERT_TRUE(loaded) << loaded.error().message;
  std::vector<Hit> hits(segments.size());
  const auto traced = (*device)->trace(segments, Query::kClosestHit, hits);
  ASSERT_TRUE(traced) << traced.error().message;
  for (std::size_t i = 0; i < hits.size(); ++i) {
    EXPECT_EQ(hits[i].id, right[i].id) << i;
    EXPECT_EQ(std::bit_cast<std::uint64_t>(hits[i].t), std::bit_cast<std::uint64_t>(right[i].t));
  }
  EXPECT_EQ((*device)->counters()->frames_retried, 0U);
}

}  // namespace
}  // namespace gridrt
