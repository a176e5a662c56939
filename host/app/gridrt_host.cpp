#include "host/app/exit_code.hpp"
#include "host/app/host_program.hpp"

int main(int argc, char** argv) {
  return gridrt::run_program("gridrt-host", gridrt::run_host, argc, argv);
}
