// The USB block with a PHY on one side and a board in software, behind the mailbox and the streams,
// on the other.
#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <span>
#include <type_traits>
#include <vector>

#include <gtest/gtest.h>

#include "firmware/model/board_model.hpp"
#include "firmware/self_test_vectors.hpp"
#include "host/pe/capabilities.hpp"
#include "host/pe/software_device.hpp"
#include "tests/rtl/clocked.hpp"
#include "tests/rtl/ulpi_phy.hpp"
#include "tests/rtl/usb_board_host.hpp"

namespace gridrt::rtl {

inline std::unique_ptr<firmware::BoardModel> make_board() {
  SoftwareDeviceOptions software;
  software.capabilities = board_capabilities();
  software.frame_patience = std::chrono::hours(1);  // its clock is not the simulation's
  firmware::BoardModelOptions options;
  options.serial = "SIM0";
  options.vectors = firmware::kSelfTestVectors;
  return std::make_unique<firmware::BoardModel>(std::make_unique<SoftwareDevice>(software),
                                                options);
}

/// `Model` has the board's side of gridrt_usb's ports, and those of `Phy`.
template <class Model, class Phy>
class UsbBlockBench {
 public:
  UsbBlockBench() : board_(make_board()), host([this](Utmi& bus) { tick(bus); }) {
    phy_.drive(*usb_, Utmi{});
    usb_->rx_ready_i = usb_->tx_valid_i = usb_->answer_valid_i = usb_->event_valid_i = 0;
    usb_.reset();
  }

  Model& pins() { return *usb_; }
  Phy& phy() { return phy_; }
  firmware::BoardModel& board() { return *board_; }
  void pause_bulk(bool on) { paused_ = on; }

 private:
  void tick(Utmi& bus) {
    phy_.drive(*usb_, bus);
    play_board();
    show_bodies();
    take_outputs();
    if constexpr (kLooksBefore) phy_.look(*usb_, bus);
    usb_.tick();
    show_bodies();  // what the device sends may be a byte of them
    if constexpr (!kLooksBefore) phy_.look(*usb_, bus);
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

  /// A UTMI PHY's pins are looked at a clock earlier: the host takes what the device shows next.
  static constexpr bool kLooksBefore = std::is_same_v<Phy, UlpiPhy>;

  Clocked<Model> usb_;
  Phy phy_;
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
inline std::span<const std::byte> test_frames() {
  return std::as_bytes(
      std::span(firmware::kSelfTestVectors.frames, firmware::kSelfTestVectors.frame_words));
}
inline Bytes test_answers() {
  return Bytes(firmware::kSelfTestVectors.answers,
               firmware::kSelfTestVectors.answers + firmware::kSelfTestVectors.answer_bytes);
}

}  // namespace gridrt::rtl
