// `guest_throughput bytes SECONDS`: bytes per second through UsbTransport against libusb alone, in
// turns, on a board that takes every byte and, if it is told to speak, never runs out of its own
// (`usb_test_board endless`). `guest_throughput rays IMAGE`: rays per second through the device
// usb. Both print a table.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <memory>
#include <random>
#include <string_view>
#include <vector>

#include "gridrt_usb.hpp"
#include "hal/usb/libusb.hpp"
#include "hal/usb/usb_transport.hpp"
#include "host/driver/usb_device.hpp"
#include "host/image/image_file.hpp"

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

/// Whether the board has bytes to say: a host that has to take them while it sends does the work of
/// both pipes.
bool let_speak(bool on) {
  const auto link = UsbTransport::open({.frames = false});
  return link && set_report(**link, protocol::ControlReport{.idle_clocks = 1, .log = on ? 1U : 0U});
}

int compare(double seconds) {
  constexpr int kTurns = 12;  // the best of many short ones: others may use the machine
  std::printf("%-4s %9s %9s %12s %12s %6s\n", "pipe", "in flight", "bytes", "libusb MB/s",
              "ours MB/s", "ratio");
  for (const bool in : {false, true}) {
    if (!let_speak(in)) return 1;
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
  return 0;
}

/// Segments that end anywhere in the image's box.
std::vector<Segment> some_rays(const Image& image, std::size_t count) {
  std::mt19937 random(3);
  std::vector<Segment> rays(count);
  for (Segment& ray : rays) {
    for (int a = 0; a < 3; ++a) {
      const auto box = static_cast<unsigned>(image.header.max_q[static_cast<std::size_t>(a)]) + 1;
      ray.p0[a] = static_cast<int>(random() % box);
      ray.p1[a] = static_cast<int>(random() % box);
    }
    ray.t1 = 1.0;
  }
  return rays;
}

int trace(const char* path) {
  constexpr std::size_t kRays = std::size_t{1} << 17U;
  constexpr int kTurns = 3;
  const auto image = read_image(path);
  if (!image) return 1;
  const std::vector<Segment> rays = some_rays(*image, kRays);
  std::vector<Hit> hits(rays.size());
  std::printf("%-4s %9s %9s %12s\n", "rays", "in flight", "bytes", "rays/s");
  for (const std::size_t transfers : {1, 4, 16}) {
    for (const std::size_t size : {4096, 16384, 65536}) {
      auto device =
          open_usb_device({.name = "usb"}, {.transfers = transfers, .transfer_bytes = size});
      if (!device || !(*device)->load(*image)) return 1;
      double best = std::numeric_limits<double>::infinity();
      for (int turn = 0; turn < kTurns; ++turn) {
        const auto start = Clock::now();
        if (!(*device)->trace(rays, Query::kClosestHit, hits)) return 1;
        best = std::min(best, since(start));
      }
      std::printf("%-4s %9zu %9zu %12.0f\n", "rays", transfers, size,
                  static_cast<double>(kRays) / best);
      std::fflush(stdout);
    }
  }
  return 0;
}

}  // namespace
}  // namespace gridrt

int main(int argc, char** argv) {
  const std::string_view what = argc == 3 ? argv[1] : "";
  if (what == "bytes") return gridrt::compare(std::atof(argv[2]));
  return what == "rays" ? gridrt::trace(argv[2]) : 2;
}
