// Clocks of a ray, measured at the engine's ray and hit ports: a ray is always offered, a hit
// always taken, from the first ray in to the last hit out. Compares every answer with the software
// PEs'. tools/board-cycles runs it and prints tables; it prints a JSON object a line, one for each
// wave.
#include <algorithm>
#include <array>
#include <cstdio>
#include <string>
#include <string_view>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "host/image/image.hpp"
#include "host/scene/load.hpp"
#include "tests/rtl/board_rays.hpp"
#include "tests/rtl/engine_harness.hpp"

namespace gridrt::rtl {
namespace {

struct Options {
  std::string scene;
  WaveOptions waves;
  std::string kinds = "primary,shadow,mirror,random";
  std::string order = "spread";
  std::string mapping = "measured";
};

int complain(const Error& error) {
  fmt::print(stderr, "engine-cycles: {}\n", error.message);
  return 3;
}

/// Rays as records with local ids.
std::vector<protocol::RayCompact> records(const RayWave& wave,
                                          const std::vector<std::uint32_t>& global_ids) {
  std::vector<protocol::RayCompact> out;
  for (const Segment& s : wave.segments) {
    const auto at = std::ranges::lower_bound(global_ids, s.ignore);
    const bool known = at != global_ids.end() && *at == s.ignore;
    const auto local = known ? static_cast<std::uint32_t>(at - global_ids.begin()) : kNoTriangle;
    out.push_back(engine_ray(s, local, wave.query == Query::kAnyHit));
  }
  return out;
}

long wrong_answers(const RayWave& wave, const EngineAnswers& got,
                   const std::vector<std::uint32_t>& global_ids) {
  long wrong = static_cast<long>(wave.answers.size() - got.hits.size());
  for (std::size_t i = 0; i < got.hits.size(); ++i) {
    const protocol::HitCompact& hit = got.hits[i];
    std::int64_t id = -1;
    if (hit.hit != 0) id = wave.query == Query::kAnyHit ? hit.id : global_ids.at(hit.id);
    if (id != wave.answers[i]) ++wrong;
  }
  return wrong;
}

void print(const Options& options, const Image& image, const RayWave& wave,
           const EngineAnswers& got, long wrong) {
  const EngineCounts& c = got.counts;
  const protocol::ImageHeader& h = image.header;
  auto pes = nlohmann::json::array();
  for (const PeWork& pe : got.pes) {
    pes.push_back({{"tests", pe.tests}, {"work", pe.clocks}});
  }
  const nlohmann::ordered_json line{
      {"scene", options.scene},
      {"triangles", h.local_ids},
      {"grid", fmt::format("{}x{}x{}", h.grid_count[0], h.grid_count[1], h.grid_count[2])},
      {"wave", wave.name},
      {"rays", wave.segments.size()},
      {"hits", std::ranges::count_if(wave.answers, [](std::int32_t id) { return id >= 0; })},
      {"clocks", got.clocks},
      {"steps", c.steps},
      {"tests", c.tests},
      {"masked", c.masked},
      {"interrupts", c.interrupts},
      {"feedback_waits", c.feedback_waits},
      {"no_ray", c.no_ray},
      {"no_slot", c.no_slot},
      {"traversal_idle", c.traversal_idle},
      {"queue_full", c.queue_full},
      {"pe_idle", c.pe_idle},
      {"divider_busy", c.divider_busy},
      {"hit_wait", c.hit_wait},
      {"in_flight", c.in_flight},
      {"pes", pes},
      {"wrong", wrong}};
  fmt::print("{}\n", line.dump());
  std::fflush(stdout);
}

int run(const Options& options) {
  const auto scene = load_scene(options.scene);
  if (!scene) return complain(scene.error());
  const auto mapping = parse_mapping(options.mapping);
  if (!mapping) return complain(mapping.error());
  ImageOptions cut;
  cut.layout = protocol::Layout::kCompact;
  cut.bits = GRIDRT_RTL_B;
  cut.pes = GRIDRT_RTL_PES;
  cut.mapping = *mapping;
  cut.with_scene = false;
  const auto image = build_image(*scene, cut);
  if (!image) return complain(image.error());
  const auto triangles = decode_triangles(*image);
  if (!triangles) return complain(triangles.error());
  const auto waves = make_waves(*scene, options.waves);
  if (!waves) return complain(waves.error());
  EngineHarness engine;
  engine.load(*image);
  long wrong = 0;
  for (const RayWave& wave : *waves) {
    const std::string kind = wave.name.substr(0, wave.name.find(' '));
    if (options.kinds.find(kind) == std::string::npos || wave.segments.empty()) continue;
    const EngineAnswers got = engine.trace(records(wave, triangles->global_ids));
    const long bad = wrong_answers(wave, got, triangles->global_ids);
    print(options, *image, wave, got, bad);
    wrong += bad;
  }
  return wrong == 0 ? 0 : 1;
}

}  // namespace
}  // namespace gridrt::rtl

int main(int argc, char** argv) {
  using gridrt::rtl::RayOrder;
  gridrt::rtl::Options options;
  CLI::App app{"Clocks of a ray at the ports of the simulated engine, a JSON object for each wave"};
  app.add_option("scene", options.scene, "a mesh that fits the board, or builtin:NAME")->required();
  app.add_option("--rays", options.waves.most, "of each wave at the most; 0: all");
  app.add_option("--views", options.waves.views, "of four")->check(CLI::Range(1, 4));
  app.add_option("--width", options.waves.width)->check(CLI::Range(1, 4096));
  app.add_option("--height", options.waves.height)->check(CLI::Range(1, 4096));
  app.add_option("--kinds", options.kinds, "of primary,shadow,mirror,random");
  app.add_option("--order", options.order)->check(CLI::IsMember({"spread", "lines", "tiles"}));
  app.add_option("--mapping", options.mapping, "of voxels to PEs");
  CLI11_PARSE(app, argc, argv);
  if (options.order == "lines") options.waves.order = RayOrder::kLines;
  if (options.order == "tiles") options.waves.order = RayOrder::kTiles;
  return gridrt::rtl::run(options);
}
