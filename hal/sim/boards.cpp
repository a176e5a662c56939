#include "hal/sim/boards.hpp"

#include <Vgridrt_b12x2.h>
#include <Vgridrt_b17x4.h>

#include "hal/sim/verilated_board.hpp"

namespace gridrt {
namespace {

template <class Model>
Result<std::unique_ptr<SimBoard>> make(const std::string& waves) {
  auto board = std::make_unique<VerilatedBoard<Model>>();
  if (!waves.empty() && !board->trace_to(waves)) {
    return fail(ErrorKind::kFile, waves + ": cannot be opened for writing");
  }
  board->power_up();
  return board;
}

}  // namespace

std::vector<std::string_view> sim_boards() { return {"b17x4", "b12x2"}; }

Result<std::unique_ptr<SimBoard>> make_sim_board(std::string_view name, const std::string& waves) {
  if (name == "b17x4") return make<Vgridrt_b17x4>(waves);
  if (name == "b12x2") return make<Vgridrt_b12x2>(waves);
  return fail(ErrorKind::kUsage, "no board '" + std::string(name) + "' can be simulated",
              "use b17x4 or b12x2");
}

}  // namespace gridrt
