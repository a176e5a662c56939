#include "host/driver/sim_device.hpp"

#include <string>
#include <utility>

#include "hal/sim/boards.hpp"
#include "hal/sim/sim_transport.hpp"
#include "host/driver/session.hpp"

namespace gridrt {
namespace {

constexpr std::uint32_t kIdleClocks = 20'000;

}  // namespace

bool has_sim() { return true; }

Result<std::unique_ptr<Device>> open_sim(const DeviceOptions& options) {
  const std::size_t colon = options.name.find(':');
  const std::string board_name = colon == std::string::npos ? std::string(sim_boards().front())
                                                            : options.name.substr(colon + 1);
  Result<std::unique_ptr<SimBoard>> board = make_sim_board(board_name, {.waves = options.waves});
  if (!board) return std::unexpected(std::move(board.error()));
  Result<std::unique_ptr<Session>> session =
      Session::open(std::make_unique<SimTransport>(std::move(*board)), options);
  if (!session) return std::unexpected(std::move(session.error()));
  (*session)->set_name(options.name);
  // A frame that stays unfinished will stay so: the link never pauses within one.
  auto set = set_report((*session)->connection().transport(),
                        protocol::ControlReport{.idle_clocks = kIdleClocks, .log = 0});
  if (!set) return std::unexpected(std::move(set.error()));
  return std::unique_ptr<Device>(std::move(*session));
}

}  // namespace gridrt
