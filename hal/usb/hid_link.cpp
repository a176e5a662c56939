#include "hal/usb/hid_link.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <thread>
#include <utility>

#include <fcntl.h>
#include <unistd.h>

#include "gridrt_protocol.hpp"
#include "hal/usb/find.hpp"
#include "hal/usb/messages.hpp"

namespace gridrt {
namespace {

using std::chrono::milliseconds;
using Report = std::array<unsigned char, protocol::kReportBytes>;

constexpr milliseconds kNodeAppears(2000);
constexpr milliseconds kUnplugging(300);  ///< until the kernel has noticed

/// The report with its id in front and zeros behind; empty body bytes are no error.
Report packed(std::uint8_t id, std::span<const std::byte> body) {
  Report report{id};
  const std::size_t size = std::min(body.size(), report.size() - 1);
  std::memcpy(report.data() + 1, body.data(), size);
  return report;
}

void unpack(std::span<const unsigned char> report, std::span<std::byte> body) {
  std::ranges::fill(body, std::byte{0});
  const auto bytes = std::as_bytes(report.subspan(std::min<std::size_t>(1, report.size())));
  std::ranges::copy(bytes.first(std::min(bytes.size(), body.size())), body.begin());
}

}  // namespace

Result<std::unique_ptr<HidLink>> HidLink::open(const std::string& port) {
  const auto end = std::chrono::steady_clock::now() + kNodeAppears;
  std::string node = find_hid_node(port);
  while (node.empty() && std::chrono::steady_clock::now() < end) {
    std::this_thread::sleep_for(milliseconds(20));
    node = find_hid_node(port);
  }
  if (node.empty()) return std::unexpected(usb_error::no_hid_node(port));
  hid_device* device = hid_open_path(node.c_str());
  if (device == nullptr) {
    // hidapi has only a text for the reason; ask the kernel for its own.
    const int file = ::open(node.c_str(), O_RDWR | O_CLOEXEC);
    const int code = errno;
    if (file >= 0) ::close(file);
    if (file < 0 && (code == EACCES || code == EPERM)) {
      return std::unexpected(usb_error::no_permission(node));
    }
    return std::unexpected(
        usb_error::cannot_open(node, file < 0 ? std::strerror(code) : "hidapi does not take it"));
  }
  return std::unique_ptr<HidLink>(new HidLink(device, port));
}

Error HidLink::failure(std::uint8_t id, int code, Error if_stalled) const {
  switch (code) {
    case EPIPE:
      return if_stalled;
    case ETIMEDOUT:
      return usb_error::report_timeout(id);
    case ENODEV:
    case ENXIO:
    case ESHUTDOWN:
    case ENOENT:
    case EIO: {
      const auto end = std::chrono::steady_clock::now() + kUnplugging;
      while (is_plugged_in(port_) && std::chrono::steady_clock::now() < end) {
        std::this_thread::sleep_for(milliseconds(10));
      }
      if (!is_plugged_in(port_)) return usb_error::unplugged();
      if (code == EIO) return usb_error::report_failed(id, std::strerror(code));
      return usb_error::interrupted();
    }
    default:
      return usb_error::report_failed(id, std::strerror(code));
  }
}

Result<void> HidLink::get_feature(std::uint8_t id, std::span<std::byte> body) {
  Report report{id};
  errno = 0;
  const int got = hid_get_feature_report(device_.get(), report.data(), report.size());
  if (got < 0) return std::unexpected(failure(id, errno, usb_error::no_report(id)));
  if (got < 1 || report[0] != id) {
    return std::unexpected(usb_error::report_failed(id, "the board answers with another one"));
  }
  unpack(std::span(report).first(std::min<std::size_t>(got, report.size())), body);
  return {};
}

Result<void> HidLink::set_feature(std::uint8_t id, std::span<const std::byte> body) {
  const Report report = packed(id, body);
  errno = 0;
  if (hid_send_feature_report(device_.get(), report.data(), report.size()) >= 0) return {};
  const int code = errno;
  if (code != EPIPE) return std::unexpected(failure(id, code, {}));
  // A stall says no and not why: a report that can be read, or a reset, is one that the board has.
  std::array<std::byte, protocol::kReportBytes> ignored{};
  const bool known = id == protocol::ResetReport::kId || get_feature(id, ignored).has_value();
  return std::unexpected(known ? usb_error::report_refused(id) : usb_error::no_report(id));
}

Result<std::optional<std::uint8_t>> HidLink::read_input(std::span<std::byte> body,
                                                        milliseconds timeout) {
  Report report{};
  errno = 0;
  const int got = hid_read_timeout(device_.get(), report.data(), report.size(),
                                   static_cast<int>(timeout.count()));
  if (got < 0) {
    return std::unexpected(failure(0, errno == 0 ? ENODEV : errno, usb_error::no_report(0)));
  }
  if (got == 0) return std::nullopt;
  unpack(std::span(report).first(static_cast<std::size_t>(got)), body);
  return report[0];
}

Result<void> HidLink::write_output(std::uint8_t id, std::span<const std::byte> body) {
  const Report report = packed(id, body);
  errno = 0;
  if (hid_write(device_.get(), report.data(), report.size()) >= 0) return {};
  return std::unexpected(failure(id, errno, usb_error::report_refused(id)));
}

}  // namespace gridrt
