#include "hal/usb/find.hpp"

#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>

#include <unistd.h>

#include "gridrt_usb.hpp"
#include "hal/usb/messages.hpp"

namespace gridrt {
namespace {

namespace fs = std::filesystem;

constexpr const char* kDevices = "/sys/bus/usb/devices/";
constexpr std::size_t kMostPorts = 7;  ///< hubs in a row, by the USB standard

/// The first line of an attribute in sysfs, which is readable without permission to the device.
std::string attribute(const std::string& port, const char* name) {
  std::ifstream file(kDevices + port + "/" + name);
  std::string line;
  std::getline(file, line);
  return line;
}

std::string port_of(libusb_device* device) {
  std::array<std::uint8_t, kMostPorts> ports{};
  const int count = libusb_get_port_numbers(device, ports.data(), static_cast<int>(ports.size()));
  std::string port = std::to_string(libusb_get_bus_number(device));
  for (int i = 0; i < count; ++i) {
    port += (i == 0 ? '-' : '.') + std::to_string(ports[static_cast<std::size_t>(i)]);
  }
  return port;
}

std::string node_of(libusb_device* device) {
  std::array<char, 64> node{};
  std::snprintf(node.data(), node.size(), "/dev/bus/usb/%03u/%03u", libusb_get_bus_number(device),
                libusb_get_device_address(device));
  return node.data();
}

/// Whether an interface has an endpoint of this address and kind. Where the descriptor's lengths
/// are wrong, libusb gives the number of endpoints that it claims, and none.
bool has_endpoint(const libusb_interface_descriptor& interface, std::uint8_t address, int kind) {
  if (interface.endpoint == nullptr) return false;
  for (int i = 0; i < interface.bNumEndpoints; ++i) {
    const libusb_endpoint_descriptor& end = interface.endpoint[i];
    if (end.bEndpointAddress == address && (end.bmAttributes & 3) == kind) return true;
  }
  return false;
}

const libusb_interface_descriptor* find_interface(const libusb_config_descriptor& config,
                                                  int number) {
  for (int i = 0; i < config.bNumInterfaces; ++i) {
    const libusb_interface& interface = config.interface[i];
    if (interface.num_altsetting > 0 && interface.altsetting[0].bInterfaceNumber == number) {
      return &interface.altsetting[0];
    }
  }
  return nullptr;
}

std::string trouble_of(libusb_device* device, const UsbBoard& board) {
  if (const std::string fault = descriptor_fault(device); !fault.empty()) {
    return usb_error::not_a_board(fault).message;
  }
  if (access(board.device_node.c_str(), R_OK | W_OK) != 0) {
    return usb_error::no_permission(board.device_node).message;
  }
  if (board.hid_node.empty()) return usb_error::no_hid_node(board.port).message;
  if (access(board.hid_node.c_str(), R_OK | W_OK) != 0) {
    return usb_error::no_permission(board.hid_node).message;
  }
  return {};
}

}  // namespace

std::string descriptor_fault(libusb_device* device) {
  libusb_config_descriptor* raw = nullptr;
  if (libusb_get_active_config_descriptor(device, &raw) != LIBUSB_SUCCESS) {
    return "it has no active configuration";
  }
  const LibusbConfig config(raw);
  const auto* bulk = find_interface(*config, usb::kBulkInterface);
  if (bulk == nullptr || bulk->bInterfaceClass != LIBUSB_CLASS_VENDOR_SPEC ||
      !has_endpoint(*bulk, usb::kBulkOut, LIBUSB_TRANSFER_TYPE_BULK) ||
      !has_endpoint(*bulk, usb::kBulkIn, LIBUSB_TRANSFER_TYPE_BULK)) {
    return "it has no interface for frames";
  }
  const auto* hid = find_interface(*config, usb::kHidInterface);
  if (hid == nullptr || hid->bInterfaceClass != LIBUSB_CLASS_HID ||
      !has_endpoint(*hid, usb::kInterruptIn, LIBUSB_TRANSFER_TYPE_INTERRUPT)) {
    return "it has no interface for reports";
  }
  return {};
}

std::string find_hid_node(const std::string& port) {
  const fs::path interface = std::string(kDevices) + port + ":" +
                             std::to_string(usb::kConfiguration) + "." +
                             std::to_string(usb::kHidInterface);
  std::error_code error;
  for (auto at = fs::directory_iterator(interface, error); !error && at != fs::directory_iterator();
       at.increment(error)) {
    std::error_code inner;
    for (auto node = fs::directory_iterator(at->path() / "hidraw", inner);
         !inner && node != fs::directory_iterator(); node.increment(inner)) {
      return "/dev/" + node->path().filename().string();
    }
  }
  return {};
}

bool is_plugged_in(const std::string& port) {
  std::error_code error;
  return fs::exists(kDevices + port, error);
}

Result<std::vector<FoundBoard>> find_boards(libusb_context* context) {
  libusb_device** raw = nullptr;
  const ssize_t count = libusb_get_device_list(context, &raw);
  if (count < 0) {
    return fail(ErrorKind::kTransport,
                std::string("the USB of this computer cannot be looked at: ") +
                    libusb_strerror(static_cast<int>(count)),
                "check that the kernel has USB");
  }
  std::vector<FoundBoard> boards;
  for (ssize_t i = 0; i < count; ++i) {
    libusb_device_descriptor descriptor{};
    if (libusb_get_device_descriptor(raw[i], &descriptor) != LIBUSB_SUCCESS ||
        descriptor.idVendor != usb::kVendorId || descriptor.idProduct != usb::kProductId) {
      continue;
    }
    FoundBoard found{LibusbDevice(libusb_ref_device(raw[i])), {}};
    UsbBoard& board = found.board;
    board.port = port_of(raw[i]);
    board.serial = attribute(board.port, "serial");
    board.product = attribute(board.port, "product");
    board.device_node = node_of(raw[i]);
    board.hid_node = find_hid_node(board.port);
    board.release = descriptor.bcdDevice;
    board.trouble = trouble_of(raw[i], board);
    boards.push_back(std::move(found));
  }
  libusb_free_device_list(raw, 1);
  return boards;
}

}  // namespace gridrt
