#include "host/driver/usb_device.hpp"

#include <algorithm>
#include <chrono>
#include <random>
#include <utility>

#include "host/driver/session.hpp"

namespace gridrt {
namespace {

using protocol::FrameType;

constexpr int kMostAttempts = 6;  ///< the last one waits for half of the time limit, each one
                                  ///< before it for half as long
constexpr std::uint32_t kPausesPerSecond = 4;  ///< a frame that pauses for longer is given up

/// Reads until the board has answered a NoOp, so that no answer to an earlier program is taken for
/// one to this. A frame that such a program left unfinished may swallow the first NoOps.
Result<void> synchronise(Connection& connection, std::chrono::milliseconds limit) {
  std::chrono::milliseconds patience =
      std::max(limit / (1 << kMostAttempts), std::chrono::milliseconds(1));
  for (int attempt = 0; attempt < kMostAttempts; ++attempt, patience *= 2) {
    const std::uint32_t sequence = connection.next_sequence();
    if (auto sent = connection.send(FrameType::kNoOp, sequence, {}); !sent) return sent;
    connection.progress();
    const auto end = std::chrono::steady_clock::now() + patience;
    while (std::chrono::steady_clock::now() < end) {
      const Result<std::optional<Frame>> frame = connection.receive(patience);
      if (!frame) return std::unexpected(frame.error());
      const std::optional<Frame>& got = *frame;
      if (!got) break;
      if (got->type() == FrameType::kNoOp && got->header.sequence == sequence) return {};
    }
  }
  return fail(ErrorKind::kTimeout, "the board takes frames but answers none",
              "'gridrt-board reset' frees it; if that does not help, unplug it");
}

}  // namespace

bool is_usb(std::string_view device) { return device == "usb" || device.starts_with("usb:"); }

Result<std::unique_ptr<Device>> open_usb_device(const DeviceOptions& options, UsbOptions usb) {
  const std::size_t colon = options.name.find(':');
  if (colon != std::string::npos) usb.serial = options.name.substr(colon + 1);
  usb.patience = std::chrono::milliseconds(std::max(1, options.timeout_ms));
  Result<std::unique_ptr<Transport>> link = open_usb(usb);
  if (!link) return std::unexpected(std::move(link.error()));
  Result<std::unique_ptr<Session>> session = Session::open(std::move(*link), options);
  if (!session) return std::unexpected(std::move(session.error()));
  (*session)->set_name(options.name);
  Connection& connection = (*session)->connection();
  // Another number than the program before, so that its answers do not fit.
  connection.set_next_sequence(std::random_device{}());
  // A board gives up a frame that pauses; on this link it may, for as long as the host is busy.
  if (const std::uint32_t clock = (*session)->capabilities().clock_hz; clock > 0) {
    auto set =
        set_report(connection.transport(),
                   protocol::ControlReport{.idle_clocks = clock / kPausesPerSecond, .log = 0});
    if (!set && set.error().kind != ErrorKind::kUnsupported) {
      return std::unexpected(std::move(set.error()));
    }
  }
  if (auto done = synchronise(connection, usb.patience); !done)
    return std::unexpected(std::move(done.error()));
  if (auto counts = (*session)->start_counting(); !counts) {
    return std::unexpected(std::move(counts.error()));
  }
  return std::unique_ptr<Device>(std::move(*session));
}

}  // namespace gridrt
