// What a host does with the board over USB: enumerates it, reads and writes reports, exchanges
// frames.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "gridrt_protocol.hpp"
#include "gridrt_usb.hpp"
#include "tests/rtl/usb_host.hpp"

namespace gridrt::rtl {

class UsbBoardHost : public UsbHost {
 public:
  using UsbHost::UsbHost;

  /// Resets the bus and gives the device an address and its configuration.
  bool enumerate() {
    idle(1000);
    bulk_packet_ = usb::kBulkPacketHigh;
    return reset_bus() && configure();
  }
  /// The same as a host that knows full speed only.
  bool enumerate_at_full_speed() {
    idle(1000);
    bulk_packet_ = usb::kBulkPacketFull;
    return reset_bus_at_full_speed() && configure();
  }
  Outcome get_report(std::uint8_t id, Bytes& data, std::uint16_t length = 64) {
    return control_in({0xA1, 1, static_cast<std::uint16_t>(0x300 | id), usb::kHidInterface, length},
                      data);
  }
  Outcome set_report(Bytes report) {
    report.resize(64);
    return control_out(
        {0x21, 9, static_cast<std::uint16_t>(0x300 | report[0]), usb::kHidInterface, 64}, report);
  }
  Outcome command(protocol::BoardCommand what) {
    return set_report({protocol::CommandReport::kId, static_cast<std::uint8_t>(what)});
  }
  /// A report as its struct.
  template <class Report>
  Report report() {
    Bytes data;
    EXPECT_EQ(get_report(Report::kId, data), Outcome::kDone);
    data.resize(64);
    Report out;
    protocol::load(std::as_bytes(std::span(data)).subspan(1).template first<Report::kBytes>(), out);
    return out;
  }
  protocol::SelfTestState self_test() {
    return static_cast<protocol::SelfTestState>(report<protocol::SelfTestReport>().state);
  }

  /// The bytes from one on that go into a bulk packet.
  [[nodiscard]] Bytes packet_at(std::span<const std::byte> bytes, std::size_t at) const {
    Bytes packet;
    for (const std::byte b : bytes.subspan(at, std::min(bulk_packet_, bytes.size() - at))) {
      packet.push_back(std::to_integer<std::uint8_t>(b));
    }
    return packet;
  }
  /// Sends bytes over bulk OUT and reads bulk IN meanwhile, until `bytes` have come or it is
  /// silent.
  Bytes exchange(std::span<const std::byte> frames, std::size_t bytes) {
    Bytes got;
    int silent = 0;
    std::size_t sent = 0;
    while ((got.size() < bytes || sent < frames.size()) && silent < 2000) {
      if (sent < frames.size()) {
        const Bytes packet = packet_at(frames, sent);
        if (write(1, packet) != Outcome::kDone) return got;
        sent += packet.size();
      }
      Bytes packet;
      if (read(1, packet, 1) == Outcome::kDone) {
        got.insert(got.end(), packet.begin(), packet.end());
        largest_ = std::max(largest_, packet.size());
      } else {
        ++silent;
      }
    }
    return got;
  }
  /// Bytes of the largest packet that exchange() has read.
  [[nodiscard]] std::size_t largest() const { return largest_; }

 private:
  static constexpr std::uint8_t kAddress = 42;

  bool configure() {
    if (control_out({0x00, 5, kAddress, 0, 0}, {}) != Outcome::kDone) return false;
    address = kAddress;
    return control_out({0x00, 9, usb::kConfiguration, 0, 0}, {}) == Outcome::kDone;
  }

  std::size_t bulk_packet_ = usb::kBulkPacketHigh;
  std::size_t largest_ = 0;
};

template <std::size_t N>
Bytes bytes_of(const std::uint8_t (&data)[N]) {
  return Bytes(data, data + N);
}

/// Reads every descriptor of a device and compares it with the protocol's.
inline void expect_descriptors(UsbHost& host, const std::string& serial, bool full_speed = false) {
  const auto descriptor = [&](std::uint16_t value, const Bytes& expected, std::uint8_t type = 0x80,
                              std::uint16_t index = 0) {
    Bytes data;
    ASSERT_EQ(host.control_in({type, 6, value, index, 255}, data), Outcome::kDone) << value;
    EXPECT_EQ(data, expected) << value;
    ASSERT_EQ(host.control_in({type, 6, value, index, 8}, data), Outcome::kDone);
    EXPECT_EQ(data, Bytes(expected.begin(),
                          expected.begin() + std::min<std::ptrdiff_t>(8, std::ssize(expected))));
  };
  descriptor(0x100, bytes_of(usb::kDeviceDescriptor));
  descriptor(0x200, bytes_of(full_speed ? usb::kConfigurationFullDescriptor
                                        : usb::kConfigurationHighDescriptor));
  descriptor(0x600, bytes_of(usb::kQualifierDescriptor));
  descriptor(0x700, bytes_of(full_speed ? usb::kOtherSpeedHighDescriptor
                                        : usb::kOtherSpeedFullDescriptor));
  descriptor(0xF00, bytes_of(usb::kBosDescriptor));
  descriptor(0x300, bytes_of(usb::kLanguagesDescriptor));
  descriptor(0x302, bytes_of(usb::kProductDescriptor), 0x80, 0x409);
  Bytes text{static_cast<std::uint8_t>(2 + 2 * serial.size()), 3};
  for (const char c : serial) {
    text.push_back(static_cast<std::uint8_t>(c));
    text.push_back(0);
  }
  descriptor(0x303, text, 0x80, 0x409);
  descriptor(0x2200, bytes_of(usb::kHidReportDescriptor), 0x81, usb::kHidInterface);
  Bytes data;
  ASSERT_EQ(host.control_in({0xC0, usb::kMicrosoftRequest, 0, 7, 1024}, data), Outcome::kDone);
  EXPECT_EQ(data, bytes_of(usb::kMicrosoftDescriptor));
  ASSERT_EQ(host.control_in({0x80, 8, 0, 0, 1}, data), Outcome::kDone);
  for (const int kind : {0x500, 0xC00, 0xD00}) {
    EXPECT_EQ(host.control_in({0x80, 6, static_cast<std::uint16_t>(kind), 0, 18}, data),
              Outcome::kStall);
  }
  EXPECT_EQ(host.control_in({0xC0, 0x55, 0, 7, 16}, data), Outcome::kStall);
  descriptor(0x100, bytes_of(usb::kDeviceDescriptor));
}

/// Suspends the bus and wakes it again; `suspended` tells what the device thinks.
template <class Suspended>
void expect_suspend_and_resume(UsbHost& host, Suspended suspended) {
  host.set_frames(false);
  host.idle(183'000);  // 3 ms of silence: back to full speed's termination
  host.set_line(1);
  host.idle(20'000);
  EXPECT_TRUE(suspended());
  host.set_line(2);  // K: resume
  host.idle(2000);
  host.set_line(0);
  host.idle(200);
  host.set_frames(true);
  EXPECT_FALSE(suspended());
}

}  // namespace gridrt::rtl
