// The link to a board on USB: frames on two bulk pipes (libusb), reports on HID (hidraw).
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "hal/error.hpp"
#include "hal/transport.hpp"

namespace gridrt {

/// A board that the computer sees.
struct UsbBoard {
  std::string serial;         ///< empty if it has none
  std::string product;        ///< its product string
  std::string port;           ///< bus and ports as in "1-2.4": where it is plugged in
  std::string device_node;    ///< such as /dev/bus/usb/001/004
  std::string hid_node;       ///< such as /dev/hidraw0; empty if the kernel made none
  std::string trouble;        ///< why this program could not use it; empty: it could
  std::uint16_t release = 0;  ///< bcdDevice
};

/// How to open a board, and what it may take.
struct UsbOptions {
  std::string serial = {};                    ///< empty: the only board there is
  bool frames = true;                         ///< claim the bulk pipes; reports work without
  std::size_t transfers = 16;                 ///< in flight in each direction, >= 1
  std::size_t transfer_bytes = 65536;         ///< each, a multiple of 512
  std::chrono::milliseconds patience{10000};  ///< longest time in which send() gets rid of
                                              ///< no byte
  std::size_t most_early_bytes = std::size_t{1} << 28U;  ///< that a board may say before the host
                                                         ///< asks: more is an error
};

/// Whether this build has libusb and hidapi.
bool usb_is_built_in();

/// The boards that there are. Errors: kUnsupported without libusb and hidapi, kTransport if the
/// computer's USB cannot be looked at.
Result<std::vector<UsbBoard>> list_usb_boards();

/// Opens a board. Errors: kUnsupported (not built in; not a GridRT board by its descriptors),
/// kTransport (no board, no permission, in use by another program, broken link), kUsage (several
/// boards and no serial). docs/usb.md lists the messages and what to do.
///
/// send() copies the bytes once, into memory of the kernel's where it grants that, and returns
/// while they travel. receive() copies them once, out of such memory. Both, and the reports, may be
/// used by one thread at a time.
Result<std::unique_ptr<Transport>> open_usb(const UsbOptions& options);

}  // namespace gridrt
