// Boards among the devices of the computer's USB. For the files of this folder only.
#pragma once

#include <string>
#include <vector>

#include "hal/error.hpp"
#include "hal/usb/libusb.hpp"
#include "hal/usb/usb.hpp"

namespace gridrt {

/// A device with a board's ids.
struct FoundBoard {
  LibusbDevice device;
  UsbBoard board;
};

/// All of them, whether they can be used or not. Errors: kTransport.
Result<std::vector<FoundBoard>> find_boards(libusb_context* context);

/// What is wrong with a device's descriptors; empty: it is a board.
std::string descriptor_fault(libusb_device* device);

/// The hidraw node of a board at `port`; empty if there is none.
std::string find_hid_node(const std::string& port);

/// Whether something is plugged in at `port`.
bool is_plugged_in(const std::string& port);

}  // namespace gridrt
