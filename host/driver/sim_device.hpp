// The device `sim`, if this build has it.
#pragma once

#include <memory>
#include <string_view>

#include "host/driver/device.hpp"

namespace gridrt {

/// True for "sim" and "sim:BOARD", whether they are built in or not.
bool is_sim(std::string_view device);

/// Whether this build can simulate the RTL.
bool has_sim();

/// Opens "sim" (the board: B = 17, four PEs) or "sim:BOARD" for one of the configurations of
/// hal/sim/boards.hpp. Errors: kUnsupported without the simulation, kUsage for an unknown board,
/// kFile if the waves cannot be written, and those of Session::open.
Result<std::unique_ptr<Device>> open_sim(const DeviceOptions& options);

}  // namespace gridrt
