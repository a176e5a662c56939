// How OpenMP's threads wait.
#pragma once

#include <cstdlib>

#include <unistd.h>

namespace gridrt {

/// To be called first in main(): starts the program again with threads of OpenMP that sleep while
/// they have nothing to do, unless the environment says how they are to wait. GCC's OpenMP reads
/// this before main() and nowhere else. Its threads would otherwise spin for a while after each
/// parallel loop, in the way of all others who use the machine and of this program's own: ten times
/// slower beside one busy process on two cores.
inline void wait_patiently(char** argv) {
  if (std::getenv("OMP_WAIT_POLICY") != nullptr || std::getenv("GOMP_SPINCOUNT") != nullptr) return;
  if (setenv("OMP_WAIT_POLICY", "passive", 1) != 0) return;
  execv("/proc/self/exe", argv);  // returns only if it cannot be: then as it is
}

}  // namespace gridrt
