// gridrt-board: looks after a board on USB through its reports.
#pragma once

namespace gridrt {

/// Runs the program; returns its exit code.
int run_board(int argc, const char* const* argv);

}  // namespace gridrt
