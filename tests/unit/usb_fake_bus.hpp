// A bus with a UsbFunction in this process, and what a bad cable, a bad board and people do to
// transfers. It stands behind stand-ins for libusb and hidapi, as far as hal/usb calls them
// (usb_fake_bus.cpp, usb_fake_hid.cpp), or behind a stand-in for the kernel (tests/usb/mock_*).
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <random>
#include <span>
#include <string>

#include "tools/virtual/usb_function.hpp"

struct libusb_transfer;

namespace gridrt::fake {

inline constexpr std::uint64_t kNever = ~std::uint64_t{0};

/// Chances in [0, 1] for each bulk transfer, and transfers after which something lasting happens.
struct Faults {
  double stall = 0.0;           ///< the pipe is halted
  double lost = 0.0;            ///< an error on the wire; the bytes are gone
  double partial = 0.0;         ///< the same after some of the bytes
  double empty = 0.0;           ///< a packet without bytes ends a transfer from the board
  double nak = 0.0;             ///< not yet
  double overflow = 0.0;        ///< the board sends more than the transfer holds
  std::size_t most_in = 0;      ///< transfers from the board end early, after [1, this]; 0: never
  std::uint64_t most = kNever;  ///< stalls, losses, partial ones and overflows in all
  std::uint64_t unplug = kNever;
  bool still_there = false;  ///< as after a computer's sleep: transfers die, the board does not
  std::uint64_t stop_taking = kNever;
  std::uint64_t stop_giving = kNever;
  std::uint64_t hang_reports = kNever;
  std::uint64_t reset = kNever;  ///< another program resets the board
};

/// What has happened.
struct Counts {
  std::uint64_t transfers = 0;
  std::uint64_t stalls = 0, lost = 0, partial = 0, empty = 0, naks = 0, overflows = 0, cut = 0;
  std::uint64_t open = 0;  ///< libusb objects and HID devices that were not given back
};

struct Bus {
  UsbFunction* function = nullptr;
  bool plugged_in = false;
  bool claimed_elsewhere = false;
  bool no_permission = false;
  std::string descriptor_fault = {};
  Faults faults = {};
  Counts counts = {};
  std::mt19937_64 random{1};
  std::deque<libusb_transfer*> out = {};
  std::deque<libusb_transfer*> in = {};

  /// A board on a good cable.
  void plug_in(UsbFunction& board, std::uint64_t seed = 1);

  [[nodiscard]] bool is_dead() const { return counts.transfers >= faults.unplug; }
  bool happens(double chance);
};

/// How a bulk transfer ended.
struct Moved {
  enum class How { kDone, kStall, kError, kOverflow, kGone };
  How how = How::kDone;
  std::size_t bytes = 0;
};
/// A transfer with the bus's faults; nothing: not yet.
std::optional<Moved> move_out(Bus& bus, std::span<const std::byte> bytes);
std::optional<Moved> move_in(Bus& bus, std::span<std::byte> room);

/// What stands before the bus looks at a board that has been plugged in.
void show(const Bus& bus);

/// The only bus: the libraries' functions have no other way to find it.
Bus& bus();

}  // namespace gridrt::fake
