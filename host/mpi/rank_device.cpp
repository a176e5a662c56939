#include "host/mpi/rank_device.hpp"

#include "host/mpi/mpi_postbox.hpp"
#include "host/mpi/rank_crew.hpp"

namespace gridrt {
namespace {

/// A number that no device of this job has had lately: tags tell their messages apart.
int new_device_number() {
  constexpr std::uint64_t kMost = 0x3FFFFFFF;
  constexpr unsigned kShift = 10;  // about a microsecond
  return static_cast<int>((now_ns() >> kShift) % kMost) + 1;
}

}  // namespace

std::unique_ptr<SoftwareDevice> make_rank_device(const RankOptions& options) {
  SoftwareDeviceOptions device{.name = "mpi", .schedule = options.schedule};
  device.capabilities = options.capabilities;
  return std::make_unique<SoftwareDevice>(
      device, std::make_unique<RankCrew>(make_mpi_postbox(), new_device_number(), options.schedule,
                                         options.capabilities, options.silence, options.groups));
}

}  // namespace gridrt
