#include "tools/virtual/board.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <limits>
#include <optional>
#include <thread>
#include <utility>

#include "firmware/model/board_model.hpp"
#include "firmware/self_test_vectors.hpp"
#include "host/pe/software_device.hpp"
#ifdef GRIDRT_VIRTUAL_SIM
#include "hal/sim/boards.hpp"
#include "hal/sim/sim_transport.hpp"
#endif

namespace gridrt {
namespace {

/// A frame that pauses for longer than this was cut short: shorter than the host's own patience.
constexpr std::chrono::milliseconds kFramePatience(3000);

std::unique_ptr<Endpoint> software_core(const VirtualBoardOptions& options) {
  SoftwareDeviceOptions software;
  software.name = "board";
  software.capabilities = options.wide ? software_capabilities() : board_capabilities();
  software.frame_patience = kFramePatience;
  software.schedule.threads =
      options.core == "omp" ? static_cast<int>(std::max(1U, std::thread::hardware_concurrency()))
                            : 1;
  return std::make_unique<SoftwareDevice>(std::move(software));
}

#ifdef GRIDRT_VIRTUAL_SIM

/// The simulated board from the wire's side. Its clock runs while it is asked for bytes or reports,
/// a short time at once, since the bus stands meanwhile. A board that stands is none that has
/// failed: its host has time limits of its own, and resets it.
class SimulatedEndpoint final : public Endpoint {
 public:
  /// `boot_clocks`: that an image in flash may take beside what a report takes.
  SimulatedEndpoint(std::unique_ptr<SimBoard> board, std::uint64_t boot_clocks)
      : link_(std::move(board), {.silent_clocks = kSlice,
                                 .most_silences = std::numeric_limits<int>::max(),
                                 .report_clocks = SimTransportOptions{}.report_clocks + boot_clocks,
                                 .reports_wait = false}) {}

  /// Returns once the firmware answers reports, before which it has loaded the image in flash: a
  /// kernel would not wait for as long as that takes here.
  Result<void> start() {
    std::array<std::byte, protocol::StatusReport::kBytes> body{};
    return link_.get_feature(protocol::StatusReport::kId, body);
  }

  Result<void> consume(std::span<const std::byte> bytes) override {
    if (auto sent = link_.send(bytes); !sent) return sent;
    // A host that is ahead waits as it does for a board that answers NAK.
    for (std::uint64_t clocks = 0; clocks < kLongest; clocks += kSlice) {
      if (link_.deliver(kAhead)) break;
    }
    return {};
  }
  Result<std::size_t> produce(std::span<std::byte> out,
                              std::chrono::milliseconds timeout) override {
    auto got = link_.receive(out, timeout);
    if (!got && got.error().kind == ErrorKind::kTimeout) return 0;
    return got;
  }
  Result<void> get_feature(std::uint8_t id, std::span<std::byte> body) override {
    return link_.get_feature(id, body);
  }
  Result<void> set_feature(std::uint8_t id, std::span<const std::byte> body) override {
    return link_.set_feature(id, body);
  }
  /// An input report, id first; 0 if none waits.
  std::size_t input(std::span<std::byte> report) {
    if (report.size() < protocol::kReportBytes) return 0;
    const std::optional<std::uint8_t> id =
        link_.read_input(report.subspan(1, protocol::kReportBytes - 1), {}).value_or(std::nullopt);
    if (!id) return 0;
    report[0] = static_cast<std::byte>(*id);
    return protocol::kReportBytes;
  }

 private:
  static constexpr std::uint64_t kSlice = 2'000;
  static constexpr std::uint64_t kLongest = 250'000;  ///< that a board in order takes no byte
  static constexpr std::size_t kAhead = std::size_t{1} << 15U;
  SimTransport link_;
};

Result<VirtualBoard> simulated(const VirtualBoardOptions& options) {
  auto board = make_sim_board(sim_boards().front(), {.flash = options.flash});
  if (!board) return std::unexpected(std::move(board.error()));
  constexpr std::uint64_t kBootClocks = 100;  // a byte of flash, at the most
  auto endpoint =
      std::make_unique<SimulatedEndpoint>(std::move(*board), kBootClocks * options.flash.size());
  if (!options.flash.empty()) {
    if (auto started = endpoint->start(); !started) {
      return std::unexpected(std::move(started.error()));
    }
  }
  InputSource input = [sim = endpoint.get()](std::span<std::byte> report) {
    return sim->input(report);
  };
  return VirtualBoard{std::move(endpoint), std::move(input)};
}

#else

Result<VirtualBoard> simulated(const VirtualBoardOptions& /*options*/) {
  return fail(ErrorKind::kUnsupported, "this build has no simulated RTL",
              "configure with -DGRIDRT_BUILD_SIM=ON");
}

#endif

}  // namespace

Result<VirtualBoard> make_virtual_board(const VirtualBoardOptions& options) {
  constexpr std::size_t kMostSerial = 16;
  if (options.serial.size() > kMostSerial) {
    return fail(ErrorKind::kLimit, "a serial has at most 16 characters: " + options.serial);
  }
  if (options.core == "sim") return simulated(options);
  if (options.core != "seq" && options.core != "omp") {
    return fail(ErrorKind::kUsage, "no core '" + options.core + "'", "use seq, omp or sim");
  }
  auto board = std::make_unique<firmware::BoardModel>(
      software_core(options),
      firmware::BoardModelOptions{
          .serial = options.serial, .flash = options.flash, .vectors = firmware::kSelfTestVectors});
  InputSource input = [model = board.get()](std::span<std::byte> report) -> std::size_t {
    model->poll();
    const auto waiting = model->take_input();
    if (!waiting || report.size() <= waiting->body.size()) return 0;
    report[0] = static_cast<std::byte>(waiting->id);
    std::ranges::copy(waiting->body, report.begin() + 1);
    return 1 + waiting->body.size();
  };
  return VirtualBoard{std::move(board), std::move(input)};
}

}  // namespace gridrt
