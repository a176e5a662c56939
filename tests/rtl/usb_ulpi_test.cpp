// The USB block at ULPI pins: register writes, chirps, packets and the state of the lines through a
// PHY in software.
#include <Vgridrt_usb_at_ulpi.h>
#include <gtest/gtest.h>

#include "tests/rtl/usb_block_bench.hpp"

namespace gridrt::rtl {
namespace {

using Bench = UsbBlockBench<Vgridrt_usb_at_ulpi, UlpiPhy>;

constexpr int kStart = 132'000;  ///< clocks until the device is there

TEST(UsbAtUlpi, EnumeratesAtHighSpeedAndExchangesFrames) {
  Bench bench;
  bench.host.idle(kStart);
  EXPECT_EQ(bench.phy().reg(UlpiPhy::kOtgControl), 0);          // no pull-downs: a device
  EXPECT_EQ(bench.phy().reg(UlpiPhy::kFunctionControl), 0x45);  // full speed, pulled up, awake
  ASSERT_TRUE(bench.host.enumerate());
  EXPECT_EQ(bench.pins().speed_o, 0);
  EXPECT_EQ(bench.phy().reg(UlpiPhy::kFunctionControl), 0x40);  // high speed, awake
  expect_descriptors(bench.host, "SIM0");
  EXPECT_EQ(bench.host.report<protocol::CapabilitiesReport>(), board_capabilities());
  for (int round = 0; round < 2; ++round) {
    EXPECT_EQ(bench.host.exchange(test_frames(), test_answers().size()), test_answers());
  }
  bench.host.faults = {.lose_ours = 6, .spoil_ours = 6, .lose_theirs = 6};
  EXPECT_EQ(bench.host.exchange(test_frames(), test_answers().size()), test_answers());
  bench.host.faults = {};
  expect_suspend_and_resume(bench.host, [&] { return bench.pins().suspended_o != 0; });
  EXPECT_EQ(bench.host.exchange(test_frames(), test_answers().size()), test_answers());
}

}  // namespace
}  // namespace gridrt::rtl
