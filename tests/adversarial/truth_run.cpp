// Many rays over random scenes and configurations, every answer compared with the truth.
#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <map>
#include <mutex>
#include <optional>
#include <thread>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "host/scene/load.hpp"
#include "tests/adversarial/meshes.hpp"
#include "tests/adversarial/rays.hpp"
#include "tests/adversarial/walk.hpp"

namespace gridrt::adversarial {
namespace {

constexpr std::size_t kRaysPerUnit = 20000;  ///< about; a unit is one scene in one configuration

struct Options {
  std::size_t rays = 100'000'000;
  int threads = 0;
  std::uint64_t seed = 1;
  std::vector<std::string> meshes;
};

/// One scene in one configuration, all of it from `random`.
class Unit {
 public:
  Unit(const Options& options, Random random) : options_(options), random_(random) {}

  /// Runs it; `kind()` then tells what it was.
  Tally run() {
    switch (random_.below(10)) {
      case 0:
        return sheets();
      case 1:
        return rooms();
      case 2:
        return random_.chance(0.3) ? mesh() : mixture();
      default:
        return mixture();
    }
  }

  [[nodiscard]] const std::string& kind() const { return kind_; }

 private:
  /// Opens a bench and uses it; what goes wrong becomes a difference.
  template <class Use>
  Tally with(const Scene& scene, int bits, const Use& use) {
    Tally tally;
    Configuration configuration = random_configuration(random_, bits);
    // Coarse grids over many triangles only take time.
    if (scene.triangles.size() > 1000) configuration.image.grid.reset();
    const auto bench = Bench::open(scene, configuration);
    if (!bench) {
      tally.add(describe(configuration) + ": " + bench.error().message);
    } else {
      use(*bench, tally);
    }
    return tally;
  }

  int any_bits() { return random_.chance(0.5) ? kDefaultBits : random_.between(6, 24); }

  Tally rays_of_all_kinds(const Scene& scene, int bits) {
    return with(scene, bits, [&](const Bench& bench, Tally& tally) {
      bench.check_rays(
          any_rays(scene, bench.truth().lattice(), bench.grid(), kRaysPerUnit / 2, random_), tally);
      bench.check_segments(exact_segments(bench.truth(), kRaysPerUnit / 2, random_), tally);
    });
  }

  Tally mixture() {
    const int most = 4 << random_.between(0, 9);
    NamedScene named = any_scene(random_, most);
    kind_ = named.name;
    if (random_.chance(0.2)) {  // twice, so that coincident triangles abound
      kind_ += ", doubled";
      const Scene once = named.scene;
      add_scene(named.scene, once);
    }
    return rays_of_all_kinds(named.scene, any_bits());
  }

  Tally mesh() {
    const std::string& spec = options_.meshes[random_.below(options_.meshes.size())];
    kind_ = spec.substr(spec.find_last_of('/') + 1);
    const auto scene = load_scene(spec);
    if (!scene) {
      Tally tally;
      tally.add(scene.error().message);
      return tally;
    }
    return rays_of_all_kinds(*scene, any_bits());
  }

  /// Case 1: a raster from a jittered origin; a ray that gets through is a difference.
  Tally sheets() {
    kind_ = "closed sheet, from above";
    const Scene scene = sheet(1 << random_.between(0, 7), 0.3, random_);
    return with(scene, kDefaultBits, [&](const Bench& bench, Tally& tally) {
      const glm::dvec3 eye = random_.in_box({-0.5, -0.5, 0.5}, {1.5, 1.5, 2.0});
      std::vector<Ray> rays(kRaysPerUnit);
      for (Ray& ray : rays) ray = {eye, random_.in_box({0.01, 0.01, 0}, {0.99, 0.99, 0}) - eye};
      for (const Hit& hit : bench.check_rays(rays, tally)) {
        if (hit.id < 0) tally.add("a ray passes a closed sheet");
      }
    });
  }

  /// Cases 25 and 26: mirrors in an axis-aligned room; a ray that escapes is a difference.
  Tally rooms() {
    kind_ = "mirrored room, to depth 32";
    const Scene scene = box(random_.between(1, 6), {-1, 0.25F, 2}, {1.5F, 1.75F, 4.5F});
    return with(scene, random_.between(10, 24), [&](const Bench& bench, Tally& tally) {
      std::vector<Ray> rays(kRaysPerUnit / 33);
      for (Ray& ray : rays) {
        ray = {random_.in_box({-0.9, 0.3, 2.1}, {1.4, 1.7, 4.4}), random_.direction()};
      }
      auto paths = start_paths(bench, rays, tally);
      for (int depth = 0; depth < 32; ++depth) {
        for (const Path& path : paths) {
          if (path.hit.id < 0) tally.add("a ray escapes from a sealed room");
        }
        const auto mirror = [](const Path& path, const glm::dvec3&, const glm::dvec3& normal) {
          Turn turn{path.ray.direction};
          for (int i = 0; i < 3; ++i) {
            if (normal[i] != 0.0) turn.direction[i] = -turn.direction[i];
          }
          return std::optional(turn);
        };
        paths = next_paths(bench, paths, mirror, tally);
      }
    });
  }

  const Options& options_;
  Random random_;
  std::string kind_;
};

struct Totals {
  std::map<std::string, Tally> kinds;
  Tally all;
  std::size_t units = 0;
};

Totals run_units(const Options& options) {
  const std::size_t units = (options.rays + kRaysPerUnit - 1) / kRaysPerUnit;
  Totals totals;
  std::mutex mutex;
  std::atomic<std::size_t> next{0};
  std::atomic<std::size_t> reached{0};
  const auto work = [&] {
    // Units are a little smaller or larger than planned: go on until the rays are reached.
    while (reached < options.rays) {
      const std::size_t number = next++;
      Unit unit(options, Random(options.seed * 1'000'003 + number));
      const Tally tally = unit.run();
      reached += tally.rays;
      const std::scoped_lock lock(mutex);
      totals.kinds[unit.kind()] += tally;
      totals.all += tally;
      if (tally.differences > 0) {
        fmt::print(stderr, "truth-run: unit {} ({}): {}\n", number, unit.kind(), tally.first);
      }
      ++totals.units;
      if (totals.units * 10 / units != (totals.units - 1) * 10 / units) {
        fmt::print(stderr, "truth-run: {} rays\n", totals.all.rays);
      }
    }
  };
  const unsigned cores = std::max(1U, std::thread::hardware_concurrency());
  std::vector<std::thread> workers;
  for (unsigned i = 0; i < (options.threads > 0 ? static_cast<unsigned>(options.threads) : cores);
       ++i) {
    workers.emplace_back(work);
  }
  for (std::thread& worker : workers) worker.join();
  return totals;
}

void print(const Options& options, const Totals& totals, double seconds) {
  fmt::print("Devices against the truth: closest hits (id, t, u, v), any hits and segments.\n");
  fmt::print("seed {}, {} scenes and configurations, {:.0f} s\n\n", options.seed, totals.units,
             seconds);
  fmt::print("{:<32} {:>12} {:>12} {:>12}\n", "scenes", "rays", "hits", "differences");
  const auto row = [](const std::string& name, const Tally& tally) {
    fmt::print("{:<32} {:>12} {:>12} {:>12}\n", name, tally.rays, tally.hits, tally.differences);
  };
  for (const auto& [name, tally] : totals.kinds) row(name, tally);
  row("all", totals.all);
  if (totals.all.differences == 0) {
    // No event in n trials: at 95 % confidence its rate is below 3/n.
    fmt::print("\nzero differences: at 95 % confidence fewer than {:.2g} of such rays differ\n",
               3.0 / static_cast<double>(totals.all.rays));
  } else {
    fmt::print("\nfirst difference: {}\n", totals.all.first);
  }
}

}  // namespace
}  // namespace gridrt::adversarial

int main(int argc, char** argv) {
  using namespace gridrt::adversarial;
  Options options;
  CLI::App app("Compares devices with the truth on many rays over random scenes.");
  app.add_option("--rays", options.rays, "how many rays")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  app.add_option("--threads", options.threads, "worker threads, 0: all cores")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  app.add_option("--seed", options.seed, "other scenes and rays")->capture_default_str();
  app.add_option("meshes", options.meshes, "mesh files to trace beside the built-in scenes");
  CLI11_PARSE(app, argc, argv);
  for (const char* name : {"builtin:teapot", "builtin:room", "builtin:sphere"}) {
    options.meshes.emplace_back(name);
  }
  const auto start = std::chrono::steady_clock::now();
  const Totals totals = run_units(options);
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
  print(options, totals, seconds.count());
  return totals.all.differences == 0 ? 0 : 1;
}
