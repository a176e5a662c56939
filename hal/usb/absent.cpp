// In the place of the device `usb` where libusb or hidapi was not found.
#include "hal/usb/usb.hpp"

namespace gridrt {
namespace {

std::unexpected<Error> not_built_in() {
  return fail(ErrorKind::kUnsupported,
              "device 'usb' is not built in: libusb 1.0 or hidapi was not found",
              "install libusb-1.0-0-dev and libhidapi-dev, then configure and build again");
}

}  // namespace

bool usb_is_built_in() { return false; }

Result<std::vector<UsbBoard>> list_usb_boards() { return not_built_in(); }

Result<std::unique_ptr<Transport>> open_usb(const UsbOptions& /*options*/) {
  return not_built_in();
}

}  // namespace gridrt
