// A hostile USB host at the device's PHY: packets that no host sends, requests that no driver
// makes, transfers that stop anywhere.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "tests/rtl/hostile_frames.hpp"
#include "tests/rtl/known_image.hpp"
#include "tests/rtl/usb_board_host.hpp"

namespace gridrt::rtl {

/// What was thrown.
struct UsbNoiseCounts {
  std::uint64_t packets = 0;   ///< that no host sends, or spoilt
  std::uint64_t requests = 0;  ///< control transfers of any kind, most of them unfinished
  std::uint64_t frames = 0;    ///< over bulk OUT as it should be
  std::uint64_t reports = 0;   ///< set as they should be
  std::uint64_t answered = 0;  ///< packets that the device sent
  std::uint64_t resets = 0;    ///< of the bus, half of them broken off
};

/// How much harm the noise may do.
enum class UsbHarm {
  kPackets,  ///< USB only: no byte reaches the board as a frame or a report that a host may set
  kFrames,   ///< also frames that load nothing
  kAll,      ///< also images, broken ones, and reports that reset and command
};

class HostileUsb {
 public:
  /// `host` and `image` must outlive this.
  HostileUsb(UsbBoardHost& host, std::uint64_t seed, const KnownImage& image, UsbHarm harm,
             UsbNoiseCounts& counts)
      : host_(host),
        hostile_(seed, image.image, harm == UsbHarm::kAll),
        image_(image),
        harm_(harm),
        counts_(counts) {}

  void make_noise(int actions);

 private:
  void act();
  void random_packet();
  void random_token();
  void random_out();
  void random_in();
  void request();
  void broken_packet();
  void line_noise();
  void reset();
  void frames();
  void report();

  std::uint32_t below(std::uint32_t bound) { return hostile_.below(bound); }
  Bytes bytes(std::size_t count);
  Pid pid();
  unsigned where();
  void data(bool toggle, const Bytes& content, bool spoil);
  void listen();

  UsbBoardHost& host_;
  HostileFrames hostile_;
  const KnownImage& image_;
  UsbHarm harm_;
  UsbNoiseCounts& counts_;
  std::uint8_t rest_ = 0;  // the line between packets: of high speed, or J at full speed
};

}  // namespace gridrt::rtl
