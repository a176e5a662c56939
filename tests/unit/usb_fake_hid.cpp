// hidapi over the UsbFunction of the fake bus.
#include <algorithm>
#include <cerrno>
#include <span>

#include <hidapi.h>

#include "gridrt_usb.hpp"
#include "tests/unit/usb_fake_bus.hpp"

using gridrt::fake::bus;

struct hid_device_ {};

namespace {

constexpr std::uint8_t kGetReport = 1;
constexpr std::uint8_t kSetReport = 9;
constexpr std::uint16_t kFeature = 0x300;

/// True if reports are served now; else errno says why.
bool is_served() {
  errno = bus().is_dead()                                       ? ENODEV
          : bus().counts.transfers >= bus().faults.hang_reports ? ETIMEDOUT
                                                                : 0;
  return errno == 0;
}

std::uint16_t value_of(unsigned char id) { return static_cast<std::uint16_t>(kFeature | id); }

}  // namespace

extern "C" {

hid_device* hid_open_path(const char* /*path*/) {
  ++bus().counts.open;
  static hid_device_ only;
  return &only;
}

void hid_close(hid_device* /*device*/) { --bus().counts.open; }

int hid_get_feature_report(hid_device* /*device*/, unsigned char* data, std::size_t length) {
  if (!is_served()) return -1;
  const auto answer = bus().function->control({.request_type = 0xA1,
                                               .request = kGetReport,
                                               .value = value_of(data[0]),
                                               .index = gridrt::usb::kHidInterface,
                                               .length = static_cast<std::uint16_t>(length)},
                                              {});
  if (!answer) {
    errno = EPIPE;
    return -1;
  }
  std::ranges::copy(*answer, std::as_writable_bytes(std::span(data, length)).begin());
  return static_cast<int>(answer->size());
}

int hid_send_feature_report(hid_device* /*device*/, const unsigned char* data, std::size_t length) {
  if (!is_served()) return -1;
  const auto done = bus().function->control({.request_type = 0x21,
                                             .request = kSetReport,
                                             .value = value_of(data[0]),
                                             .index = gridrt::usb::kHidInterface,
                                             .length = static_cast<std::uint16_t>(length)},
                                            std::as_bytes(std::span(data, length)));
  if (!done) errno = EPIPE;
  return done ? static_cast<int>(length) : -1;
}

int hid_read_timeout(hid_device* /*device*/, unsigned char* data, std::size_t length,
                     int /*milliseconds*/) {
  if (!is_served()) return -1;
  std::size_t given = 0;
  bus().function->interrupt_in(std::as_writable_bytes(std::span(data, length)), given);
  return static_cast<int>(given);
}

int hid_write(hid_device* /*device*/, const unsigned char* data, std::size_t length) {
  if (!is_served()) return -1;
  bus().function->interrupt_out(std::as_bytes(std::span(data, length)));
  return static_cast<int>(length);
}

}  // extern "C"
