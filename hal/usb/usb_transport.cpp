#include "hal/usb/usb_transport.hpp"

#include <algorithm>
#include <utility>

#include "hal/usb/bulk_link.hpp"
#include "hal/usb/find.hpp"
#include "hal/usb/hid_link.hpp"
#include "hal/usb/messages.hpp"

namespace gridrt {
namespace {

Result<LibusbContext> make_context() {
  libusb_context* raw = nullptr;
  const int code = libusb_init(&raw);
  if (code == LIBUSB_SUCCESS) return LibusbContext(raw);
  return fail(ErrorKind::kTransport,
              std::string("the USB of this computer cannot be used: ") + libusb_strerror(code),
              "check that the kernel has USB and that /dev/bus/usb is there");
}

/// The one that is asked for.
Result<FoundBoard> choose(std::vector<FoundBoard> boards, const std::string& serial) {
  std::erase_if(boards, [&](const FoundBoard& found) {
    return !serial.empty() && found.board.serial != serial;
  });
  if (boards.empty()) return std::unexpected(usb_error::no_board(serial));
  if (boards.size() > 1) {
    std::string serials;
    for (const FoundBoard& found : boards) {
      serials += (serials.empty() ? "" : ", ") + found.board.serial + " at " + found.board.port;
    }
    return std::unexpected(usb_error::several_boards(serials));
  }
  return std::move(boards.front());
}

Result<LibusbHandle> open_handle(const FoundBoard& found) {
  libusb_device_handle* raw = nullptr;
  switch (const int code = libusb_open(found.device.get(), &raw)) {
    case LIBUSB_SUCCESS:
      return LibusbHandle(raw);
    case LIBUSB_ERROR_ACCESS:
      return std::unexpected(usb_error::no_permission(found.board.device_node));
    case LIBUSB_ERROR_NO_DEVICE:
      return std::unexpected(usb_error::unplugged());
    case LIBUSB_ERROR_IO:
    case LIBUSB_ERROR_OTHER:
      return std::unexpected(usb_error::asleep(found.board.port));
    default:
      return std::unexpected(
          usb_error::cannot_open(found.board.device_node, libusb_strerror(code)));
  }
}

}  // namespace

struct UsbTransport::Libusb {
  LibusbContext context;
  LibusbHandle handle;
};

UsbTransport::UsbTransport() = default;
UsbTransport::~UsbTransport() = default;

Result<std::unique_ptr<UsbTransport>> UsbTransport::open(const UsbOptions& options) {
  Result<LibusbContext> context = make_context();
  if (!context) return std::unexpected(std::move(context.error()));
  Result<std::vector<FoundBoard>> boards = find_boards(context->get());
  if (!boards) return std::unexpected(std::move(boards.error()));
  Result<FoundBoard> found = choose(std::move(*boards), options.serial);
  if (!found) return std::unexpected(std::move(found.error()));
  if (const std::string fault = descriptor_fault(found->device.get()); !fault.empty()) {
    return std::unexpected(usb_error::not_a_board(fault));
  }
  std::unique_ptr<UsbTransport> link(new UsbTransport);
  link->board_ = found->board;
  link->libusb_ = std::make_unique<Libusb>();
  if (options.frames) {
    Result<LibusbHandle> handle = open_handle(*found);
    if (!handle) return std::unexpected(std::move(handle.error()));
    link->libusb_->handle = std::move(*handle);
    auto frames =
        BulkLink::open(context->get(), link->libusb_->handle.get(), found->board.port, options);
    if (!frames) return std::unexpected(std::move(frames.error()));
    link->frames_ = std::move(*frames);
  }
  auto reports = HidLink::open(found->board.port);
  // libusb's objects end before their context.
  found->device.reset();
  link->libusb_->context = std::move(*context);
  if (!reports) return std::unexpected(std::move(reports.error()));
  link->reports_ = std::move(*reports);
  return link;
}

Result<void> UsbTransport::send(std::span<const std::byte> bytes) {
  if (!frames_) return fail(ErrorKind::kInternal, "this link to the board is for reports only");
  return frames_->send(bytes);
}

Result<std::size_t> UsbTransport::receive(std::span<std::byte> out,
                                          std::chrono::milliseconds timeout) {
  if (!frames_) return fail(ErrorKind::kInternal, "this link to the board is for reports only");
  return frames_->receive(out, timeout);
}

Result<void> UsbTransport::flush() {
  if (!frames_) return fail(ErrorKind::kInternal, "this link to the board is for reports only");
  return frames_->flush();
}

Result<void> UsbTransport::get_feature(std::uint8_t id, std::span<std::byte> body) {
  return reports_->get_feature(id, body);
}

Result<void> UsbTransport::set_feature(std::uint8_t id, std::span<const std::byte> body) {
  return reports_->set_feature(id, body);
}

Result<std::optional<std::uint8_t>> UsbTransport::read_input(std::span<std::byte> body,
                                                             std::chrono::milliseconds timeout) {
  return reports_->read_input(body, timeout);
}

Result<void> UsbTransport::write_output(std::uint8_t id, std::span<const std::byte> body) {
  return reports_->write_output(id, body);
}

bool usb_is_built_in() { return true; }

Result<std::vector<UsbBoard>> list_usb_boards() {
  Result<LibusbContext> context = make_context();
  if (!context) return std::unexpected(std::move(context.error()));
  Result<std::vector<FoundBoard>> found = find_boards(context->get());
  if (!found) return std::unexpected(std::move(found.error()));
  std::vector<UsbBoard> boards;
  for (FoundBoard& one : *found) boards.push_back(std::move(one.board));
  return boards;
}

Result<std::unique_ptr<Transport>> open_usb(const UsbOptions& options) {
  auto link = UsbTransport::open(options);
  if (!link) return std::unexpected(std::move(link.error()));
  return std::unique_ptr<Transport>(std::move(*link));
}

}  // namespace gridrt
