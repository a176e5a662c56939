#include "hal/sim/boards.hpp"

#include <Vgridrt_b17x4.h>
#ifdef GRIDRT_SIM_TEST_BOARDS
#include <Vgridrt_b12x2.h>
#include <Vgridrt_stall.h>
#endif

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
#ifdef GRIDRT_SIM_TEST_BOARDS
  return {"b17x4", "b12x2", "stall"};
#else
  return {"b17x4"};
#endif
}

Result<std::unique_ptr<SimBoard>> make_sim_board(std::string_view name,
                                                 const SimBoardOptions& options) {
  if (name == "b17x4") return make<Vgridrt_b17x4>(options);
#ifdef GRIDRT_SIM_TEST_BOARDS
  if (name == "b12x2") return make<Vgridrt_b12x2>(options);
  if (name == "stall") return make<Vgridrt_stall>(options);
#endif
  std::string known;
  for (const std::string_view board : sim_boards()) {
    known += ' ';
    known += board;
  }
  return fail(ErrorKind::kUsage, "no board '" + std::string(name) + "' can be simulated",
              "use one of:" + known);
}

}  // namespace gridrt
