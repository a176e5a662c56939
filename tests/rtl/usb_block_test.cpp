// The board's USB block against a USB host: real packets at a UTMI port on one side, a board in
// software behind the mailbox and the streams on the other.
#include <algorithm>

#include <Vgridrt_usb.h>
#include <gtest/gtest.h>

#include "tests/rtl/usb_block_bench.hpp"

namespace gridrt::rtl {
namespace {

using protocol::SelfTestState;

using Bench = UsbBlockBench<Vgridrt_usb, UtmiPhy>;

TEST(UsbBlock, EnumeratesAtHighSpeedWithTheProtocolsDescriptors) {
  Bench bench;
  ASSERT_TRUE(bench.host.enumerate());
  EXPECT_EQ(bench.pins().speed_o, 0);
  expect_descriptors(bench.host, "SIM0");
}

TEST(UsbBlock, ReportsPassThroughTheMailbox) {
  Bench bench;
  ASSERT_TRUE(bench.host.enumerate());
  Bytes report;
  ASSERT_EQ(bench.host.get_report(protocol::IdentityReport::kId, report), Outcome::kDone);
  ASSERT_EQ(report.size(), 64U);
  EXPECT_EQ(report[0], protocol::IdentityReport::kId);
  EXPECT_EQ(report[1], protocol::kVersion);
  EXPECT_EQ(report[37], 'S');     // of the serial number
  EXPECT_GT(bench.host.naks, 0);  // firmware took its time
  ASSERT_EQ(bench.host.get_report(protocol::StatusReport::kId, report, 5), Outcome::kDone);
  EXPECT_EQ(report.size(), 5U);
  EXPECT_EQ(bench.host.get_report(200, report), Outcome::kStall);
  EXPECT_EQ(bench.host.self_test(), SelfTestState::kNever);
  ASSERT_EQ(bench.host.command(protocol::BoardCommand::kSelfTest), Outcome::kDone);
  EXPECT_EQ(bench.host.self_test(), SelfTestState::kPassed);
  EXPECT_EQ(bench.host.set_report({protocol::ResetReport::kId, 1, 2, 3, 4}), Outcome::kStall);
  EXPECT_EQ(bench.host.set_report({protocol::ResetReport::kId, 'R', 'E', 'S', 'T'}),
            Outcome::kDone);
  EXPECT_EQ(bench.host.control_out({0x21, 10, 0, usb::kHidInterface, 0}, {}), Outcome::kDone);
  EXPECT_EQ(bench.host.control_in({0xA1, 3, 0, usb::kHidInterface, 1}, report), Outcome::kStall);
  // More than a report has: refused, not written anywhere.
  EXPECT_EQ(bench.host.control_out({0x21, 9, 0x305, usb::kHidInterface, 80}, Bytes(80)),
            Outcome::kStall);
  EXPECT_EQ(bench.host.control_out({0x21, 9, 0x305, usb::kHidInterface, 1}, Bytes(1)),
            Outcome::kStall);
  ASSERT_EQ(bench.host.get_report(protocol::StatusReport::kId, report), Outcome::kDone);
}

TEST(UsbBlock, FramesAndHitsAreTheSameBytesAsWithoutUsb) {
  Bench bench;
  ASSERT_TRUE(bench.host.enumerate());
  for (int round = 0; round < 2; ++round) {
    EXPECT_EQ(bench.host.exchange(test_frames(), test_answers().size()), test_answers());
  }
  EXPECT_LE(bench.host.largest(), 512U);
  // A board that takes nothing is NAKed and PINGed until it does.
  bench.pause_bulk(true);
  const int pings = bench.host.pings;
  Bytes packet(512);
  int taken = 0;
  while (taken < 10 && bench.host.write(1, packet, 40) == Outcome::kDone) ++taken;
  EXPECT_LT(taken, 4);
  EXPECT_GT(bench.host.pings, pings + 10);
  bench.pause_bulk(false);
  EXPECT_EQ(bench.host.write(1, packet), Outcome::kDone);
}

TEST(UsbBlock, LostAndSpoiltPacketsChangeNothing) {
  Bench bench;
  ASSERT_TRUE(bench.host.enumerate());
  bench.host.faults = {.lose_ours = 6, .spoil_ours = 6, .lose_theirs = 6};
  for (int round = 0; round < 6; ++round) {
    ASSERT_EQ(bench.host.exchange(test_frames(), test_answers().size()), test_answers()) << round;
    EXPECT_EQ(bench.host.report<protocol::CapabilitiesReport>(), board_capabilities());
    ASSERT_EQ(bench.host.set_report({protocol::ResetReport::kId, 'R', 'E', 'S', 'T'}),
              Outcome::kDone);
  }
  EXPECT_GT(bench.host.retries, 50);
}

TEST(UsbBlock, EnumerationBearsLostPackets) {
  Bench bench;
  ASSERT_TRUE(bench.host.enumerate());
  bench.host.faults = {.lose_ours = 12, .spoil_ours = 6, .lose_theirs = 12};
  for (int round = 0; round < 10; ++round) {
    expect_descriptors(bench.host, "SIM0");
    ASSERT_EQ(bench.host.control_out({0x00, 9, usb::kConfiguration, 0, 0}, {}), Outcome::kDone);
    Bytes data;
    ASSERT_EQ(bench.host.control_in({0x80, 8, 0, 0, 1}, data), Outcome::kDone);
    EXPECT_EQ(data, Bytes{usb::kConfiguration}) << round;
    ASSERT_EQ(bench.host.control_out({0x00, 9, 0, 0, 0}, {}), Outcome::kDone);
    ASSERT_EQ(bench.host.control_in({0x80, 8, 0, 0, 1}, data), Outcome::kDone);
    EXPECT_EQ(data, Bytes{0}) << round;
  }
  EXPECT_GT(bench.host.retries, 200);
}

TEST(UsbBlock, WhatTheHostSaysToOthersIsNotHeard) {
  Bench bench;
  ASSERT_TRUE(bench.host.enumerate());
  // Every answer is lost on the cable at first, and then another device has the word.
  const auto frames = test_frames();
  for (std::size_t at = 0; at < frames.size(); at += 512) {
    Bytes packet;
    for (const std::byte byte :
         frames.subspan(at).first(std::min<std::size_t>(512, frames.size() - at))) {
      packet.push_back(std::to_integer<std::uint8_t>(byte));
    }
    ASSERT_EQ(bench.host.write(1, packet), Outcome::kDone);
  }
  bench.host.idle(20'000);
  bench.host.faults.lose_theirs = 100;
  for (int i = 0; i < 3; ++i) {
    Bytes packet;
    EXPECT_EQ(bench.host.read(1, packet, 1), Outcome::kTimeout);
    bench.host.read_from_another();
  }
  bench.host.faults = {};
  EXPECT_EQ(bench.host.exchange({}, test_answers().size()), test_answers());
}

TEST(UsbBlock, WorksAtFullSpeed) {
  Bench bench;
  ASSERT_TRUE(bench.host.enumerate_at_full_speed());
  EXPECT_EQ(bench.pins().speed_o, 1);
  expect_descriptors(bench.host, "SIM0", true);
  EXPECT_EQ(bench.host.report<protocol::CapabilitiesReport>(), board_capabilities());
  EXPECT_EQ(bench.host.exchange(test_frames(), test_answers().size()), test_answers());
  EXPECT_EQ(bench.host.largest(), 63U);  // each packet ends a transfer
  ASSERT_TRUE(bench.host.enumerate());
  EXPECT_EQ(bench.pins().speed_o, 0);
  expect_descriptors(bench.host, "SIM0");
  EXPECT_EQ(bench.host.exchange(test_frames(), test_answers().size()), test_answers());
}

TEST(UsbBlock, InterruptEndpointsCarryReportsBothWays) {
  Bench bench;
  ASSERT_TRUE(bench.host.enumerate());
  Bytes report;
  ASSERT_EQ(bench.host.read(2, report, 500), Outcome::kDone);
  ASSERT_EQ(report.size(), 64U);
  EXPECT_EQ(report[0], protocol::EventReport::kId);
  EXPECT_EQ(report[1], static_cast<std::uint8_t>(protocol::JournalCode::kStarted));
  Bytes command(64);
  command[0] = protocol::CommandReport::kId;
  command[1] = static_cast<std::uint8_t>(protocol::BoardCommand::kSelfTest);
  ASSERT_EQ(bench.host.write(2, command), Outcome::kDone);
  command[1] = 77;  // nonsense is dropped
  ASSERT_EQ(bench.host.write(2, command), Outcome::kDone);
  EXPECT_EQ(bench.host.self_test(), SelfTestState::kPassed);
  bool told = false;
  for (int i = 0; i < 5 && !told; ++i) {
    if (bench.host.read(2, report, 500) != Outcome::kDone) break;
    told = report[0] == protocol::EventReport::kId &&
           report[1] == static_cast<std::uint8_t>(protocol::JournalCode::kSelfTestPassed);
  }
  EXPECT_TRUE(told);
}

TEST(UsbBlock, SuspendResumeAndResetInTheMiddle) {
  Bench bench;
  ASSERT_TRUE(bench.host.enumerate());
  Bytes report;
  ASSERT_EQ(bench.host.get_report(protocol::StatusReport::kId, report), Outcome::kDone);
  expect_suspend_and_resume(bench.host, [&] { return bench.pins().suspended_o != 0; });
  ASSERT_EQ(bench.host.get_report(protocol::StatusReport::kId, report), Outcome::kDone);
  EXPECT_EQ(bench.host.exchange(test_frames(), test_answers().size()), test_answers());

  // A reset of the bus after an odd number of packets, and in the middle of a frame.
  Bytes packet(512, 7);
  ASSERT_EQ(bench.host.write(1, packet), Outcome::kDone);
  ASSERT_TRUE(bench.host.enumerate());
  ASSERT_EQ(bench.host.set_report({protocol::ResetReport::kId, 'R', 'E', 'S', 'T'}),
            Outcome::kDone);
  EXPECT_EQ(bench.host.exchange(test_frames(), test_answers().size()), test_answers());
}

}  // namespace
}  // namespace gridrt::rtl
