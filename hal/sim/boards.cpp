#include "hal/sim/boards.hpp"

#include "gridrt_sim_boards.hpp"
#include "hal/sim/verilated_board.hpp"

namespace gridrt {
namespace {

template <class Model>
Result<std::unique_ptr<SimBoard>> make(const SimBoardOptions& options) {
  const std::string& waves = options.waves;
  auto board = std::make_unique<VerilatedBoard<Model>>();
  if (!waves.empty()) {
    if (!board->kHasWaves) {
      return fail(ErrorKind::kUnsupported, "this board was built without waves",
                  "use --device sim, or leave --trace out");
    }
    if (!board->trace_to(waves)) {
      return fail(ErrorKind::kFile, waves + ": cannot be opened for writing");
    }
  }
  board->set_flash(options.flash);
  board->power_up();
  return board;
}

}  // namespace

std::vector<std::string_view> sim_boards() {
#define GRIDRT_USE(name) #name,
  return {GRIDRT_SIM_BOARDS(GRIDRT_USE)};
#undef GRIDRT_USE
}

Result<std::unique_ptr<SimBoard>> make_sim_board(std::string_view name,
                                                 const SimBoardOptions& options) {
#define GRIDRT_USE(board) \
  if (name == #board) return make<Vgridrt_##board>(options);
  GRIDRT_SIM_BOARDS(GRIDRT_USE)
#undef GRIDRT_USE
  std::string known;
  for (const std::string_view board : sim_boards()) {
    known += ' ';
    known += board;
  }
  return fail(ErrorKind::kUsage, "no board '" + std::string(name) + "' can be simulated",
              "use one of:" + known);
}

}  // namespace gridrt
