// The board's USB block against a USB host: real packets at a UTMI port on one side, a board in
// software behind the mailbox and the streams on the other.
#include <deque>
#include <memory>

#include <Vgridrt_usb.h>
#include <gtest/gtest.h>

#include "firmware/model/board_model.hpp"
#include "firmware/self_test_vectors.hpp"
#include "host/image/image_frames.hpp"
#include "host/pe/capabilities.hpp"
#include "host/pe/software_device.hpp"
#include "tests/rtl/clocked.hpp"
#include "tests/rtl/usb_board_host.hpp"

namespace gridrt::rtl {
namespace {

using protocol::SelfTestState;

std::unique_ptr<firmware::BoardModel> make_board() {
  SoftwareDeviceOptions software;
  software.capabilities = board_capabilities();
  software.frame_patience = std::chrono::hours(1);  // its clock is not the simulation's
  firmware::BoardModelOptions options;
  options.serial = "SIM0";
  options.vectors = firmware::kSelfTestVectors;
  return std::make_unique<firmware::BoardModel>(std::make_unique<SoftwareDevice>(software),
                                                options);
}

/// The USB block with a PHY on one side and a board on the other.
class Bench {
 public:
  Bench() : board_(make_board()), host([this](Utmi& pins) { tick(pins); }) {
    usb_->utmi_rx_error_i = 0;
    usb_->utmi_rx_active_i = usb_->utmi_rx_valid_i = 0;
    usb_->utmi_tx_ready_i = 1;
    usb_->utmi_busy_i = 0;
    usb_->utmi_line_state_i = 1;
    usb_->rx_ready_i = usb_->tx_valid_i = usb_->answer_valid_i = usb_->event_valid_i = 0;
    usb_.reset();
  }

  Vgridrt_usb& pins() { return *usb_; }
  firmware::BoardModel& board() { return *board_; }
  void pause_bulk(bool on) { paused_ = on; }

 private:
  void tick(Utmi& pins) {
    usb_->utmi_rx_active_i = pins.rx_active ? 1 : 0;
    usb_->utmi_rx_valid_i = pins.rx_valid ? 1 : 0;
    usb_->utmi_rx_data_i = pins.rx_data;
    usb_->utmi_line_state_i = pins.line_state;
    usb_->utmi_tx_ready_i = pins.tx_ready ? 1 : 0;
    play_board();
    show_bodies();
    take_outputs();
    usb_.tick();
    show_bodies();  // what the device sends may be a byte of them
    pins.tx_valid = usb_->utmi_tx_valid_o != 0;
    pins.tx_data = usb_->utmi_tx_data_o;
  }
  /// The mailbox's memories answer without a clock.
  void show_bodies() {
    usb_.settle();
    usb_->body_data_i = body_[usb_->body_address_o];
    usb_->event_data_i = event_ && usb_->event_address_o < event_->body.size()
                             ? std::to_integer<std::uint8_t>(event_->body[usb_->event_address_o])
                             : 0;
    usb_.settle();
  }
  /// Before a clock edge: what the board offers.
  void play_board() {
    ++clocks_;
    if (answers_.empty() && clocks_ % 64 == 0) {
      if (!received_.empty()) {
        EXPECT_TRUE(board_->consume(received_));
        received_.clear();
      }
      std::array<std::byte, 4096> out{};
      const auto got = board_->produce(out, std::chrono::milliseconds(0));
      for (std::size_t i = 0; i < got.value_or(0); ++i) answers_.push_back(out[i]);
    }
    if (!event_ && clocks_ % 1024 == 0) event_ = board_->take_input();
    usb_->event_valid_i = event_ ? 1 : 0;
    usb_->event_id_i = event_ ? event_->id : 0;
    usb_->rx_ready_i = !paused_ && clocks_ % 7 != 0 ? 1 : 0;
    usb_->tx_valid_i = answers_.empty() ? 0 : 1;
    if (!answers_.empty()) usb_->tx_data_i = std::to_integer<std::uint8_t>(answers_.front());
    usb_->answer_valid_i = 0;
    asked_ = usb_->request_valid_o != 0 ? asked_ + 1 : 0;
    constexpr int kFirmwareClocks = 700;
    if (asked_ == kFirmwareClocks) answer();
  }
  void answer() {
    std::array<std::byte, 63> body{};
    const auto id = usb_->request_id_o;
    bool good = false;
    if (usb_->request_set_o != 0) {
      for (std::size_t i = 0; i < body.size(); ++i) body[i] = static_cast<std::byte>(body_[i]);
      good = board_->set_feature(id, std::span(body).first(usb_->request_length_o)).has_value();
    } else {
      good = board_->get_feature(id, body).has_value();
      for (std::size_t i = 0; i < body.size(); ++i) {
        body_[i] = std::to_integer<std::uint8_t>(body[i]);
      }
    }
    usb_->answer_valid_i = 1;
    usb_->answer_good_i = good ? 1 : 0;
    usb_->answer_length_i = 63;
    asked_ = -1;
  }
  /// What moves at the clock edge.
  void take_outputs() {
    if (usb_->body_write_o != 0) body_[usb_->body_address_o] = usb_->body_data_o;
    if (usb_->rx_valid_o != 0 && usb_->rx_ready_i != 0) {
      received_.push_back(static_cast<std::byte>(usb_->rx_data_o));
    }
    if (usb_->tx_valid_i != 0 && usb_->tx_ready_o != 0) answers_.pop_front();
    if (usb_->event_taken_o != 0) event_.reset();
  }

  Clocked<Vgridrt_usb> usb_;
  std::unique_ptr<firmware::BoardModel> board_;
  std::array<std::uint8_t, 64> body_{};
  std::optional<firmware::InputReport> event_;
  std::vector<std::byte> received_;
  std::deque<std::byte> answers_;
  long clocks_ = 0;
  int asked_ = 0;
  bool paused_ = false;

 public:
  UsbBoardHost host;
};

/// The self-test's frames, as some host might send them, and the answers to them.
std::span<const std::byte> test_frames() {
  return std::as_bytes(
      std::span(firmware::kSelfTestVectors.frames, firmware::kSelfTestVectors.frame_words));
}
Bytes test_answers() {
  return Bytes(firmware::kSelfTestVectors.answers,
               firmware::kSelfTestVectors.answers + firmware::kSelfTestVectors.answer_bytes);
}

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
