#include "tools/virtual/board.hpp"

#include <algorithm>
#include <chrono>
#include <limits>
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

/// The simulated board from the wire's side. Its clock runs while it is asked for bytes.
class SimulatedEndpoint final : public Endpoint {
 public:
  explicit SimulatedEndpoint(std::unique_ptr<SimBoard> board)
      : link_(std::move(board),
              {.silent_clocks = kSilence, .most_silences = std::numeric_limits<int>::max()}) {}

  Result<void> consume(std::span<const std::byte> bytes) override { return link_.send(bytes); }
  Result<std::size_t> produce(std::span<std::byte> out,
                              std::chrono::milliseconds timeout) override {
    return link_.receive(out, timeout);
  }
  Result<void> get_feature(std::uint8_t id, std::span<std::byte> body) override {
    return link_.get_feature(id, body);
  }
  Result<void> set_feature(std::uint8_t id, std::span<const std::byte> body) override {
    return link_.set_feature(id, body);
  }

 private:
  static constexpr std::uint64_t kSilence = 50'000;
  SimTransport link_;
};

Result<VirtualBoard> simulated() {
  auto board = make_sim_board(sim_boards().front());
  if (!board) return std::unexpected(std::move(board.error()));
  return VirtualBoard{std::make_unique<SimulatedEndpoint>(std::move(*board)), {}};
}

#else

Result<VirtualBoard> simulated() {
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
  if (options.core == "sim") return simulated();
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
