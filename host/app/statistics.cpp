#include "host/app/statistics.hpp"

#include <nlohmann/json.hpp>

#include "host/app/parse.hpp"
#include "host/grid/partition.hpp"

namespace gridrt {
namespace {

using Json = nlohmann::ordered_json;

/// What the workers of a software device have exchanged, and what working together cost.
void add_exchange(Json& json, const DeviceCounters& counters) {
  const protocol::ExchangeReport& e = counters.exchange;
  const protocol::AheadReport& a = counters.ahead;
  const auto seconds = [](std::uint64_t ns) { return static_cast<double>(ns) * 1e-9; };
  const auto per = [](std::uint64_t count, double of) -> Json {
    if (of <= 0.0) return nullptr;
    return static_cast<double>(count) / of;
  };
  const auto rays = static_cast<double>(counters.rays);
  const std::uint64_t waiting = e.barrier_ns + e.message_ns + e.wait_ns;
  json["exchange"] = {{"interrupts_sent", a.interrupts_sent},
                      {"feedbacks_sent", a.feedbacks_sent},
                      {"tests_ahead", a.tests_ahead},
                      {"tests_aborted", a.tests_aborted},
                      {"aborted_seconds", seconds(a.aborted_ns)},
                      {"barriers", e.barriers},
                      {"barrier_seconds", seconds(e.barrier_ns)},
                      {"messages", e.messages},
                      {"message_bytes", e.message_bytes},
                      {"message_seconds", seconds(e.message_ns)},
                      {"wait_seconds", seconds(e.wait_ns)},
                      {"worker_seconds", seconds(e.worker_ns)},
                      {"synchronisation_share", per(waiting, static_cast<double>(e.worker_ns))},
                      {"barrier_share", per(e.barrier_ns, static_cast<double>(e.worker_ns))},
                      {"messages_per_thousand_rays", per(e.messages, rays * 1e-3)},
                      {"bytes_per_ray", per(e.message_bytes, rays)}};
}

}  // namespace

std::string statistics_json(const HostOptions& options, const PreparedScene& prepared,
                            const RunStatistics& statistics) {
  const auto& header = prepared.image().header;
  const RenderReport& report = statistics.report;
  const DeviceCounters& counters = statistics.counters;
  const glm::ivec3 grid = prepared.image().grid().count;
  Json json;
  json["version"] = GRIDRT_VERSION;
  json["scene"] = options.scene;
  json["device"] = statistics.device;
  json["schedule"] = nullptr;  // a board has none
  if (counters.cycles == 0) {
    json["schedule"] =
        options.schedule.empty() ? default_schedule(statistics.device) : options.schedule;
  }
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
  add_exchange(json, counters);
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
