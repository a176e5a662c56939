// A board without hardware: the firmware's logic around software PEs, or the simulated RTL.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "hal/endpoint.hpp"
#include "hal/error.hpp"
#include "tools/virtual/usb_function.hpp"

namespace gridrt {

struct VirtualBoardOptions {
  std::string core = "omp";           ///< seq, omp (software PEs) or sim (the RTL)
  bool wide = false;                  ///< software PEs without the board's limits
  std::string serial = "virtual-1";   ///< at most 16 characters of ASCII
  std::vector<std::byte> flash = {};  ///< a flash image, or empty
};

/// What stands behind a UsbFunction.
struct VirtualBoard {
  std::unique_ptr<Endpoint> endpoint;
  InputSource input;  ///< input reports that the board sends by itself
};

/// Powers a board up; it has loaded the image in flash then, or refused it. Errors: kUsage for an
/// unknown core, kLimit for a serial that is too long, kUnsupported for what this build does not
/// have.
Result<VirtualBoard> make_virtual_board(const VirtualBoardOptions& options);

}  // namespace gridrt
