// GridRT beside Embree 3: the same scenes, the same rays, the same run.
#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <ctime>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "host/grid/patient_threads.hpp"
#include "host/image/image.hpp"
#include "host/pe/ray_stream.hpp"
#include "host/scene/load.hpp"
#include "tests/bench/contender.hpp"

namespace gridrt::bench {
namespace {

struct Options {
  std::string mesh = "builtin:teapot";
  int copies = 18;
  int width = 512;
  int height = 512;
  int rounds = 5;
  std::string clock = "wall";
  std::string simd;
  std::vector<int> threads{1, 2};
};

double now(const Options& options, int threads) {
  if (options.clock == "wall") {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch())
        .count();
  }
  timespec t{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return (static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec)) / threads;
}

/// The best of each contender, all in turn in each round, so that what disturbs the machine
/// disturbs all.
template <class Run>
std::vector<double> best_times(const Options& options, std::size_t contenders, int threads,
                               const Run& run) {
  std::vector<double> best(contenders, 1e99);
  for (int round = 0; round < options.rounds; ++round) {
    for (std::size_t i = 0; i < contenders; ++i) {
      const double start = now(options, threads);
      run(i);
      best[i] = std::min(best[i], now(options, threads) - start);
    }
  }
  return best;
}

std::vector<Hit> closest_hits(const Scene& scene, const RaySet& rays) {
  const Image image = build_image(scene, {.with_scene = false}).value();
  std::vector<Segment> segments;
  for (const Ray& ray : rays.rays) segments.push_back(make_segment(image.lattice(), ray));
  std::vector<Hit> hits(segments.size());
  const auto device = open_device({.name = "omp"}).value();
  if (!device->load(image) || !device->trace(segments, Query::kClosestHit, hits)) std::abort();
  return hits;
}

void run_scene(const Options& options, const std::string& name, const Scene& scene) {
  std::vector<std::unique_ptr<Contender>> all;
  for (const Part part : {Part::kPes, Part::kDevice, Part::kProgram}) {
    all.push_back(gridrt_contender({.part = part, .simd = options.simd}));
  }
  all.push_back(embree_contender(1, false));
  all.push_back(embree_contender(16, false));
  constexpr std::size_t kEmbree = 3;
  fmt::print("\n{}: {} triangles\n", name, scene.triangles.size());
  for (const int threads : options.threads) {
    const std::array<std::size_t, 2> builders{1, kEmbree};
    for (auto& contender : all) contender->build(scene, threads);
    const auto build = best_times(options, builders.size(), threads,
                                  [&](std::size_t i) { all[builders[i]]->build(scene, threads); });
    fmt::print("  {} thread{}, build: GridRT {:.1f} ms, Embree {:.1f} ms, ratio {:.2f}\n", threads,
               threads > 1 ? "s" : "", 1e3 * build[0], 1e3 * build[1], build[1] / build[0]);
    const RaySet primary = primary_rays(scene, options.width, options.height);
    const std::vector<Hit> hits = closest_hits(scene, primary);
    for (const RaySet& set : {primary, shuffled(primary), bounced_rays(scene, primary, hits)}) {
      for (auto& contender : all) contender->prepare(set);
      const auto times =
          best_times(options, all.size(), threads, [&](std::size_t i) { all[i]->trace(threads); });
      const auto n = static_cast<double>(set.rays.size());
      const auto ids = all[0]->ids();
      for (std::size_t i = 0; i < all.size(); ++i) {
        const auto other = all[i]->ids();
        std::size_t differ = 0;
        for (std::size_t j = 0; j < ids.size(); ++j) differ += ids[j] != other[j] ? 1 : 0;
        fmt::print(
            "  {:<9} {} thr  {:<26} {:8.3f} Mray/s  x single {:5.2f}  x packets {:5.2f}"
            "  other ids {:.4f} %\n",
            set.name, threads, all[i]->name(), n / times[i] * 1e-6, times[kEmbree] / times[i],
            times[kEmbree + 1] / times[i], 100.0 * static_cast<double>(differ) / n);
        std::fflush(stdout);
      }
    }
  }
}

int run(const Options& options) {
  const auto mesh = load_scene(options.mesh);
  if (!mesh) {
    fmt::print(stderr, "bench: {}\n", mesh.error().message);
    return 1;
  }
  fmt::print("{} x {} rays a set, best of {} rounds, clock: {}, vectors: {}\n", options.width,
             options.height, options.rounds, options.clock,
             options.simd.empty() ? stream_kernel("")->name : options.simd);
  const std::string name = options.mesh.substr(options.mesh.find_last_of('/') + 1);
  run_scene(options, name, repeat(*mesh, 1));
  if (options.copies > 1) {
    run_scene(options, fmt::format("{} x {}", options.copies, name), repeat(*mesh, options.copies));
  }
  return 0;
}

}  // namespace
}  // namespace gridrt::bench

int main(int argc, char** argv) {
  gridrt::wait_patiently(argv);
  gridrt::bench::Options options;
  CLI::App app("Times GridRT and Embree 3 on the same rays in the same run.");
  app.add_option("mesh", options.mesh, "a mesh file or a built-in scene")->capture_default_str();
  app.add_option("--copies", options.copies, "the second scene: so many copies; 1: none")
      ->capture_default_str();
  app.add_option("--width", options.width, "of the picture")->capture_default_str();
  app.add_option("--height", options.height, "of the picture")->capture_default_str();
  app.add_option("--rounds", options.rounds, "the best of so many")->capture_default_str();
  app.add_option("--threads", options.threads, "numbers of threads")->capture_default_str();
  app.add_option("--simd", options.simd, "kind of vectors of GridRT: plain, sse4, avx2, avx512");
  app.add_option("--clock", options.clock,
                 "wall, or cpu: processor time by the number of threads, for a busy machine")
      ->check(CLI::IsMember({"wall", "cpu"}))
      ->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  return gridrt::bench::run(options);
}
