#include "tests/unit/usb_fake_bus.hpp"

#include <algorithm>
#include <chrono>
#include <span>
#include <thread>

#include <libusb.h>

#include "gridrt_usb.hpp"
#include "hal/usb/find.hpp"

namespace gridrt {
namespace fake {

void show(const Bus& /*bus*/) {}

namespace {

std::span<std::byte> buffer_of(const libusb_transfer& transfer) {
  return std::as_writable_bytes(
      std::span(transfer.buffer, static_cast<std::size_t>(transfer.length)));
}

void finish(libusb_transfer& transfer, libusb_transfer_status status, std::size_t bytes) {
  transfer.status = status;
  transfer.actual_length = static_cast<int>(bytes);
  transfer.callback(&transfer);
}

libusb_transfer_status status_of(Moved::How how) {
  switch (how) {
    case Moved::How::kDone:
      return LIBUSB_TRANSFER_COMPLETED;
    case Moved::How::kStall:
      return LIBUSB_TRANSFER_STALL;
    case Moved::How::kError:
      return LIBUSB_TRANSFER_ERROR;
    case Moved::How::kOverflow:
      return LIBUSB_TRANSFER_OVERFLOW;
    default:
      return LIBUSB_TRANSFER_NO_DEVICE;
  }
}

/// The oldest transfer of a pipe, if it can be moved.
bool move_one(Bus& b, std::deque<libusb_transfer*>& queue, bool in) {
  if (queue.empty()) return false;
  libusb_transfer& transfer = *queue.front();
  const auto moved = in ? move_in(b, buffer_of(transfer)) : move_out(b, buffer_of(transfer));
  if (!moved) return false;
  queue.pop_front();
  finish(transfer, status_of(moved->how), moved->bytes);
  return true;
}

bool bury(Bus& b) {
  bool moved = false;
  for (auto* queue : {&b.out, &b.in}) {
    while (!queue->empty()) {
      libusb_transfer& transfer = *queue->front();
      queue->pop_front();
      finish(transfer, LIBUSB_TRANSFER_NO_DEVICE, 0);
      moved = true;
    }
  }
  return moved;
}

/// Moves all that can be moved; a bus that is slow has more than one transfer under way.
bool move_all(Bus& b) {
  bool moved = false;
  for (bool again = true; again; moved = moved || again) {
    if (b.is_dead()) return bury(b) || moved;
    again = move_one(b, b.out, false);
    again = move_one(b, b.in, true) || again;
  }
  return moved;
}

}  // namespace
}  // namespace fake

// In the place of hal/usb/find.cpp, which looks at the computer.

Result<std::vector<FoundBoard>> find_boards(libusb_context* /*context*/) {
  const fake::Bus& b = fake::bus();
  std::vector<FoundBoard> boards;
  if (!b.plugged_in) return boards;
  FoundBoard found{LibusbDevice(libusb_ref_device(reinterpret_cast<libusb_device*>(&fake::bus()))),
                   {}};
  found.board = {.serial = "fake-1",
                 .product = "GridRT board",
                 .port = "1-1",
                 .device_node = "/dev/bus/usb/001/002",
                 .hid_node = "/dev/hidraw0",
                 .trouble = {},
                 .release = usb::kDeviceRelease};
  boards.push_back(std::move(found));
  return boards;
}

std::string descriptor_fault(libusb_device* /*device*/) { return fake::bus().descriptor_fault; }
std::string find_hid_node(const std::string& /*port*/) { return "/dev/hidraw0"; }
bool is_plugged_in(const std::string& /*port*/) { return fake::bus().plugged_in; }

}  // namespace gridrt

using gridrt::fake::bus;

extern "C" {

int LIBUSB_CALL libusb_init(libusb_context** context) {
  ++bus().counts.open;
  *context = reinterpret_cast<libusb_context*>(&bus());
  return LIBUSB_SUCCESS;
}

void LIBUSB_CALL libusb_exit(libusb_context* /*context*/) { --bus().counts.open; }

libusb_device* LIBUSB_CALL libusb_ref_device(libusb_device* device) {
  ++bus().counts.open;
  return device;
}

void LIBUSB_CALL libusb_unref_device(libusb_device* /*device*/) { --bus().counts.open; }

int LIBUSB_CALL libusb_open(libusb_device* /*device*/, libusb_device_handle** handle) {
  if (bus().no_permission) return LIBUSB_ERROR_ACCESS;
  if (bus().is_dead()) return LIBUSB_ERROR_NO_DEVICE;
  ++bus().counts.open;
  *handle = reinterpret_cast<libusb_device_handle*>(&bus());
  return LIBUSB_SUCCESS;
}

void LIBUSB_CALL libusb_close(libusb_device_handle* /*handle*/) { --bus().counts.open; }

int LIBUSB_CALL libusb_claim_interface(libusb_device_handle* /*handle*/, int /*number*/) {
  if (bus().is_dead()) return LIBUSB_ERROR_NO_DEVICE;
  if (bus().claimed_elsewhere) return LIBUSB_ERROR_BUSY;
  ++bus().counts.open;
  return LIBUSB_SUCCESS;
}

int LIBUSB_CALL libusb_release_interface(libusb_device_handle* /*handle*/, int /*number*/) {
  --bus().counts.open;
  return LIBUSB_SUCCESS;
}

int LIBUSB_CALL libusb_clear_halt(libusb_device_handle* /*handle*/, unsigned char endpoint) {
  if (bus().is_dead()) return LIBUSB_ERROR_NO_DEVICE;
  bus().function->control({.request_type = 2, .request = 1, .value = 0, .index = endpoint}, {});
  return LIBUSB_SUCCESS;
}

// The kernel's memory and this program's in turn.
unsigned char* LIBUSB_CALL libusb_dev_mem_alloc(libusb_device_handle* /*handle*/,
                                                std::size_t length) {
  if (bus().random() % 2 == 0) return nullptr;
  ++bus().counts.open;
  return new unsigned char[length];  // NOLINT(cppcoreguidelines-owning-memory)
}

int LIBUSB_CALL libusb_dev_mem_free(libusb_device_handle* /*handle*/, unsigned char* buffer,
                                    std::size_t /*length*/) {
  --bus().counts.open;
  delete[] buffer;  // NOLINT(cppcoreguidelines-owning-memory)
  return LIBUSB_SUCCESS;
}

libusb_transfer* LIBUSB_CALL libusb_alloc_transfer(int /*packets*/) {
  ++bus().counts.open;
  return new libusb_transfer{};  // NOLINT(cppcoreguidelines-owning-memory)
}

void LIBUSB_CALL libusb_free_transfer(libusb_transfer* transfer) {
  --bus().counts.open;
  delete transfer;  // NOLINT(cppcoreguidelines-owning-memory)
}

int LIBUSB_CALL libusb_submit_transfer(libusb_transfer* transfer) {
  auto& b = bus();
  if (b.is_dead()) return LIBUSB_ERROR_NO_DEVICE;
  ((transfer->endpoint & LIBUSB_ENDPOINT_IN) != 0 ? b.in : b.out).push_back(transfer);
  return LIBUSB_SUCCESS;
}

int LIBUSB_CALL libusb_cancel_transfer(libusb_transfer* transfer) {
  auto& b = bus();
  for (auto* queue : {&b.out, &b.in}) {
    if (std::erase(*queue, transfer) > 0) {
      transfer->status = LIBUSB_TRANSFER_CANCELLED;
      transfer->callback(transfer);
      return LIBUSB_SUCCESS;
    }
  }
  return LIBUSB_ERROR_NOT_FOUND;
}

int LIBUSB_CALL libusb_handle_events_timeout_completed(libusb_context* /*context*/, timeval* time,
                                                       int* /*completed*/) {
  using std::chrono::microseconds;
  const microseconds longest(time->tv_sec * 1'000'000 + time->tv_usec);
  if (!gridrt::fake::move_all(bus())) {
    std::this_thread::sleep_for(std::min(longest, microseconds(100)));
  }
  return LIBUSB_SUCCESS;
}

const char* LIBUSB_CALL libusb_strerror(int /*code*/) { return "an error of the bus"; }

}  // extern "C"
