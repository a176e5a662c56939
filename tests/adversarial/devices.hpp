// Which devices the tests run on, and how much of the work they get.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "host/driver/device.hpp"
#include "host/image/image.hpp"

namespace gridrt::adversarial {

/// The names in the environment variable GRIDRT_DEVICES (separated by commas), or none.
std::vector<std::string> asked_devices();

/// Those asked for, or all that are built in but `mpi`, and `seq-board`, software with the board's
/// limits.
std::vector<std::string> devices_under_test();

/// Of how many rays a device under test gets one, the others being answered by `seq`:
/// GRIDRT_FRACTION is "1/N"; N is 1 if it is not set.
std::size_t rays_per_traced_one();

/// True if an image goes beyond what a device is made for: layout, lattice bits or PEs. Sizes of
/// memories do not count; the tests' scenes fit them.
bool is_beyond(const Image& image, const protocol::CapabilitiesReport& capabilities);

}  // namespace gridrt::adversarial
