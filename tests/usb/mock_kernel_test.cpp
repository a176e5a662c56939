// The device usb with the real libusb and hidapi before a kernel that shows what it should not:
// wrong descriptors, half a board, ioctls that fail. Its unit_usb's schedules of faults run here,
// too.
#include "tests/usb/mock_kernel.hpp"

#include <array>
#include <cerrno>
#include <chrono>
#include <map>
#include <random>
#include <string>

#include <gtest/gtest.h>

#include "gridrt_usb.hpp"
#include "hal/usb/usb.hpp"
#include "host/driver/device.hpp"
#include "tests/unit/usb_board.hpp"

namespace gridrt {
namespace {

using fake::mock_faults;

class MockKernel : public testing::Test {
 protected:
  void SetUp() override { mock_faults() = {}; }
  void TearDown() override {
    EXPECT_EQ(fake::bus().counts.open, 0U);
    mock_faults() = {};
  }
  void plug_in() { fake::bus().plug_in(function); }
  static Error refusal() {
    const auto device = open_device({.name = "usb", .timeout_ms = 200});
    EXPECT_FALSE(device);
    return device ? Error{} : device.error();
  }

  std::unique_ptr<Endpoint> board = fake::software_board(std::chrono::milliseconds(50));
  UsbFunction function{*board};
};

TEST_F(MockKernel, ABoardIsListedOpenedAndUnplugged) {
  plug_in();
  const auto boards = list_usb_boards();
  ASSERT_TRUE(boards) << boards.error().message;
  ASSERT_EQ(boards->size(), 1U);
  EXPECT_EQ(boards->front().port, "1-1");
  EXPECT_EQ(boards->front().serial, "mock-1");
  EXPECT_EQ(boards->front().device_node, "/dev/bus/usb/001/002");
  EXPECT_EQ(boards->front().hid_node, "/dev/hidraw0");
  EXPECT_EQ(boards->front().trouble, "");
  {
    auto device = open_device({.name = "usb:mock-1"});
    ASSERT_TRUE(device) << device.error().message;
    EXPECT_EQ((*device)->capabilities().pes, 4);
    fake::bus().faults.unplug = 0;
    const auto counters = (*device)->counters();
    ASSERT_FALSE(counters);
    EXPECT_NE(counters.error().message.find("unplugged"), std::string::npos)
        << counters.error().message;
  }
  EXPECT_EQ(list_usb_boards()->size(), 0U);
  EXPECT_NE(refusal().message.find("no GridRT board is plugged in"), std::string::npos);
}

TEST_F(MockKernel, HalfABoardIsNamedForWhatIsMissing) {
  mock_faults().configured = false;
  plug_in();
  EXPECT_NE(refusal().message.find("it has no active configuration"), std::string::npos);
  mock_faults() = {.hidraw = false};
  plug_in();
  EXPECT_NE(list_usb_boards()->front().trouble.find("no hidraw node"), std::string::npos);
  mock_faults() = {};
  plug_in();
  fake::bus().claimed_elsewhere = true;
  EXPECT_NE(refusal().message.find("another program is using the board"), std::string::npos);
}

TEST_F(MockKernel, AWrongDescriptorIsRefusedOrHarmless) {
  std::mt19937_64 random(7);
  const std::size_t size = std::size(usb::kConfigurationHighDescriptor);
  int refused = 0;
  constexpr int kSeeds = 60;
  for (int seed = 0; seed < kSeeds; ++seed) {
    mock_faults() = {};
    if (seed % 3 == 0) {
      mock_faults().config_bytes = random() % size;
    } else {
      mock_faults().wrong_byte = random() % size;
      mock_faults().wrong_bits = static_cast<std::uint8_t>(1 + random() % 255);
    }
    plug_in();
    ASSERT_TRUE(list_usb_boards());
    const auto device = open_device({.name = "usb", .timeout_ms = 200});
    if (device) continue;
    ++refused;
    EXPECT_TRUE(device.error().kind == ErrorKind::kUnsupported ||
                device.error().kind == ErrorKind::kTransport)
        << seed << ": " << device.error().message;
    EXPECT_FALSE(device.error().message.empty());
  }
  EXPECT_GT(refused, kSeeds / 4);
  EXPECT_LT(refused, kSeeds);
  RecordProperty("refused", refused);
}

TEST_F(MockKernel, AnIoctlThatFailsIsOneClearErrorOrNothing) {
  constexpr std::array kCodes{EIO, ENOMEM, EPROTO, ENODEV, EINVAL, ETIMEDOUT, EPERM, EBUSY};
  std::mt19937_64 random(8);
  std::map<ErrorKind, int> errors;
  constexpr int kSeeds = 150;
  for (int seed = 0; seed < kSeeds; ++seed) {
    mock_faults() = {};
    mock_faults().fail_call = 1 + random() % 40;
    mock_faults().fail_with = kCodes[random() % kCodes.size()];
    plug_in();
    const auto start = std::chrono::steady_clock::now();
    const auto device = open_device({.name = "usb", .timeout_ms = 200});
    EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(5)) << seed;
    if (device) continue;
    ++errors[device.error().kind];
    EXPECT_FALSE(device.error().message.empty());
    EXPECT_TRUE(device.error().kind == ErrorKind::kTransport ||
                device.error().kind == ErrorKind::kTimeout)
        << seed << ": " << device.error().message;
  }
  EXPECT_GT(errors[ErrorKind::kTransport], kSeeds / 4);
}

}  // namespace
}  // namespace gridrt
