// libusb's objects with owners. For the files of this folder only.
#pragma once

#include <memory>

#include <libusb.h>

namespace gridrt {

struct LibusbExit {
  void operator()(libusb_context* context) const { libusb_exit(context); }
};
struct LibusbUnref {
  void operator()(libusb_device* device) const { libusb_unref_device(device); }
};
struct LibusbClose {
  void operator()(libusb_device_handle* handle) const { libusb_close(handle); }
};
struct LibusbFreeTransfer {
  void operator()(libusb_transfer* transfer) const { libusb_free_transfer(transfer); }
};
struct LibusbFreeConfig {
  void operator()(libusb_config_descriptor* config) const { libusb_free_config_descriptor(config); }
};

using LibusbContext = std::unique_ptr<libusb_context, LibusbExit>;
using LibusbDevice = std::unique_ptr<libusb_device, LibusbUnref>;
using LibusbHandle = std::unique_ptr<libusb_device_handle, LibusbClose>;
using LibusbTransfer = std::unique_ptr<libusb_transfer, LibusbFreeTransfer>;
using LibusbConfig = std::unique_ptr<libusb_config_descriptor, LibusbFreeConfig>;

}  // namespace gridrt
