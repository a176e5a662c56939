// In the place of sim_device.cpp where the RTL is not simulated.
#include "host/driver/sim_device.hpp"

namespace gridrt {

bool has_sim() { return false; }

Result<std::unique_ptr<Device>> open_sim(const DeviceOptions& options) {
  return fail(ErrorKind::kUnsupported,
              "device '" + options.name + "' is not built in: this build has no simulated RTL",
              "configure with -DGRIDRT_BUILD_SIM=ON (needs Verilator), or use seq or omp");
}

}  // namespace gridrt
