#include "host/driver/sim_device.hpp"

#include <string>
#include <utility>

#include "hal/sim/boards.hpp"
#include "hal/sim/sim_transport.hpp"
#include "host/driver/session.hpp"
#include "host/image/image_file.hpp"

namespace gridrt {
namespace {

constexpr std::uint32_t kIdleClocks = 20'000;
constexpr std::uint64_t kBootClocks = 100;  ///< a byte of flash, at the most

}  // namespace

bool has_sim() { return true; }

Result<std::unique_ptr<Device>> open_sim(const DeviceOptions& options) {
  const std::size_t colon = options.name.find(':');
  const std::string board_name = colon == std::string::npos ? std::string(sim_boards().front())
                                                            : options.name.substr(colon + 1);
  SimBoardOptions board_options{.waves = options.waves, .flash = {}};
  SimTransportOptions link_options;
  if (!options.flash.empty()) {
    auto flash = read_bytes(options.flash);
    if (!flash) return std::unexpected(std::move(flash.error()));
    link_options.report_clocks += kBootClocks * flash->size();
    board_options.flash = std::move(*flash);
  }
  Result<std::unique_ptr<SimBoard>> board = make_sim_board(board_name, board_options);
  if (!board) return std::unexpected(std::move(board.error()));
  Result<std::unique_ptr<Session>> session =
      Session::open(std::make_unique<SimTransport>(std::move(*board), link_options), options);
  if (!session) return std::unexpected(std::move(session.error()));
  (*session)->set_name(options.name);
  // A frame that stays unfinished will stay so: the link never pauses within one.
  auto set = set_report((*session)->connection().transport(),
                        protocol::ControlReport{.idle_clocks = kIdleClocks, .log = 0});
  if (!set) return std::unexpected(std::move(set.error()));
  return std::unique_ptr<Device>(std::move(*session));
}

}  // namespace gridrt
