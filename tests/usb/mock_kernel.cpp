// The kernel's usbfs and hidraw, as far as libusb and hidapi ask them, over the bus of the unit
// tests: umockdev shows a board in sysfs and hands the programs' ioctls to this file. It runs under
// umockdev-wrapper.
#include "tests/usb/mock_kernel.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <deque>
#include <mutex>
#include <span>
#include <string>
#include <vector>

#include <libusb.h>
#include <linux/hidraw.h>
#include <linux/usbdevice_fs.h>
#include <sys/ioctl.h>
#include <umockdev.h>

#include "gridrt_usb.hpp"
#include "tests/unit/usb_fake_bus.hpp"

namespace gridrt::fake {
namespace {

constexpr const char* kNode = "/dev/bus/usb/001/002";
constexpr const char* kHidNode = "/dev/hidraw0";
constexpr const char* kBoard = "/sys/devices/usb1/1-1";
constexpr const char* kInterface = "/sys/devices/usb1/1-1/1-1:1.1";
constexpr const char* kHid = "/sys/devices/usb1/1-1/1-1:1.1/0003:1209:0001.0001";
constexpr const char* kHidraw = "/sys/devices/usb1/1-1/1-1:1.1/0003:1209:0001.0001/hidraw/hidraw0";

struct Kernel {
  UMockdevTestbed* testbed = nullptr;
  UMockdevIoctlBase* handler = nullptr;
  MockFaults faults;
  std::string shown;  ///< what sysfs shows, in umockdev's words; empty: no board
  bool hidraw = false;
  std::deque<usbdevfs_urb*> out, in, done;
  std::mutex mutex;  ///< of all that is here, and of the bus
};

Kernel& kernel() {
  static Kernel only;
  return only;
}

std::string hex(std::span<const std::uint8_t> bytes) {
  constexpr const char* kDigits = "0123456789ABCDEF";
  std::string text;
  for (const std::uint8_t b : bytes) {
    text += kDigits[b >> 4U];
    text += kDigits[b & 15U];
  }
  return text;
}

/// A board with these faults, in umockdev's words.
std::string text_of(const MockFaults& faults) {
  std::vector<std::uint8_t> config(std::begin(usb::kConfigurationHighDescriptor),
                                   std::end(usb::kConfigurationHighDescriptor));
  if (faults.wrong_byte < config.size()) config[faults.wrong_byte] ^= faults.wrong_bits;
  config.resize(std::min(config.size(), faults.config_bytes));
  return "P: /devices/usb1/1-1\nN: bus/usb/001/002\nE: SUBSYSTEM=usb\nE: DEVTYPE=usb_device\n"
         "E: DRIVER=usb\nE: BUSNUM=001\nE: DEVNUM=002\nE: DEVNAME=/dev/bus/usb/001/002\n"
         "A: busnum=1\\n\nA: devnum=2\\n\nA: speed=480\\n\nA: bConfigurationValue=" +
         std::string(faults.configured ? "1" : "") +
         "\\n\nA: serial=mock-1\\n\nA: product=GridRT board\\n\nH: descriptors=" +
         hex(usb::kDeviceDescriptor) + hex(config) +
         "\n\nP: /devices/usb1/1-1/1-1:1.1\nE: SUBSYSTEM=usb\nE: DEVTYPE=usb_interface\n\n"
         "P: /devices/usb1/1-1/1-1:1.1/0003:1209:0001.0001\nE: SUBSYSTEM=hid\n\n" +
         (faults.hidraw ? "P: /devices/usb1/1-1/1-1:1.1/0003:1209:0001.0001/hidraw/hidraw0\n"
                          "N: hidraw0\nE: SUBSYSTEM=hidraw\nE: DEVNAME=/dev/hidraw0\n\n"
                        : "");
}

gboolean on_ioctl(UMockdevIoctlBase* handler, UMockdevIoctlClient* client, void* data);

/// Sysfs and nodes as they are with a board.
void appear(Kernel& k) {
  k.shown = text_of(k.faults);
  k.hidraw = k.faults.hidraw;
  if (k.handler == nullptr) {
    k.handler = umockdev_ioctl_base_new();
    g_signal_connect_after(k.handler, "handle-ioctl", G_CALLBACK(on_ioctl), nullptr);
  }
  GError* error = nullptr;
  umockdev_testbed_attach_ioctl(k.testbed, kNode, k.handler, &error);
  if (k.hidraw) umockdev_testbed_attach_ioctl(k.testbed, kHidNode, k.handler, &error);
  umockdev_testbed_add_from_string(k.testbed, k.shown.c_str(), &error);
  if (error != nullptr) g_error("umockdev: %s", error->message);
}

/// And as they are after it was unplugged. Its open files stay.
void vanish(Kernel& k) {
  GError* error = nullptr;
  if (k.hidraw) {
    umockdev_testbed_uevent(k.testbed, kHidraw, "remove");
    umockdev_testbed_remove_device(k.testbed, kHidraw);
    umockdev_testbed_detach_ioctl(k.testbed, kHidNode, &error);
  }
  umockdev_testbed_remove_device(k.testbed, kHid);
  umockdev_testbed_remove_device(k.testbed, kInterface);
  umockdev_testbed_uevent(k.testbed, kBoard, "remove");
  umockdev_testbed_remove_device(k.testbed, kBoard);
  umockdev_testbed_detach_ioctl(k.testbed, kNode, &error);
  g_clear_error(&error);
  k.shown.clear();
}

void finish(Kernel& k, usbdevfs_urb* urb, int status, std::size_t bytes) {
  urb->status = status;
  urb->actual_length = static_cast<int>(bytes);
  k.done.push_back(urb);
}

int status_of(Moved::How how) {
  switch (how) {
    case Moved::How::kDone:
      return 0;
    case Moved::How::kStall:
      return -EPIPE;
    case Moved::How::kError:
      return -EPROTO;
    case Moved::How::kOverflow:
      return -EOVERFLOW;
    default:
      return -ESHUTDOWN;
  }
}

bool move_one(Kernel& k, std::deque<usbdevfs_urb*>& queue, bool in) {
  if (queue.empty()) return false;
  usbdevfs_urb* urb = queue.front();
  const auto bytes = std::as_writable_bytes(std::span(
      static_cast<std::uint8_t*>(urb->buffer), static_cast<std::size_t>(urb->buffer_length)));
  const auto moved = in ? move_in(bus(), bytes) : move_out(bus(), bytes);
  if (!moved) return false;
  queue.pop_front();
  finish(k, urb, status_of(moved->how), moved->bytes);
  return true;
}

void move_all(Kernel& k) {
  for (bool again = true; again && !bus().is_dead();) {
    again = move_one(k, k.out, false);
    again = move_one(k, k.in, true) || again;
  }
  if (!bus().is_dead()) return;
  for (auto* queue : {&k.out, &k.in}) {
    for (usbdevfs_urb* urb : *queue) finish(k, urb, -ESHUTDOWN, 0);
    queue->clear();
  }
}

/// 0, or the errno that the ioctl ends with. The client is in this process: its pointers are good.
int usbfs(Kernel& k, unsigned long request, void* argument) {
  Bus& b = bus();
  if (request == USBDEVFS_GET_CAPABILITIES) {
    *static_cast<std::uint32_t*>(argument) = USBDEVFS_CAP_ZERO_PACKET |
                                             USBDEVFS_CAP_NO_PACKET_SIZE_LIM |
                                             USBDEVFS_CAP_REAP_AFTER_DISCONNECT;
    return 0;
  }
  if (request == USBDEVFS_REAPURBNDELAY) {
    move_all(k);
    if (k.done.empty()) return b.is_dead() ? ENODEV : EAGAIN;
    *static_cast<void**>(argument) = k.done.front();
    k.done.pop_front();
    --b.counts.open;
    return 0;
  }
  if (request == USBDEVFS_DISCARDURB) {
    auto* urb = static_cast<usbdevfs_urb*>(argument);
    for (auto* queue : {&k.out, &k.in}) {
      if (std::erase(*queue, urb) == 0) continue;
      finish(k, urb, -ENOENT, 0);
      return 0;
    }
    return EINVAL;
  }
  if (request == USBDEVFS_RELEASEINTERFACE) {
    --b.counts.open;
    return b.is_dead() ? ENODEV : 0;
  }
  if (b.is_dead()) return ENODEV;
  ++k.faults.calls;
  if (k.faults.calls == k.faults.fail_call) return k.faults.fail_with;
  switch (request) {
    case USBDEVFS_CLAIMINTERFACE:
      if (b.claimed_elsewhere) return EBUSY;
      ++b.counts.open;
      return 0;
    case USBDEVFS_CLEAR_HALT:
      b.function->control({.request_type = 2,
                           .request = 1,
                           .value = 0,
                           .index = static_cast<std::uint16_t>(*static_cast<unsigned*>(argument))},
                          {});
      return 0;
    case USBDEVFS_SUBMITURB: {
      auto* urb = static_cast<usbdevfs_urb*>(argument);
      (urb->endpoint == usb::kBulkIn ? k.in : k.out).push_back(urb);
      ++b.counts.open;
      return 0;
    }
    default:
      return ENOTTY;
  }
}

/// The same for hidraw; `result` is what a good ioctl returns.
int hidraw(unsigned long request, void* argument, int& result) {
  Bus& b = bus();
  if (b.is_dead()) return ENODEV;
  if (request == HIDIOCGRDESCSIZE) {
    *static_cast<int*>(argument) = static_cast<int>(std::size(usb::kHidReportDescriptor));
    return 0;
  }
  if (request == HIDIOCGRDESC) {
    auto* wanted = static_cast<hidraw_report_descriptor*>(argument);
    std::ranges::copy(usb::kHidReportDescriptor, wanted->value);
    return 0;
  }
  const auto number = _IOC_NR(request);
  if (number != _IOC_NR(HIDIOCGFEATURE(0)) && number != _IOC_NR(HIDIOCSFEATURE(0))) return ENOTTY;
  if (b.counts.transfers >= b.faults.hang_reports) return ETIMEDOUT;
  const bool set = number == _IOC_NR(HIDIOCSFEATURE(0));
  const auto bytes =
      std::as_writable_bytes(std::span(static_cast<std::uint8_t*>(argument), _IOC_SIZE(request)));
  const auto answer = b.function->control(
      {.request_type = static_cast<std::uint8_t>(set ? 0x21 : 0xA1),
       .request = static_cast<std::uint8_t>(set ? 9 : 1),
       .value = static_cast<std::uint16_t>(0x300 | std::to_integer<unsigned>(bytes[0])),
       .index = usb::kHidInterface,
       .length = static_cast<std::uint16_t>(bytes.size())},
      set ? std::span<const std::byte>(bytes) : std::span<const std::byte>{});
  if (!answer) return EPIPE;
  if (!set)
    std::ranges::copy(
        answer->begin(),
        answer->begin() + static_cast<std::ptrdiff_t>(std::min(answer->size(), bytes.size())),
        bytes.begin());
  result = static_cast<int>(set ? bytes.size() : answer->size());
  return 0;
}

gboolean on_ioctl(UMockdevIoctlBase* /*handler*/, UMockdevIoctlClient* client, void* /*data*/) {
  Kernel& k = kernel();
  const std::scoped_lock lock(k.mutex);
  void* argument = nullptr;
  std::memcpy(static_cast<void*>(&argument), umockdev_ioctl_client_get_arg(client)->data,
              sizeof argument);
  const unsigned long request = umockdev_ioctl_client_get_request(client);
  int result = 0;
  const int code = std::strcmp(umockdev_ioctl_client_get_devnode(client), kHidNode) == 0
                       ? hidraw(request, argument, result)
                       : usbfs(k, request, argument);
  Bus& b = bus();
  b.plugged_in = b.plugged_in && (!b.is_dead() || b.faults.still_there);
  if (!k.shown.empty() && !b.plugged_in) vanish(k);
  umockdev_ioctl_client_complete(client, code == 0 ? result : -1, code);
  return TRUE;
}

}  // namespace

MockFaults& mock_faults() { return kernel().faults; }

void show(const Bus& bus) {
  Kernel& k = kernel();
  const std::scoped_lock lock(k.mutex);
  k.out.clear();
  k.in.clear();
  k.done.clear();
  if (bus.plugged_in && k.shown == text_of(k.faults)) return;
  // A testbed has a node of a name once, so each board gets a new one.
  if (k.testbed != nullptr) g_object_unref(k.testbed);
  k.testbed = umockdev_testbed_new();
  k.shown.clear();
  if (bus.plugged_in) appear(k);
}

}  // namespace gridrt::fake

extern "C" {

// umockdev maps the empty file behind a node where the kernel would give memory: the one thing of
// libusb that has to be told apart. A transfer's memory is the program's own then, as with old
// kernels.
unsigned char* LIBUSB_CALL libusb_dev_mem_alloc(libusb_device_handle* /*handle*/,
                                                std::size_t /*length*/) {
  return nullptr;
}

int LIBUSB_CALL libusb_dev_mem_free(libusb_device_handle* /*handle*/, unsigned char* /*buffer*/,
                                    std::size_t /*length*/) {
  return LIBUSB_ERROR_NOT_SUPPORTED;
}

}  // extern "C"
