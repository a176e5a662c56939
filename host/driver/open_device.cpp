#include <algorithm>
#include <thread>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "hal/loopback.hpp"
#include "host/driver/device.hpp"
#include "host/driver/session.hpp"
#include "host/pe/software_device.hpp"

namespace gridrt {
namespace {

constexpr const char* kBoardInSoftware = "seq-board";

Result<std::unique_ptr<Device>> open_software(const DeviceOptions& options, int threads) {
  SoftwareDeviceOptions software{.name = options.name, .threads = threads};
  if (options.name == kBoardInSoftware) software.capabilities = board_capabilities();
  if (options.capabilities) software.capabilities = *options.capabilities;
  auto transport =
      std::make_unique<LoopbackTransport>(std::make_unique<SoftwareDevice>(std::move(software)));
  Result<std::unique_ptr<Session>> session = Session::open(std::move(transport), options);
  if (!session) return std::unexpected(std::move(session.error()));
  return std::unique_ptr<Device>(std::move(*session));
}

/// Devices that the plan names and this build does not have yet.
bool is_planned(const std::string& name) {
  return name == "sim" || name == "mpi" || name == "usb" || name.starts_with("usb:");
}

}  // namespace

std::vector<std::string> built_in_devices() { return {"seq", "omp"}; }

Result<std::unique_ptr<Device>> open_device(const DeviceOptions& options) {
  DeviceOptions chosen = options;
  if (chosen.name == "auto") chosen.name = "omp";
  const std::string available = fmt::format("{}", fmt::join(built_in_devices(), ", "));
  if (is_planned(chosen.name)) {
    return fail(ErrorKind::kUnsupported,
                fmt::format("device '{}' is not built in yet", chosen.name),
                fmt::format("use one of: auto, {}", available));
  }
  if (std::ranges::count(built_in_devices(), chosen.name) == 0 && chosen.name != kBoardInSoftware) {
    return fail(ErrorKind::kUsage, fmt::format("device '{}' is not known", chosen.name),
                fmt::format("use one of: auto, {}", available));
  }
  if (chosen.schedule != "rays") {
    const bool planned = chosen.schedule == "pes" || chosen.schedule == "paper";
    return fail(planned ? ErrorKind::kUnsupported : ErrorKind::kUsage,
                fmt::format("schedule '{}' {}", chosen.schedule,
                            planned ? "is not built in yet" : "is not known"),
                "use --schedule rays");
  }
  if (chosen.threads < 0) {
    return fail(ErrorKind::kUsage, fmt::format("{} threads asked for", chosen.threads),
                "use 0 for all cores, or a positive number");
  }
  int threads = 1;
  if (chosen.name == "omp") {
    const int cores = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
    threads = chosen.threads == 0 ? cores : chosen.threads;
  }
  return open_software(chosen, threads);
}

}  // namespace gridrt
