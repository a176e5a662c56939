#include "tests/rtl/hostile_usb.hpp"

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

namespace gridrt::rtl {

namespace {

/// All four bits, tokens and data more often.
constexpr std::array kPids{
    Pid::kOut, Pid::kIn,    Pid::kSof,  Pid::kSetup, Pid::kData0, Pid::kData1, Pid::kAck,
    Pid::kNak, Pid::kStall, Pid::kPing, Pid{0x0},    Pid{0x6},    Pid{0x7},    Pid{0x8},
    Pid{0xC},  Pid{0xF},    Pid::kOut,  Pid::kIn,    Pid::kSetup, Pid::kData0, Pid::kData1};
constexpr std::uint32_t kMostBytes = 1100;  ///< of a packet; the most that is allowed are 1,024

}  // namespace

Bytes HostileUsb::bytes(std::size_t count) {
  Bytes out(count);
  for (std::uint8_t& byte : out) byte = static_cast<std::uint8_t>(below(256));
  return out;
}

Pid HostileUsb::pid() { return kPids.at(below(kPids.size())); }

/// Address and endpoint, most often the device's own.
unsigned HostileUsb::where() {
  const unsigned address = below(8) == 0 ? below(128) : host_.address;
  const unsigned endpoint = below(4) == 0 ? below(16) : below(3);
  return address | endpoint << 7U;
}

void HostileUsb::data(bool toggle, const Bytes& content, bool spoil) {
  host_.idle(static_cast<int>(2 + below(40)));
  Bytes packet{UsbHost::pid_byte(toggle ? Pid::kData1 : Pid::kData0)};
  packet.insert(packet.end(), content.begin(), content.end());
  const unsigned crc = UsbHost::crc16(content) ^ (spoil ? 1U << below(16) : 0U);
  packet.push_back(static_cast<std::uint8_t>(crc));
  packet.push_back(static_cast<std::uint8_t>(crc >> 8U));
  host_.send_packet(packet);
}

/// Takes what the device says, and acknowledges it or not.
void HostileUsb::listen() {
  const bool late = host_.is_spoken_to();  // we spoke ourselves when the packet began
  const auto said = host_.receive();
  if (!said || late) return;
  const std::uint8_t first = said->front();
  if (std::ranges::all_of(*said, [](std::uint8_t byte) { return byte == 0; })) return;  // a chirp
  ++counts_.answered;
  EXPECT_EQ(first, UsbHost::pid_byte(Pid{static_cast<std::uint8_t>(first & 0xFU)}));
  EXPECT_LE(said->size(), 3 + usb::kBulkPacketHigh) << "a packet that is too long";
  if (said->size() > 1 && below(3) != 0) host_.send_packet({UsbHost::pid_byte(Pid::kAck)});
}

void HostileUsb::make_noise(int actions) {
  constexpr int kMostSilent = 25;  // actions; the device has another address, or none
  int silent = 0;
  for (int i = 0; i < actions && !testing::Test::HasFailure(); ++i) {
    const std::uint64_t before = counts_.answered;
    act();
    silent = counts_.answered == before ? silent + 1 : 0;
    if (silent > kMostSilent) {
      reset();
      silent = 0;
    }
    host_.idle(static_cast<int>(1 + below(below(4) == 0 ? 3000 : 60)));
  }
}

void HostileUsb::act() {
  const std::uint32_t kinds = harm_ == UsbHarm::kAll ? 20 : harm_ == UsbHarm::kFrames ? 18 : 15;
  switch (below(kinds)) {
    case 0:
    case 1:
      return random_packet();
    case 2:
    case 3:
      return random_token();
    case 4:
    case 5:
    case 6:
      return random_out();
    case 7:
    case 8:
      return random_in();
    case 9:
    case 10:
    case 11:
      return request();
    case 12:
      return broken_packet();
    case 13:
      return line_noise();
    case 14:
      return below(12) == 0 ? reset() : random_in();
    case 15:
    case 16:
    case 17:
      return frames();
    default:
      return report();
  }
}

void HostileUsb::random_packet() {
  ++counts_.packets;
  Bytes packet = bytes(below(below(6) == 0 ? kMostBytes : 12));
  if (!packet.empty() && below(3) != 0) packet[0] = UsbHost::pid_byte(pid());
  host_.send_packet(packet);
  listen();
}

void HostileUsb::random_token() {
  ++counts_.packets;
  host_.token(pid(), where(), below(3) == 0 ? 1 + below(31) : 0);
  if (below(2) == 0) listen();
}

/// To any endpoint, of any length, with any toggle; what reaches the board is nonsense.
void HostileUsb::random_out() {
  ++counts_.packets;
  constexpr std::array<std::uint32_t, 8> kLengths{0, 1, 8, 63, 64, 65, 512, 513};
  host_.token(below(5) == 0 ? Pid::kPing : Pid::kOut, where());
  if (below(6) == 0) return listen();
  Bytes content = bytes(below(3) == 0 ? below(kMostBytes) : kLengths.at(below(8)));
  // No report that is one by chance.
  if (!content.empty() && content[0] < 32) content[0] = static_cast<std::uint8_t>(content[0] + 32);
  data(below(2) == 0, content, below(4) == 0);
  listen();
}

void HostileUsb::random_in() {
  ++counts_.packets;
  for (std::uint32_t i = 1 + below(4); i > 0; --i) {
    host_.token(Pid::kIn, where());
    listen();
  }
}

/// Any request, or one that there is with a field that is not; then stages that may fit it.
void HostileUsb::request() {
  ++counts_.requests;
  constexpr std::array<std::uint8_t, 8> kTypes{0x00, 0x80, 0x81, 0x21, 0xA1, 0xC0, 0x02, 0x41};
  constexpr std::array<std::uint16_t, 8> kLengths{0, 1, 8, 18, 63, 64, 65, 0xFFFF};
  Bytes setup = bytes(8);
  if (below(4) != 0) setup[0] = kTypes.at(below(8));
  if (below(4) != 0) setup[1] = static_cast<std::uint8_t>(below(13));
  const bool address = (setup[0] & 0x7F) == 0 && setup[1] == 5;
  if (below(2) == 0) {
    constexpr std::array<std::uint8_t, 8> kDescriptors{1, 2, 3, 6, 7, 15, 0x21, 0x22};
    setup[2] = static_cast<std::uint8_t>(below(20));
    setup[3] = kDescriptors.at(below(8));
    setup[4] = static_cast<std::uint8_t>(below(3));
    setup[5] = 0;
  }
  // A report that a host may set is kept for report().
  if (setup[0] == 0x21 && setup[1] == 9) setup[2] = static_cast<std::uint8_t>(setup[2] | 0x20U);
  if (below(3) != 0) {
    const std::uint16_t length = kLengths.at(below(8));
    setup[6] = static_cast<std::uint8_t>(length);
    setup[7] = static_cast<std::uint8_t>(length >> 8U);
  }
  if (below(8) == 0) setup.resize(below(8));
  if (below(8) == 0) setup.resize(9 + below(64));
  host_.token(Pid::kSetup, host_.address | (below(16) == 0 ? below(16) << 7U : 0U));
  data(below(10) == 0, setup, below(10) == 0);
  listen();
  bool toggle = below(8) != 0;
  for (std::uint32_t stages = below(below(8) == 0 ? 30 : 5); stages > 0; --stages) {
    if (below(2) == 0) {
      host_.token(Pid::kIn, unsigned{host_.address});
    } else {
      host_.token(Pid::kOut, unsigned{host_.address});
      Bytes content = bytes(below(3) == 0 ? 0 : below(70));
      if (!content.empty()) content[0] |= 0x20U;
      data(toggle, content, below(8) == 0);
      toggle = !toggle;
    }
    listen();
    if (below(3) == 0) host_.idle(static_cast<int>(below(2000)));  // firmware takes its time
  }
  // A host that changes the address goes on with it, at times.
  if (address && below(2) == 0) host_.address = setup.size() > 2 ? setup[2] & 0x7FU : 0;
}

/// A packet of those above that the PHY finds wrong, or that has no end.
void HostileUsb::broken_packet() {
  ++counts_.packets;
  host_.token(below(2) == 0 ? Pid::kOut : Pid::kSetup, where());
  host_.idle(static_cast<int>(below(30)));
  Bytes packet = bytes(1 + below(80));
  packet[0] = UsbHost::pid_byte(below(2) == 0 ? Pid::kData0 : Pid::kData1);
  host_.send_packet(packet, below(static_cast<std::uint32_t>(packet.size())));
  if (below(2) == 0) listen();
}

/// Other states of the line than packets have, for less than a reset and than a suspend take.
void HostileUsb::line_noise() {
  for (std::uint32_t i = 1 + below(4); i > 0; --i) {
    host_.set_line(static_cast<std::uint8_t>(below(4)));
    host_.idle(static_cast<int>(1 + below(100)));
  }
  host_.set_line(rest_);
}

/// The bus is reset: the device has no address, and here the host may forget that.
void HostileUsb::reset() {
  ++counts_.resets;
  if (below(2) == 0) {
    EXPECT_TRUE(host_.enumerate());
    rest_ = 0;
    return;
  }
  constexpr int kReset = 185'000;  // clocks of silence, 3.1 ms
  host_.set_frames(false);
  host_.set_line(0);
  host_.idle(kReset + static_cast<int>(below(30'000)));
  // The device has a chirp of its own, hears none, and is at full speed.
  rest_ = 1;
  host_.set_line(rest_);
  host_.set_frames(true);
}

void HostileUsb::frames() {
  ++counts_.frames;
  std::vector<std::byte> out;
  switch (below(harm_ == UsbHarm::kAll ? 8 : 4)) {
    case 0:
      out = hostile_.bytes(below(1500));
      break;
    case 1:
      out = hostile_.trace();
      break;
    case 2:
      out = hostile_.any();
      break;
    case 3:
      out = hostile_.promise();
      break;
    case 4:
      out = hostile_.load();
      break;
    case 5:
      out = hostile_.commit();
      break;
    default: {
      out = image_.frames;
      const auto size = static_cast<std::uint32_t>(out.size());
      if (below(2) == 0) out.resize(below(size));
      break;
    }
  }
  // As a driver does it, without reading everything that comes; after a request of ours the device
  // may have no configuration, so that nothing of it arrives.
  constexpr int kPatience = 40;
  for (std::size_t at = 0; at < out.size(); at += usb::kBulkPacketHigh) {
    const Bytes packet = host_.packet_at(out, at);
    if (host_.write(1, packet, kPatience) != Outcome::kDone) return;
    Bytes got;
    if (below(2) == 0) (void)host_.read(1, got, 2);
  }
}

void HostileUsb::report() {
  ++counts_.reports;
  constexpr std::array kIds{protocol::ResetReport::kId, protocol::ControlReport::kId,
                            protocol::CommandReport::kId};
  Bytes report = bytes(64);
  report[0] = kIds.at(below(3));
  if (report[0] == protocol::CommandReport::kId) {
    report[1] = static_cast<std::uint8_t>(below(3));
  } else if (report[0] == protocol::ResetReport::kId && below(2) == 0) {
    protocol::detail::put32(std::as_writable_bytes(std::span(report)).subspan(1).data(),
                            protocol::kResetKey);
  }
  (void)(below(4) == 0 ? host_.write(2, report, 40) : host_.set_report(report));
}

}  // namespace gridrt::rtl
