// The board's side of USB: descriptors, requests, halts, reports.
#include <gtest/gtest.h>

#include "gridrt_usb.hpp"
#include "tests/unit/usb_board.hpp"

namespace gridrt {
namespace {

class UsbFunctionTest : public testing::Test {
 protected:
  void SetUp() override { function.control({.request_type = 0, .request = 9, .value = 1}, {}); }

  ControlAnswer get(std::uint8_t type, std::uint16_t value, std::uint16_t index = 0,
                    std::uint16_t length = 4096) {
    return function.control(
        {.request_type = type, .request = 6, .value = value, .index = index, .length = length}, {});
  }

  ControlAnswer endpoint_request(std::uint8_t request, std::uint16_t endpoint) {
    const bool status = request == 0;
    return function.control({.request_type = static_cast<std::uint8_t>(status ? 0x82 : 0x02),
                             .request = request,
                             .index = endpoint,
                             .length = static_cast<std::uint16_t>(status ? 2 : 0)},
                            {});
  }

  std::unique_ptr<Endpoint> board = fake::software_board(std::chrono::milliseconds(0));
  UsbFunction function{*board, {.serial = "abc-1"}};
};

std::vector<std::byte> bytes(std::span<const std::uint8_t> source) {
  const auto view = std::as_bytes(source);
  return {view.begin(), view.end()};
}

TEST_F(UsbFunctionTest, GivesItsDescriptorsAndNoMoreBytesThanAreWanted) {
  EXPECT_EQ(get(0x80, 0x0100), bytes(usb::kDeviceDescriptor));
  EXPECT_EQ(get(0x80, 0x0200), bytes(usb::kConfigurationHighDescriptor));
  EXPECT_EQ(get(0x80, 0x0F00), bytes(usb::kBosDescriptor));
  EXPECT_EQ(get(0x81, 0x2200, 1), bytes(usb::kHidReportDescriptor));
  EXPECT_EQ(get(0x80, 0x0200, 0, 9)->size(), 9U);
  EXPECT_EQ(
      function.control({.request_type = 0xC0, .request = 0x20, .index = 7, .length = 999}, {}),
      bytes(usb::kMicrosoftDescriptor));
  const auto serial = get(0x80, 0x0303, 0x0409);
  ASSERT_TRUE(serial);
  EXPECT_EQ(serial->size(), 12U);
  EXPECT_EQ((*serial)[2], std::byte{'a'});
}

TEST_F(UsbFunctionTest, StallsWhatItDoesNotHave) {
  for (const int value : {0x0101, 0x0201, 0x0306, 0x0400, 0x0500, 0x2200, 0xFF00}) {
    EXPECT_FALSE(get(0x80, static_cast<std::uint16_t>(value))) << value;
  }
  EXPECT_FALSE(get(0x81, 0x2200, 0));  // of the other interface
  EXPECT_FALSE(get(0x81, 0x2200, 7));
  EXPECT_FALSE(
      function.control({.request_type = 0xC0, .request = 0x20, .index = 6, .length = 9}, {}));
  EXPECT_FALSE(function.control({.request_type = 0, .request = 9, .value = 2}, {}));
  EXPECT_FALSE(endpoint_request(3, 0x85));
}

TEST_F(UsbFunctionTest, AHaltedPipeStallsUntilItIsCleared) {
  std::array<std::byte, 64> room{};
  std::size_t given = 0;
  EXPECT_EQ(function.bulk_in(room, given, {}), TransferState::kWaiting);
  ASSERT_TRUE(endpoint_request(3, usb::kBulkIn));
  EXPECT_EQ(endpoint_request(0, usb::kBulkIn)->at(0), std::byte{1});
  EXPECT_EQ(function.bulk_in(room, given, {}), TransferState::kStalled);
  EXPECT_EQ(function.bulk_out(room), TransferState::kDone);
  ASSERT_TRUE(endpoint_request(1, usb::kBulkIn));
  EXPECT_EQ(function.bulk_in(room, given, {}), TransferState::kWaiting);
  function.reset();
  EXPECT_EQ(function.bulk_out(room), TransferState::kStalled) << "not configured";
}

TEST_F(UsbFunctionTest, ReportsCarryTheirIdInFront) {
  const SetupPacket identity{
      .request_type = 0xA1, .request = 1, .value = 0x0301, .index = 1, .length = 64};
  const auto report = function.control(identity, {});
  ASSERT_TRUE(report);
  ASSERT_EQ(report->size(), 64U);
  EXPECT_EQ((*report)[0], std::byte{1});
  EXPECT_EQ((*report)[1], static_cast<std::byte>(protocol::kVersion));
  SetupPacket unknown = identity;
  unknown.value = 0x0363;
  EXPECT_FALSE(function.control(unknown, {}));

  const SetupPacket reset{
      .request_type = 0x21, .request = 9, .value = 0x0305, .index = 1, .length = 64};
  std::vector<std::byte> body(64);
  body[0] = std::byte{5};
  EXPECT_FALSE(function.control(reset, body)) << "without its key";
  protocol::detail::put32(body.data() + 1, protocol::kResetKey);
  EXPECT_TRUE(function.control(reset, body));
  body[0] = std::byte{4};
  EXPECT_FALSE(function.control(reset, body)) << "another id than the request's";
  EXPECT_FALSE(function.control(reset, {}));
}

TEST_F(UsbFunctionTest, TellsItsStatusOnceAChange) {
  std::array<std::byte, 64> room{};
  std::size_t given = 0;
  ASSERT_EQ(function.interrupt_in(room, given), TransferState::kDone);
  EXPECT_EQ(given, 64U);
  EXPECT_EQ(room[0], static_cast<std::byte>(protocol::StatusReport::kId));
  EXPECT_EQ(function.interrupt_in(room, given), TransferState::kWaiting);
  // A frame of an unknown type is an error, which Status tells.
  std::vector<std::byte> frame;
  ASSERT_TRUE(
      append_frame(frame, protocol::FrameType::kCameraRays, protocol::Layout::kNone, 1, {}));
  ASSERT_EQ(function.bulk_out(frame), TransferState::kDone);
  EXPECT_EQ(function.interrupt_in(room, given), TransferState::kDone);
}

}  // namespace
}  // namespace gridrt
