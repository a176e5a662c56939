// A ULPI PHY in software (ULPI 1.1, synchronous mode): the link's pins on one side, what a UTMI
// device would be given on the other.
#pragma once

#include <array>
#include <cstdint>
#include <deque>

#include "tests/rtl/usb_host.hpp"

namespace gridrt::rtl {

class UlpiPhy {
 public:
  static constexpr std::uint8_t kFunctionControl = 0x04;
  static constexpr std::uint8_t kOtgControl = 0x0A;

  UlpiPhy() {
    registers_[kFunctionControl] = 0x41;  // full speed, awake
    registers_[kOtgControl] = 0x06;       // both lines pulled down
  }

  /// What a register holds.
  [[nodiscard]] std::uint8_t reg(std::uint8_t address) const { return registers_[address & 0x3FU]; }

  /// After a clock edge: what the PHY drives, decided by what it has seen before.
  template <class Model>
  void drive(Model& link, const Utmi& bus) {
    if (bus.rx_valid) bytes_.push_back(bus.rx_data);
    dir_ = false;
    next_ = false;
    std::uint8_t data = 0;
    switch (state_) {
      case State::kIdle:
        if (bus.rx_active || !bytes_.empty()) {
          dir_ = next_ = true;  // a clock in which nobody drives; NXT says that a packet begins
          state_ = State::kPacketBegins;
        } else if (lines(bus) != told_ && !link_busy_) {
          dir_ = true;
          state_ = State::kTell;
        }
        break;
      case State::kTell:
        dir_ = true;
        data = status(lines(bus), false);
        state_ = State::kIdle;
        break;
      case State::kPacketBegins:
        dir_ = true;
        data = status(1, true);
        state_ = State::kPacket;
        break;
      case State::kPacket:
        dir_ = true;
        if (!bytes_.empty()) {
          next_ = true;
          data = bytes_.front();
          bytes_.pop_front();
        } else if (bus.rx_active) {
          data = status(1, true);
        } else {
          data = status(lines(bus), false);
          state_ = State::kIdle;
        }
        break;
      case State::kSend:
      case State::kSending:
      case State::kAddress:
      case State::kValue:
        next_ = true;
        break;
      case State::kStop:
        break;
    }
    link.ulpi_dir_i = dir_ ? 1 : 0;
    link.ulpi_nxt_i = next_ ? 1 : 0;
    link.ulpi_data_i = data;
  }

  /// Before the clock edge: what the link drives.
  template <class Model>
  void look(const Model& link, Utmi& bus) {
    const std::uint8_t data = link.ulpi_data_o;
    bus.tx_valid = false;
    link_busy_ = !dir_ && (data != 0 || state_ != State::kIdle);
    if (dir_) return;
    switch (state_) {
      case State::kIdle:
        if (data >> 6U == 1) state_ = State::kSend;
        if (data >> 6U == 2) state_ = State::kAddress;
        break;
      case State::kSend:
        bus.tx_valid = (data & 0xFU) != 0;  // else no packet, but a chirp
        bus.tx_data = static_cast<std::uint8_t>((data & 0xFU) | (~data & 0xFU) << 4U);
        state_ = State::kSending;
        break;
      case State::kSending:
        if (link.ulpi_stp_o != 0) {
          state_ = State::kIdle;
        } else {
          bus.tx_valid = true;
          bus.tx_data = data;
        }
        break;
      case State::kAddress:
        address_ = data & 0x3FU;
        state_ = State::kValue;
        break;
      case State::kValue:
        value_ = data;
        state_ = State::kStop;
        break;
      case State::kStop:
        if (link.ulpi_stp_o != 0) registers_[address_] = value_;
        state_ = State::kIdle;
        break;
      default:
        break;
    }
  }

 private:
  enum class State {
    kIdle,
    kTell,          ///< the state of the lines
    kPacketBegins,  ///< from the host
    kPacket,
    kSend,  ///< the link's command to send, then its bytes
    kSending,
    kAddress,  ///< of a register that is written
    kValue,
    kStop,
  };

  /// Without a pull-up the lines are low.
  [[nodiscard]] std::uint8_t lines(const Utmi& bus) const {
    const bool idle = bus.line_state == 1;
    const bool pulled_up = (registers_[kFunctionControl] & 4U) != 0;
    return idle && !pulled_up ? std::uint8_t{0} : bus.line_state;
  }
  /// An RX CMD: the lines, a good voltage on the cable, whether a packet is coming in.
  std::uint8_t status(std::uint8_t line_state, bool active) {
    told_ = line_state;
    return static_cast<std::uint8_t>(line_state | 3U << 2U | (active ? 1U << 4U : 0U));
  }

  State state_ = State::kIdle;
  bool dir_ = false;
  bool next_ = false;
  bool link_busy_ = false;
  std::uint8_t told_ = 0;
  std::uint8_t address_ = 0;
  std::uint8_t value_ = 0;
  std::deque<std::uint8_t> bytes_;
  std::array<std::uint8_t, 64> registers_{};
};

/// The same for a device at UTMI: the pins as they are.
class UtmiPhy {
 public:
  template <class Model>
  void drive(Model& device, const Utmi& bus) {
    device.utmi_rx_error_i = 0;
    device.utmi_busy_i = 0;
    device.utmi_rx_active_i = bus.rx_active ? 1 : 0;
    device.utmi_rx_valid_i = bus.rx_valid ? 1 : 0;
    device.utmi_rx_data_i = bus.rx_data;
    device.utmi_line_state_i = bus.line_state;
    device.utmi_tx_ready_i = bus.tx_ready ? 1 : 0;
  }
  template <class Model>
  void look(const Model& device, Utmi& bus) {
    bus.tx_valid = device.utmi_tx_valid_o != 0;
    bus.tx_data = device.utmi_tx_data_o;
  }
};

}  // namespace gridrt::rtl
