// The driver's end of a simulated cable: a Transport whose bytes and reports are USB packets.
#pragma once

#include <algorithm>
#include <vector>

#include "hal/transport.hpp"
#include "tests/rtl/usb_board_host.hpp"

namespace gridrt::rtl {

class UsbCable final : public Transport {
 public:
  /// `host` has enumerated the device, and must outlive this.
  explicit UsbCable(UsbBoardHost& host) : host_(host) {}

  Result<void> send(std::span<const std::byte> bytes) override {
    for (std::size_t at = 0; at < bytes.size(); at += usb::kBulkPacketHigh) {
      const Bytes packet = host_.packet_at(bytes, at);
      Outcome sent = Outcome::kTimeout;
      for (int i = 0; i < kPatience && sent == Outcome::kTimeout; ++i) {
        sent = host_.write(1, packet, kTries);
        listen(1);  // else a board with answers takes nothing more
      }
      if (sent != Outcome::kDone) return fail(ErrorKind::kTimeout, "bulk OUT takes no packet");
    }
    return {};
  }
  Result<std::size_t> receive(std::span<std::byte> out,
                              std::chrono::milliseconds /*timeout*/) override {
    if (heard_.empty()) listen(kSilence);
    const std::size_t count = std::min(out.size(), heard_.size());
    std::copy_n(heard_.begin(), count, out.begin());
    heard_.erase(heard_.begin(), heard_.begin() + static_cast<std::ptrdiff_t>(count));
    return count;
  }
  Result<void> get_feature(std::uint8_t id, std::span<std::byte> body) override {
    Bytes report;
    if (auto done = told(host_.get_report(id, report)); !done) return done;
    report.resize(std::max(report.size(), body.size() + 1));
    for (std::size_t i = 0; i < body.size(); ++i) body[i] = static_cast<std::byte>(report[i + 1]);
    return {};
  }
  Result<void> set_feature(std::uint8_t id, std::span<const std::byte> body) override {
    Bytes report{id};
    for (const std::byte b : body) report.push_back(std::to_integer<std::uint8_t>(b));
    return told(host_.set_report(report));
  }

 private:
  static constexpr int kTries = 40;       ///< IN or OUT tokens, each some 100 clocks
  static constexpr int kPatience = 1000;  ///< rounds of them
  static constexpr int kSilence = 2000;   ///< tokens until the board counts as silent

  void listen(int tries) {
    Bytes packet;
    while (host_.read(1, packet, tries) == Outcome::kDone && !packet.empty()) {
      for (const std::uint8_t byte : packet) heard_.push_back(static_cast<std::byte>(byte));
    }
  }
  static Result<void> told(Outcome outcome) {
    if (outcome == Outcome::kDone) return {};
    return outcome == Outcome::kStall ? fail(ErrorKind::kUnsupported, "the device stalls a report")
                                      : fail(ErrorKind::kTimeout, "no answer to a report");
  }

  UsbBoardHost& host_;
  std::vector<std::byte> heard_;
};

}  // namespace gridrt::rtl
