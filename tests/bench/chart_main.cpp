// Speed against accuracy: for each method how many rays a second it answers, and which share of
// its answers is not the truth's. A line of CSV for each method and scene.
#include <algorithm>
#include <cstdio>
#include <ctime>
#include <functional>
#include <limits>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "host/grid/patient_threads.hpp"
#include "host/scene/load.hpp"
#include "tests/adversarial/meshes.hpp"
#include "tests/adversarial/rays.hpp"
#include "tests/bench/contender.hpp"
#include "tests/truth/given.hpp"

namespace gridrt::bench {
namespace {

struct Method {
  std::string family;  ///< points of a family are joined in the chart
  std::string name;
  std::function<std::unique_ptr<Contender>()> make;
};

/// A method joins by a line.
std::vector<Method> methods() {
  std::vector<Method> all;
  for (const int bits : {8, 10, 12, 14, 16, 17, 18, 20, 22, 24}) {
    all.push_back({"GridRT", fmt::format("lattice {}", bits),
                   [bits] { return gridrt_contender({.bits = bits}); }});
  }
  all.push_back({"GridRT, within the device", "lattice 17",
                 [] { return gridrt_contender({.part = Part::kPes}); }});
  all.push_back({"GridRT, one ray at a time", "lattice 17",
                 [] { return gridrt_contender({.simd = "plain"}); }});
  all.push_back(
      {"its voxels, plain floats", "fp32", [] { return floating_contender(Precision::kSingle); }});
  all.push_back(
      {"its voxels, plain floats", "fp64", [] { return floating_contender(Precision::kDouble); }});
  all.push_back({"Embree", "default", [] { return embree_contender(1, false); }});
  all.push_back({"Embree", "robust", [] { return embree_contender(1, true); }});
  all.push_back({"Embree, packets of 16", "default", [] { return embree_contender(16, false); }});
  all.push_back({"Embree, packets of 16", "robust", [] { return embree_contender(16, true); }});
  return all;
}

struct Case {
  std::string name;
  Scene scene;
  RaySet timed;    ///< many
  RaySet checked;  ///< few enough for the truth
};

RaySet some_of(const RaySet& rays, std::size_t n) {
  RaySet some = shuffled(rays);
  some.rays.resize(std::min(n, some.rays.size()));
  return some;
}

/// In float32, like those of the workload.
RaySet rounded(std::string name, std::vector<Ray> rays) {
  for (Ray& ray : rays) {
    ray.origin = glm::dvec3{glm::vec3{ray.origin}};
    ray.direction = glm::dvec3{glm::vec3{ray.direction}};
    ray.tmin = 0.0;
    ray.tmax = std::numeric_limits<double>::infinity();
  }
  return {std::move(name), false, std::move(rays)};
}

/// Sheets of 64 to 65,536 triangles side by side.
Scene sheets(adversarial::Random& random) {
  Scene all;
  float at = 0.0F;
  for (const int n : {4, 16, 64, 128}) {
    adversarial::add_scene(all, adversarial::sheet(n, 0.3, random), 1.0F, {at, 0.0F, 0.0F});
    at += 1.25F;
  }
  return all;
}

/// A scene joins by a line.
std::vector<Case> cases(const Scene& mesh, const std::string& name, std::size_t checked) {
  std::vector<Case> all;
  const RaySet primary = primary_rays(mesh, 512, 512);
  all.push_back({name + ", primary rays", mesh, primary, some_of(primary, checked)});
  adversarial::Random random(7);
  const Scene scene = sheets(random);
  const RaySet seen = primary_rays(scene, 512, 512);
  all.push_back({"sheets, primary rays", scene, seen, some_of(seen, checked)});
  const RaySet aimed = rounded("aimed", adversarial::aimed_rays(scene, 200000, random));
  all.push_back({"sheets, rays at edges and vertices", scene, aimed, some_of(aimed, checked)});
  return all;
}

double cpu_seconds() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

struct Truth {
  std::vector<std::vector<std::int64_t>> ids;  ///< of each ray, all that are equally near
};

Truth truth_of(const Case& one) {
  const truth::GivenTracer tracer(one.scene, truth::Search::kPruned);
  Truth out;
  out.ids.resize(one.checked.rays.size());
#pragma omp parallel for schedule(dynamic, 16)
  for (std::size_t i = 0; i < out.ids.size(); ++i) {
    const Ray& r = one.checked.rays[i];
    truth::Ray ray;
    for (int a = 0; a < 3; ++a) {
      ray.origin[static_cast<std::size_t>(a)] = r.origin[a];
      ray.direction[static_cast<std::size_t>(a)] = r.direction[a];
    }
    out.ids[i] = tracer.closest(ray);
  }
  return out;
}

struct Disagreements {
  std::size_t wrong = 0;  ///< all
  std::size_t holes = 0;  ///< those where the truth is a hit and the answer a miss
};

Disagreements compare(const Truth& truth, const std::vector<std::int32_t>& ids) {
  Disagreements out;
  for (std::size_t i = 0; i < ids.size(); ++i) {
    const bool right = ids[i] < 0 ? truth.ids[i].empty()
                                  : std::ranges::count(truth.ids[i], std::int64_t{ids[i]}) > 0;
    out.wrong += right ? 0 : 1;
    out.holes += !right && ids[i] < 0 ? 1 : 0;
  }
  return out;
}

void run(const Scene& mesh, const std::string& name, std::size_t checked, int rounds) {
  fmt::print("scene,family,method,mrays_per_second,wrong,holes,checked\n");
  for (const Case& one : cases(mesh, name, checked)) {
    const Truth truth = truth_of(one);
    for (const Method& method : methods()) {
      const auto contender = method.make();
      contender->build(one.scene, 1);
      contender->prepare(one.checked);
      contender->trace(1);
      const Disagreements differ = compare(truth, contender->ids());
      contender->prepare(one.timed);
      double best = 1e99;
      for (int round = 0; round < rounds; ++round) {
        const double start = cpu_seconds();
        contender->trace(1);
        best = std::min(best, cpu_seconds() - start);
      }
      fmt::print("\"{}\",\"{}\",\"{}\",{:.4f},{},{},{}\n", one.name, method.family, method.name,
                 static_cast<double>(one.timed.rays.size()) / best * 1e-6, differ.wrong,
                 differ.holes, one.checked.rays.size());
      std::fflush(stdout);
    }
  }
}

}  // namespace
}  // namespace gridrt::bench

int main(int argc, char** argv) {
  gridrt::wait_patiently(argv);
  std::string mesh = "builtin:teapot";
  std::size_t checked = 100000;
  int rounds = 3;
  CLI::App app("Speed and share of wrong answers of each method, as CSV.");
  app.add_option("mesh", mesh, "a mesh file or a built-in scene")->capture_default_str();
  app.add_option("--checked", checked, "rays of each scene that are compared with the truth")
      ->capture_default_str();
  app.add_option("--rounds", rounds, "the best time of so many")->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  const auto scene = gridrt::load_scene(mesh);
  if (!scene) {
    fmt::print(stderr, "chart: {}\n", scene.error().message);
    return 1;
  }
  std::string name = mesh.substr(mesh.find_last_of("/:") + 1);
  name = name.substr(0, name.find('.'));
  gridrt::bench::run(*scene, name, checked, rounds);
  return 0;
}
