// main() of tests that mpirun may start: rank 0 tests, the others serve it.
#include <gtest/gtest.h>

#include "host/grid/patient_threads.hpp"
#include "host/mpi/ranks.hpp"

int main(int argc, char** argv) {
  gridrt::wait_patiently(argv);
  const gridrt::Ranks ranks;
  if (ranks.serves()) return ranks.serve();
  testing::InitGoogleTest(&argc, argv);
  return RUN_ALL_TESTS();
}
