#include "host/app/exit_code.hpp"
#include "host/app/host_program.hpp"
#include "host/grid/patient_threads.hpp"
#include "host/mpi/ranks.hpp"

int main(int argc, char** argv) {
  gridrt::wait_patiently(argv);
  const gridrt::Ranks ranks;
  if (ranks.serves()) return ranks.serve();
  return gridrt::run_program("gridrt-host", gridrt::run_host, argc, argv);
}
