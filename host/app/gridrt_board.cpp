#include "host/app/board_program.hpp"
#include "host/app/exit_code.hpp"

int main(int argc, char** argv) {
  return gridrt::run_program("gridrt-board", gridrt::run_board, argc, argv);
}
