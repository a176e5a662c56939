// The configurations of the RTL that this build can simulate.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "hal/error.hpp"
#include "hal/sim/board.hpp"

namespace gridrt {

/// Their names, the default (B = 17, four PEs) first: "b17x4", ...
std::vector<std::string_view> sim_boards();

/// Makes a board and powers it up. `waves` names an FST file for all signals, which costs most of
/// the speed; empty: none. Errors: kUsage for an unknown name, kFile if the file cannot be opened.
Result<std::unique_ptr<SimBoard>> make_sim_board(std::string_view name,
                                                 const std::string& waves = {});

}  // namespace gridrt
