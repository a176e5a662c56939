#include <algorithm>
#include <optional>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "hal/loopback.hpp"
#include "hal/usb/usb.hpp"
#include "host/driver/device.hpp"
#include "host/driver/session.hpp"
#include "host/driver/sim_device.hpp"
#include "host/driver/usb_device.hpp"
#include "host/grid/parallel.hpp"
#include "host/mpi/connect.hpp"
#include "host/pe/ray_stream.hpp"
#include "host/pe/software_device.hpp"

namespace gridrt {
namespace {

constexpr const char* kBoardInSoftware = "seq-board";

Result<std::unique_ptr<Device>> open_session(std::unique_ptr<Transport> transport,
                                             const DeviceOptions& options) {
  Result<std::unique_ptr<Session>> session = Session::open(std::move(transport), options);
  if (!session) return std::unexpected(std::move(session.error()));
  return std::unique_ptr<Device>(std::move(*session));
}

Result<std::unique_ptr<Device>> open_software(const DeviceOptions& options,
                                              const ScheduleOptions& schedule) {
  SoftwareDeviceOptions software{.name = options.name, .schedule = schedule};
  if (options.name == kBoardInSoftware) software.capabilities = board_capabilities();
  if (options.capabilities) software.capabilities = *options.capabilities;
  return open_session(
      std::make_unique<LoopbackTransport>(std::make_unique<SoftwareDevice>(std::move(software))),
      options);
}

Result<std::unique_ptr<Device>> open_ranks(const DeviceOptions& options,
                                           const ScheduleOptions& schedule) {
  RankOptions ranks;
  ranks.schedule = schedule;
  ranks.capabilities = options.capabilities.value_or(software_capabilities());
  ranks.silence = std::chrono::milliseconds(std::max(1, options.timeout_ms));
  ranks.ranks = options.ranks;
  ranks.groups = options.groups;
  Result<std::unique_ptr<Transport>> transport = connect_ranks(ranks);
  if (!transport) return std::unexpected(std::move(transport.error()));
  return open_session(std::move(*transport), options);
}

/// Devices that the plan names and this build does not have yet.
bool is_planned(const std::string& name) {
  return (name == "mpi" && !mpi_is_built_in()) || (is_usb(name) && !usb_is_built_in());
}

/// The schedule of a software device. Threads are for `omp` to choose.
Result<ScheduleOptions> choose_schedule(const DeviceOptions& options) {
  ScheduleOptions out;
  const std::string name(options.schedule.empty() ? default_schedule(options.name)
                                                  : std::string_view(options.schedule));
  const std::optional<Schedule> known = schedule_of(name);
  if (!known) {
    return fail(ErrorKind::kUsage, fmt::format("schedule '{}' is not known", name),
                "use rays, pes or paper");
  }
  if (options.name == "seq" && *known != Schedule::kRays) {
    return fail(ErrorKind::kUsage,
                fmt::format("device 'seq' has one thread and no schedule '{}'", name),
                "use --device omp or mpi, or leave --schedule out");
  }
  if (options.name == "mpi" && *known == Schedule::kRays) {
    return fail(ErrorKind::kUsage,
                "device 'mpi' has no schedule 'rays': a rank has its own PEs only",
                "use --schedule pes or paper, or --device omp");
  }
  out.schedule = *known;
  out.interrupt = options.pes_interrupt;
  out.feedback = options.pes_feedback;
  if (options.name == "omp") {
    out.plain = options.simd == "plain";
    if (!out.plain && !stream_kernel(options.simd)) {
      std::vector<std::string_view> names{"plain"};
      for (const StreamKernel& kernel : stream_kernels()) names.push_back(kernel.name);
      return fail(ErrorKind::kUsage, fmt::format("no vectors of kind '{}' here", options.simd),
                  fmt::format("use one of: {}", fmt::join(names, ", ")));
    }
    out.simd = options.simd;
    out.threads = *known == Schedule::kPaper ? options.threads : resolve_threads(options.threads);
  }
  return out;
}

}  // namespace

std::string_view default_schedule(std::string_view device) {
  return device == "mpi" ? "pes" : "rays";
}

bool is_sim(std::string_view device) { return device == "sim" || device.starts_with("sim:"); }

std::vector<std::string> built_in_devices() {
  std::vector<std::string> names{"seq", "omp"};
  if (mpi_is_built_in()) names.emplace_back("mpi");
  if (has_sim()) names.emplace_back("sim");
  if (usb_is_built_in()) names.emplace_back("usb");
  return names;
}

AutoChoice choose_device() {
  std::string without = "no GridRT board is plugged in";
  if (!usb_is_built_in()) {
    without = "this build has no device 'usb'";
  } else if (const auto boards = list_usb_boards(); !boards) {
    without = boards.error().message;
  } else {
    for (const UsbBoard& board : *boards) {
      if (board.trouble.empty()) return {"usb", "a GridRT board is plugged in"};
      without = board.trouble;
    }
  }
  if (ranks_of_this_job() > 1) return {"mpi", without + ", and this is a job of several ranks"};
  return {"omp", without};
}

Result<std::unique_ptr<Device>> open_device(const DeviceOptions& options) {
  DeviceOptions chosen = options;
  if (chosen.name == "auto") chosen.name = choose_device().name;
  if (!chosen.waves.empty() && !is_sim(chosen.name)) {
    return fail(ErrorKind::kUsage, fmt::format("device '{}' has no waves to trace", chosen.name),
                "use --device sim, or leave --trace out");
  }
  if (!chosen.flash.empty() && !is_sim(chosen.name)) {
    return fail(ErrorKind::kUsage, fmt::format("device '{}' has no flash to give it", chosen.name),
                "use --device sim, or leave --flash out");
  }
  const std::string available = fmt::format("{}", fmt::join(built_in_devices(), ", "));
  if (is_planned(chosen.name)) {
    return fail(ErrorKind::kUnsupported,
                fmt::format("device '{}' is not built in yet", chosen.name),
                fmt::format("use one of: auto, {}", available));
  }
  if (std::ranges::count(built_in_devices(), chosen.name) == 0 && !is_sim(chosen.name) &&
      !is_usb(chosen.name) && chosen.name != kBoardInSoftware) {
    return fail(ErrorKind::kUsage, fmt::format("device '{}' is not known", chosen.name),
                fmt::format("use one of: auto, {}", available));
  }
  if (chosen.threads < 0) {
    return fail(ErrorKind::kUsage, fmt::format("{} threads asked for", chosen.threads),
                "use 0 for all cores, or a positive number");
  }
  if (chosen.name != "mpi" && chosen.groups != 1) {
    return fail(
        ErrorKind::kUsage,
        fmt::format("device '{}' has no ranks to split into {} groups", chosen.name, chosen.groups),
        "use --device mpi, or leave --groups out");
  }
  if (is_sim(chosen.name) || is_usb(chosen.name)) {
    if (!chosen.schedule.empty()) {
      return fail(ErrorKind::kUsage,
                  fmt::format("device '{}' has no schedule '{}'", chosen.name, chosen.schedule),
                  "schedules are for seq, omp and mpi; leave --schedule out");
    }
    return is_sim(chosen.name) ? open_sim(chosen) : open_usb_device(chosen);
  }
  const Result<ScheduleOptions> schedule = choose_schedule(chosen);
  if (!schedule) return std::unexpected(schedule.error());
  // The reference has one thread; ranks have cores of their own to use.
  if (chosen.name != "omp") chosen.threads = 1;
  if (chosen.name == "mpi") return open_ranks(chosen, *schedule);
  return open_software(chosen, *schedule);
}

}  // namespace gridrt
