// The device `usb`: a board, or anything that enumerates as one.
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "hal/usb/usb.hpp"
#include "host/driver/device.hpp"

namespace gridrt {

/// True for "usb" and "usb:SERIAL", whether they are built in or not.
bool is_usb(std::string_view device);

/// Opens the board that "usb" or "usb:SERIAL" names. What an earlier program left in the board and
/// on the way from it is gone before anything is asked. Errors: those of open_usb() and
/// Session::open; kTimeout if the board takes frames and answers none.
Result<std::unique_ptr<Device>> open_usb_device(const DeviceOptions& options, UsbOptions usb = {});

}  // namespace gridrt
