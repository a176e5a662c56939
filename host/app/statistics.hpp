// What --stats writes.
#pragma once

#include <string>

#include "host/app/options.hpp"
#include "host/app/prepared_scene.hpp"
#include "host/driver/device.hpp"
#include "host/render/waves.hpp"

namespace gridrt {

/// Everything that a run knows about itself.
struct RunStatistics {
  std::string device;  ///< with auto resolved
  RenderReport report;
  DeviceCounters counters;
  double load = 0.0;  ///< seconds
  double build = 0.0;
  double upload = 0.0;
  double write = 0.0;
  double total = 0.0;
};

/// The text of stats.json. Given rays count as primary ones; `shade` is all that the host does
/// about rays. Of a device without a clock, cycles and cycles_per_ray are null; so is
/// disagreements_bound without --exact.
std::string statistics_json(const HostOptions& options, const PreparedScene& prepared,
                            const RunStatistics& statistics);

}  // namespace gridrt
