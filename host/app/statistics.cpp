#include "host/app/statistics.hpp"

#include <nlohmann/json.hpp>

#include "host/app/parse.hpp"
#include "host/grid/partition.hpp"

namespace gridrt {

std::string statistics_json(const HostOptions& options, const PreparedScene& prepared,
                            const RunStatistics& statistics) {
  using Json = nlohmann::ordered_json;
  const auto& header = prepared.image().header;
  const RenderReport& report = statistics.report;
  const DeviceCounters& counters = statistics.counters;
  const glm::ivec3 grid = prepared.image().grid().count;
  Json json;
  json["version"] = GRIDRT_VERSION;
  json["scene"] = options.scene;
  json["device"] = statistics.device;
  json["schedule"] = options.schedule;
  json["lattice_bits"] = static_cast<int>(header.bits);
  json["grid"] = {grid.x, grid.y, grid.z};
  json["triangles"] = prepared.scene.triangles.size();
  json["degenerate"] = header.degenerate;
  json["pes"] = static_cast<int>(header.pes);
  json["mapping"] = mapping_name(static_cast<Mapping>(header.mapping));
  json["layout"] = layout_name(static_cast<protocol::Layout>(header.layout));
  json["chunks"] = prepared.images->chunks.size();
  json["uploads"] = counters.uploads;
  if (options.rays.empty()) {
    json["size"] = {options.size.x, options.size.y};
    json["samples"] = options.samples;
    json["depth"] = options.depth;
    json["deepest"] = report.deepest;
  }
  json["rays"] = {{"primary", report.primary}, {"shadow", report.shadow},
                  {"mirror", report.mirror},   {"refraction", report.refraction},
                  {"total", report.total()},   {"outside", report.outside}};
  json["steps"] = counters.steps;
  json["tests"] = counters.tests;
  json["masked"] = counters.masked;
  json["interrupts"] = counters.interrupts;
  json["feedback_waits"] = counters.feedback_waits;
  json["cycles"] = nullptr;
  json["cycles_per_ray"] = nullptr;
  if (counters.cycles > 0) {
    json["cycles"] = counters.cycles;
    if (counters.rays > 0) {
      json["cycles_per_ray"] =
          static_cast<double>(counters.cycles) / static_cast<double>(counters.rays);
    }
  }
  json["bytes_out"] = counters.bytes_out;
  json["bytes_in"] = counters.bytes_in;
  json["frames_retried"] = counters.frames_retried;
  json["flagged"] = 0;
  json["retraced"] = 0;
  json["disagreements_bound"] = nullptr;
  json["seconds"] = {{"load", statistics.load},       {"build", statistics.build},
                     {"upload", statistics.upload},   {"trace", report.trace_seconds},
                     {"shade", report.shade_seconds}, {"write", statistics.write},
                     {"total", statistics.total}};
  constexpr int kIndent = 2;
  return json.dump(kIndent, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace gridrt
