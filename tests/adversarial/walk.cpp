#include "tests/adversarial/walk.hpp"

#include <cmath>

#include "host/grid/intersect.hpp"
#include "tests/adversarial/bridge.hpp"

namespace gridrt::adversarial {
namespace {

std::vector<Path> traced(const Bench& bench, std::vector<Path> paths, Tally& tally) {
  std::vector<Segment> segments;
  std::vector<truth::Segment> expected;
  for (const Path& path : paths) {
    segments.push_back(path.segment);
    expected.push_back(path.expected);
  }
  const auto hits = bench.check(segments, expected, tally);
  for (std::size_t i = 0; i < paths.size(); ++i) paths[i].hit = hits[i];
  return paths;
}

}  // namespace

std::vector<Path> start_paths(const Bench& bench, std::span<const Ray> rays, Tally& tally) {
  std::vector<Path> paths;
  for (const Ray& ray : rays) {
    paths.push_back({ray,
                     make_segment(bench.lattice(), ray),
                     truth::cut(bench.truth().lattice(), to_truth(ray)),
                     {}});
  }
  return traced(bench, std::move(paths), tally);
}

glm::dvec3 scene_normal(const Bench& bench, std::int32_t id) {
  const auto n = truth::normal_of(bench.truth().triangles()[static_cast<std::size_t>(id)]);
  const auto& shift = bench.truth().lattice().shift;
  glm::dvec3 out;
  for (int i = 0; i < 3; ++i) {
    const auto axis = static_cast<std::size_t>(i);
    out[i] = std::ldexp(static_cast<double>(n[axis]), shift[axis] - shift[0]);
  }
  return out;
}

std::vector<Path> continue_paths(const Bench& bench, std::span<const Path> paths,
                                 std::span<const Turn> turns, Tally& tally) {
  const truth::Lattice& lattice = bench.truth().lattice();
  std::vector<Path> out;
  for (std::size_t i = 0; i < paths.size(); ++i) {
    const Path& path = paths[i];
    Path next;
    next.ray.origin = path.ray.origin + path.hit.t * path.ray.direction;
    next.ray.direction = turns[i].direction;
    next.ray.tmax = turns[i].tmax;
    const auto id = static_cast<std::size_t>(path.hit.id);
    const truth::Triangle& triangle = bench.truth().triangles()[id];
    const glm::dvec3& d = next.ray.direction;

    const auto start = secondary_origin(bench.lattice(), path.segment, to_engine(triangle), d);
    const auto true_start = truth::secondary_start(lattice, path.expected.p0, path.expected.p1,
                                                   triangle, {d.x, d.y, d.z});
    if (start.has_value() != true_start.has_value() || (start && to_truth(*start) != *true_start)) {
      tally.add("a secondary ray starts elsewhere than it should");
      continue;
    }
    if (start) {
      next.segment = make_secondary_segment(bench.lattice(), next.ray, *start, to_engine(triangle),
                                            static_cast<std::uint32_t>(id));
      next.expected = truth::cut(lattice, to_truth(next.ray));
      if (next.expected.meets_box) {
        next.expected.p1 =
            truth::secondary_end(lattice, next.expected.p1, triangle, {d.x, d.y, d.z});
      }
      next.expected.p0 = *true_start;
      next.expected.t0 = 0;
      next.expected.ignore = static_cast<std::int64_t>(id);
      const bool same_end = next.expected.miss()
                                ? next.segment.is_miss()
                                : to_truth(next.segment.p0) == next.expected.p0 &&
                                      to_truth(next.segment.p1) == next.expected.p1 &&
                                      next.segment.t0 == 0.0 &&
                                      truth::close(next.segment.t1, next.expected.t1, 1e-13);
      if (!same_end) tally.add("a secondary ray ends elsewhere than it should");
    }
    out.push_back(next);
  }
  return traced(bench, std::move(out), tally);
}

}  // namespace gridrt::adversarial
