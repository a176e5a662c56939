// A USB host at a UTMI device port: line states, packets, transactions with their retries.
// Templates over what ticks, so that it serves the USB block alone and the whole board.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <random>
#include <span>
#include <utility>
#include <vector>

namespace gridrt::rtl {

enum class Pid : std::uint8_t {
  kOut = 0x1,
  kIn = 0x9,
  kSof = 0x5,
  kSetup = 0xD,
  kData0 = 0x3,
  kData1 = 0xB,
  kAck = 0x2,
  kNak = 0xA,
  kStall = 0xE,
  kPing = 0x4,
};

/// Pins of the PHY as the device sees them.
struct Utmi {
  std::uint8_t rx_data = 0;
  bool rx_active = false;
  bool rx_valid = false;
  bool rx_error = false;
  std::uint8_t line_state = 1;  ///< 0: SE0, 1: J, 2: K
  bool tx_ready = true;         ///< the PHY takes the device's byte
  bool tx_valid = false;        ///< of the device
  std::uint8_t tx_data = 0;
};

using Bytes = std::vector<std::uint8_t>;

/// Faults on the cable, in percent of packets.
struct UsbFaults {
  int lose_ours = 0;    ///< a packet of the host never arrives
  int spoil_ours = 0;   ///< a data packet of the host has a wrong bit
  int lose_theirs = 0;  ///< a packet of the device never arrives
};

enum class Outcome { kDone, kStall, kTimeout };

struct Control {
  std::uint8_t type = 0;
  std::uint8_t request = 0;
  std::uint16_t value = 0;
  std::uint16_t index = 0;
  std::uint16_t length = 0;
};

class UsbHost {
 public:
  /// `tick` runs one clock with the pins given and tells what the device drives.
  explicit UsbHost(std::function<void(Utmi&)> tick) : tick_(std::move(tick)) {}

  UsbFaults faults;
  std::uint8_t address = 0;
  /// Counts of what happened.
  int naks = 0;
  int pings = 0;
  int retries = 0;

  void idle(int clocks) {
    for (int i = 0; i < clocks; ++i) step();
  }
  void set_line(std::uint8_t state) { idle_line_ = state; }
  /// SOFs every 125 us while the bus is in use, or silence.
  void set_frames(bool on) { frames_ = on; }

  /// Resets the bus and goes through the chirps; false if the device sends none.
  bool reset_bus() {
    full_speed_ = false;
    const bool chirps = begin_reset();
    for (int i = 0; i < 4; ++i) {
      for (const std::uint8_t state : {std::uint8_t{2}, std::uint8_t{1}}) {
        idle_line_ = state;
        idle(400);
      }
    }
    idle_line_ = 0;
    idle(1000);
    frames_ = true;
    return chirps;
  }
  /// The same as a host that knows full speed only and does not answer the chirp.
  bool reset_bus_at_full_speed() {
    full_speed_ = true;
    const bool chirps = begin_reset();
    idle(3 * kMillisecond);
    idle_line_ = 1;
    idle(1000);
    frames_ = true;
    return chirps;
  }
  /// The host reads from another device on the hub: the token and the ACK are heard here, too.
  void read_from_another() {
    token(Pid::kIn, static_cast<unsigned>(address ^ 1U) | 1U << 7U);
    idle(600);
    handshake(Pid::kAck);
  }

  Outcome control_in(const Control& setup, Bytes& data) {
    data.clear();
    if (auto out = start(setup); out != Outcome::kDone) return out;
    bool toggle = true;
    while (data.size() < setup.length) {
      Bytes packet;
      if (auto out = in(0, toggle, packet, kPatience); out != Outcome::kDone) return out;
      data.insert(data.end(), packet.begin(), packet.end());
      toggle = !toggle;
      if (packet.size() < 64) break;
    }
    bool status = true;
    return out(0, status, {}, kPatience);
  }

  Outcome control_out(const Control& setup, const Bytes& data) {
    if (auto out = start(setup); out != Outcome::kDone) return out;
    bool toggle = true;
    for (std::size_t at = 0; at < data.size(); at += 64) {
      const auto end = std::min(data.size(), at + 64);
      const Bytes packet(data.begin() + static_cast<std::ptrdiff_t>(at),
                         data.begin() + static_cast<std::ptrdiff_t>(end));
      if (auto sent = out(0, toggle, packet, kPatience); sent != Outcome::kDone) return sent;
    }
    Bytes empty;
    bool status = true;
    return in(0, status, empty, kPatience);
  }

  /// Begins a control transfer and leaves it.
  Outcome give_up(const Control& setup) { return start(setup); }

  /// A packet from or to an endpoint other than 0; the data toggle is kept. `patience`: tries.
  Outcome read(int endpoint, Bytes& packet, int patience) {
    bool& toggle = toggles_[static_cast<std::size_t>(endpoint) + 16];
    const Outcome got = in(endpoint, toggle, packet, patience);
    if (got == Outcome::kDone) toggle = !toggle;
    return got;
  }
  Outcome write(int endpoint, const Bytes& packet, int patience = kPatience) {
    return out(endpoint, toggles_[static_cast<std::size_t>(endpoint)], packet, patience);
  }

  // Packets, for hosts that send others than they should.

  static std::uint16_t crc5(unsigned value) {
    unsigned crc = 0x1F;
    for (int i = 0; i < 11; ++i) {
      const unsigned bit = (value >> i ^ crc >> 4) & 1U;
      crc = (crc << 1U & 0x1FU) ^ (bit != 0 ? 0x05U : 0U);
    }
    crc ^= 0x1F;
    unsigned reversed = 0;
    for (int i = 0; i < 5; ++i) reversed |= (crc >> i & 1U) << (4 - i);
    return static_cast<std::uint16_t>(reversed);
  }
  static std::uint16_t crc16(std::span<const std::uint8_t> data) {
    unsigned crc = 0xFFFF;
    for (const std::uint8_t byte : data) {
      crc ^= byte;
      for (int i = 0; i < 8; ++i) crc = crc >> 1U ^ ((crc & 1U) != 0 ? 0xA001U : 0U);
    }
    return static_cast<std::uint16_t>(~crc);
  }
  static std::uint8_t pid_byte(Pid pid) {
    const auto low = static_cast<unsigned>(pid);
    return static_cast<std::uint8_t>(low | (~low & 0xFU) << 4U);
  }
  /// `error_at`: the byte at which the PHY reports an error.
  void send_packet(const Bytes& bytes, std::size_t error_at = ~std::size_t{0}) {
    if (chance(faults.lose_ours)) return idle(kGap);
    sending_ = true;
    pins_.line_state = 1;
    pins_.rx_active = true;
    step();
    for (std::size_t i = 0; i < bytes.size(); ++i) {
      pins_.rx_valid = true;
      pins_.rx_data = bytes[i];
      pins_.rx_error = i == error_at;
      pins_.line_state = static_cast<std::uint8_t>(3 - pins_.line_state);
      step();
      pins_.rx_valid = pins_.rx_error = false;
      for (int clock = 1; clock < byte_clocks(); ++clock) step();
    }
    pins_.rx_active = false;
    pins_.line_state = idle_line_;
    step();
    sending_ = false;
  }
  /// `value`: address and endpoint, or the frame of an SOF; `spoil` goes into the CRC.
  void token(Pid pid, unsigned value, unsigned spoil = 0) {
    const unsigned word = value | (crc5(value) ^ spoil) << 11U;
    send_packet(
        {pid_byte(pid), static_cast<std::uint8_t>(word), static_cast<std::uint8_t>(word >> 8U)});
  }
  /// Whether the device sends at this moment.
  [[nodiscard]] bool is_spoken_to() const { return pins_.tx_valid; }
  /// What the device sends within its time; nothing if it is silent.
  std::optional<Bytes> receive() {
    Bytes bytes;
    const int patience = full_speed_ ? kTurnaround + 10 * kByteAtFullSpeed : kTurnaround;
    for (int i = 0; i < patience && !pins_.tx_valid; ++i) step();
    while (pins_.tx_valid && bytes.size() < 4096) {
      pins_.tx_ready = false;
      for (int i = 1; i < byte_clocks(); ++i) step();
      pins_.tx_ready = true;
      bytes.push_back(pins_.tx_data);
      step();
    }
    idle(kGap);
    if (bytes.empty() || chance(faults.lose_theirs)) return std::nullopt;
    return bytes;
  }

 private:
  static constexpr int kPatience = 20'000;
  static constexpr int kTurnaround = 120;  ///< clocks until a packet of the device begins
  static constexpr int kGap = 20;          ///< clocks between two packets of the host
  static constexpr int kMillisecond = 60'000;
  static constexpr int kByteAtFullSpeed = 40;  ///< clocks

  /// SE0, and the device's K in it.
  bool begin_reset() {
    address = 0;
    toggles_ = {};
    frames_ = false;
    idle_line_ = 0;
    int waited = 0;
    while (!pins_.tx_valid && waited < 10 * kMillisecond) {
      step();
      ++waited;
    }
    while (pins_.tx_valid && waited < 20 * kMillisecond) {
      step();
      ++waited;
    }
    return waited < 20 * kMillisecond;
  }
  [[nodiscard]] int byte_clocks() const { return full_speed_ ? kByteAtFullSpeed : 1; }
  [[nodiscard]] int frame_clocks() const { return full_speed_ ? kMillisecond : kMillisecond / 8; }

  void step() {
    if (!sending_) {
      pins_.rx_active = pins_.rx_valid = false;
      pins_.line_state = pins_.tx_valid ? 2 : idle_line_;
    }
    tick_(pins_);
    ++clocks_;
  }

  bool chance(int percent) { return percent != 0 && static_cast<int>(random_() % 100) < percent; }

  void token_to(int endpoint, Pid pid) {
    if (frames_ && clocks_ - last_frame_ > frame_clocks()) {
      last_frame_ = clocks_;
      token(Pid::kSof, static_cast<unsigned>(frame_++ / 8 & 0x7FF));
      idle(kGap);
    }
    token(pid, address | static_cast<unsigned>(endpoint) << 7U);
  }
  void data_packet(bool toggle, const Bytes& data) {
    idle(kGap);
    Bytes bytes{pid_byte(toggle ? Pid::kData1 : Pid::kData0)};
    bytes.insert(bytes.end(), data.begin(), data.end());
    const std::uint16_t crc = crc16(data);
    bytes.push_back(static_cast<std::uint8_t>(crc));
    bytes.push_back(static_cast<std::uint8_t>(crc >> 8U));
    if (chance(faults.spoil_ours)) bytes[1 + random_() % (bytes.size() - 1)] ^= 0x10;
    send_packet(bytes);
  }
  void handshake(Pid pid) {
    send_packet({pid_byte(pid)});
    idle(kGap);
  }

  static bool is(const std::optional<Bytes>& packet, Pid pid) {
    return packet && packet->size() == 1 && packet->front() == pid_byte(pid);
  }

  Outcome start(const Control& c) {
    const Bytes bytes{c.type,
                      c.request,
                      static_cast<std::uint8_t>(c.value),
                      static_cast<std::uint8_t>(c.value >> 8U),
                      static_cast<std::uint8_t>(c.index),
                      static_cast<std::uint8_t>(c.index >> 8U),
                      static_cast<std::uint8_t>(c.length),
                      static_cast<std::uint8_t>(c.length >> 8U)};
    for (int attempt = 0; attempt < 50; ++attempt) {
      token_to(0, Pid::kSetup);
      data_packet(false, bytes);
      if (is(receive(), Pid::kAck)) return Outcome::kDone;
      ++retries;
    }
    return Outcome::kTimeout;
  }

  Outcome in(int endpoint, bool toggle, Bytes& data, int patience) {
    int silent = 0;
    for (int attempt = 0; attempt < patience && silent < 50; ++attempt) {
      token_to(endpoint, Pid::kIn);
      const auto packet = receive();
      if (is(packet, Pid::kStall)) return Outcome::kStall;
      if (is(packet, Pid::kNak)) {
        ++naks;
        silent = 0;
        idle(60);
        continue;
      }
      const bool whole = packet && packet->size() >= 3 &&
                         crc16(std::span(*packet).subspan(1, packet->size() - 3)) ==
                             ((*packet)[packet->size() - 2] | (*packet)[packet->size() - 1] << 8);
      if (!whole) {
        ++silent;
        ++retries;
        continue;
      }
      handshake(Pid::kAck);
      // The same once more: our ACK was lost.
      if (packet->front() != pid_byte(toggle ? Pid::kData1 : Pid::kData0)) continue;
      data.assign(packet->begin() + 1, packet->end() - 2);
      return Outcome::kDone;
    }
    return Outcome::kTimeout;
  }

  Outcome out(int endpoint, bool& toggle, const Bytes& data, int patience) {
    int silent = 0;
    bool ping = false;
    for (int attempt = 0; attempt < patience && silent < 50; ++attempt) {
      if (ping) {
        ++pings;
        token_to(endpoint, Pid::kPing);
      } else {
        token_to(endpoint, Pid::kOut);
        data_packet(toggle, data);
      }
      const auto packet = receive();
      if (is(packet, Pid::kStall)) return Outcome::kStall;
      if (is(packet, Pid::kNak)) {
        ++naks;
        silent = 0;
        ping = endpoint != 2 && !full_speed_;  // interrupt endpoints do not know it
        idle(60);
        continue;
      }
      if (!is(packet, Pid::kAck)) {
        ++silent;
        ++retries;
        continue;
      }
      if (ping) {
        ping = false;
        continue;
      }
      toggle = !toggle;
      return Outcome::kDone;
    }
    return Outcome::kTimeout;
  }

  std::function<void(Utmi&)> tick_;
  Utmi pins_;
  std::uint8_t idle_line_ = 1;
  bool sending_ = false;
  bool frames_ = false;
  bool full_speed_ = false;
  long clocks_ = 0;
  long last_frame_ = 0;
  long frame_ = 0;
  std::array<bool, 32> toggles_{};
  std::mt19937 random_{11};
};

}  // namespace gridrt::rtl
