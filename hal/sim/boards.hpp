// The configurations of the RTL that this build can simulate.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "hal/error.hpp"
#include "hal/sim/board.hpp"

namespace gridrt {

/// Their names, the default first: "b17x4" has B = 17 and four PEs. In builds with tests also
/// "b12x2" with B = 12 and two PEs, and "stall", which is as b17x4, but its streams pause at random
/// and its assertions are checked (one that fails ends the program). GRIDRT_SIM_ALL_BOARDS: all of
/// B = 12, 14, 17 with 1, 2 and 4 PEs.
std::vector<std::string_view> sim_boards();

struct SimBoardOptions {
  std::string waves = {};             ///< an FST file for all signals; empty: none
  std::vector<std::byte> flash = {};  ///< what the flash holds from flash_address on
};

/// Makes a board and powers it up. `options.waves` names an FST file for all signals, which costs
/// most of the speed and which only b17x4 has; empty: none. Errors: kUsage for an unknown name,
/// kUnsupported for waves of a board without, kFile if the file cannot be opened.
Result<std::unique_ptr<SimBoard>> make_sim_board(std::string_view name,
                                                 const SimBoardOptions& options = {});

}  // namespace gridrt
