// Bytes per second through UsbTransport against libusb alone, in turns, on a board that takes every
// byte and never runs out of its own (`usb_test_board endless`). Prints a table.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <vector>

#include "gridrt_usb.hpp"
#include "hal/usb/libusb.hpp"
#include "hal/usb/usb_transport.hpp"

namespace gridrt {
namespace {

using Clock = std::chrono::steady_clock;

double since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// libusb alone: transfers that are handed back as soon as they are done; nobody looks at the
/// bytes.
struct Alone {
  std::uint64_t bytes = 0;
  std::size_t in_flight = 0;
  bool going = true;

  static void LIBUSB_CALL done(libusb_transfer* transfer) {
    auto& self = *static_cast<Alone*>(transfer->user_data);
    self.bytes += static_cast<std::uint64_t>(transfer->actual_length);
    if (!self.going || transfer->status != LIBUSB_TRANSFER_COMPLETED ||
        libusb_submit_transfer(transfer) != LIBUSB_SUCCESS) {
      --self.in_flight;
    }
  }
};

double alone(bool in, std::size_t transfers, std::size_t size, double seconds) {
  libusb_context* raw = nullptr;
  if (libusb_init(&raw) != LIBUSB_SUCCESS) return 0.0;
  const LibusbContext context(raw);
  const LibusbHandle handle(libusb_open_device_with_vid_pid(raw, usb::kVendorId, usb::kProductId));
  if (!handle || libusb_claim_interface(handle.get(), usb::kBulkInterface) != 0) return 0.0;
  Alone state;
  std::vector<std::vector<unsigned char>> memory(transfers, std::vector<unsigned char>(size));
  std::vector<LibusbTransfer> all;
  const auto endpoint = static_cast<unsigned char>(in ? usb::kBulkIn : usb::kBulkOut);
  for (auto& bytes : memory) {
    all.emplace_back(libusb_alloc_transfer(0));
    libusb_fill_bulk_transfer(all.back().get(), handle.get(), endpoint, bytes.data(),
                              static_cast<int>(size), &Alone::done, &state, 0);
    if (libusb_submit_transfer(all.back().get()) == LIBUSB_SUCCESS) ++state.in_flight;
  }
  const auto start = Clock::now();
  timeval slice{0, 10000};
  while (since(start) < seconds) libusb_handle_events_timeout_completed(raw, &slice, nullptr);
  const double rate = static_cast<double>(state.bytes) / since(start);
  state.going = false;
  for (const auto& transfer : all) libusb_cancel_transfer(transfer.get());
  const auto end = Clock::now();
  while (state.in_flight > 0 && since(end) < 2.0) {
    libusb_handle_events_timeout_completed(raw, &slice, nullptr);
  }
  libusb_release_interface(handle.get(), usb::kBulkInterface);
  return rate;
}

double ours(bool in, std::size_t transfers, std::size_t size, double seconds) {
  const auto link = UsbTransport::open({.transfers = transfers, .transfer_bytes = size});
  if (!link) {
    std::printf("%s\n", link.error().message.c_str());
    return 0.0;
  }
  std::vector<std::byte> buffer(std::size_t{1} << 18U);
  std::uint64_t bytes = 0;
  const auto start = Clock::now();
  while (since(start) < seconds) {
    if (in) {
      bytes += (*link)->receive(buffer, std::chrono::milliseconds(100)).value_or(0);
    } else if ((*link)->send(buffer)) {
      bytes += buffer.size();
    }
  }
  if (!in && !(*link)->flush()) return 0.0;
  return static_cast<double>(bytes) / since(start);
}

void compare(double seconds) {
  constexpr int kTurns = 3;
  std::printf("%-4s %9s %9s %12s %12s %6s\n", "pipe", "in flight", "bytes", "libusb MB/s",
              "ours MB/s", "ratio");
  for (const bool in : {false, true}) {
    for (const std::size_t transfers : {1, 4, 16}) {
      for (const std::size_t size : {4096, 65536}) {
        double best_alone = 0.0;
        double best_ours = 0.0;
        for (int turn = 0; turn < kTurns; ++turn) {
          best_alone = std::max(best_alone, alone(in, transfers, size, seconds));
          best_ours = std::max(best_ours, ours(in, transfers, size, seconds));
        }
        std::printf("%-4s %9zu %9zu %12.2f %12.2f %6.2f\n", in ? "IN" : "OUT", transfers, size,
                    best_alone / 1e6, best_ours / 1e6, best_ours / best_alone);
        std::fflush(stdout);
      }
    }
  }
}

}  // namespace
}  // namespace gridrt

int main(int argc, char** argv) {
  gridrt::compare(argc > 1 ? std::atof(argv[1]) : 0.5);
  return 0;
}
