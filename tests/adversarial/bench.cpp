#include "tests/adversarial/bench.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "host/driver/chunked_device.hpp"
#include "host/driver/image_options.hpp"
#include "tests/adversarial/bridge.hpp"
#include "tests/adversarial/devices.hpp"

namespace gridrt::adversarial {
namespace {

std::string describe(const Segment& s) {
  return fmt::format("({}, {}, {}) to ({}, {}, {}), t {:a} to {:a}, ignoring {}", s.p0.x, s.p0.y,
                     s.p0.z, s.p1.x, s.p1.y, s.p1.z, s.t0, s.t1,
                     s.ignore == kNoTriangle ? -1 : std::int64_t{s.ignore});
}

std::string describe(const Ray& r) {
  return fmt::format("origin ({:a}, {:a}, {:a}), direction ({:a}, {:a}, {:a}), t {:a} to {:a}",
                     r.origin.x, r.origin.y, r.origin.z, r.direction.x, r.direction.y,
                     r.direction.z, r.tmin, r.tmax);
}

/// What is wrong with the engine's segment; empty if nothing.
std::string compare(const Segment& got, const truth::Segment& expected) {
  if (got.is_miss() != expected.miss()) {
    return expected.miss() ? "the ray misses the box" : "the ray does not miss the box";
  }
  if (expected.miss()) return {};
  if (to_truth(got.p0) != expected.p0 || to_truth(got.p1) != expected.p1) {
    const auto& a = expected.p0;
    const auto& b = expected.p1;
    return fmt::format("the end points are ({}, {}, {}) and ({}, {}, {})", a[0], a[1], a[2], b[0],
                       b[1], b[2]);
  }
  if (!truth::close(got.t0, expected.t0, 1e-13) || !truth::close(got.t1, expected.t1, 1e-13)) {
    return fmt::format("t0 and t1 are about {:a} and {:a}", expected.t0.get_d(),
                       expected.t1.get_d());
  }
  return {};
}

std::string compare(const Hit& got, const truth::Segment& segment,
                    const std::optional<truth::Closest>& expected) {
  if (!expected) {
    const bool right = got.id == -1 && got.t == std::numeric_limits<double>::infinity() &&
                       got.u == 0.0 && got.v == 0.0;
    return right ? ""
                 : fmt::format("answer {} (t {}, u {}, v {}), truth: a miss", got.id, got.t, got.u,
                               got.v);
  }
  if (got.id != expected->id) {
    return fmt::format("answer {} (t {:a}), truth {} (quotient {})", got.id, got.t, expected->id,
                       expected->quotient);
  }
  return truth::check_parameters(segment, expected->meeting, got.t, got.u, got.v);
}

std::string compare_any(const Hit& got, bool expected) {
  const bool right =
      got.id == (expected ? 0 : -1) && std::isnan(got.t) && std::isnan(got.u) && std::isnan(got.v);
  return right ? ""
               : fmt::format("any hit {} (t {}, u {}, v {}), truth {}", got.id, got.t, got.u, got.v,
                             expected);
}

/// Which of a number of rays the device gets first: not always ray 0, and one at least.
std::size_t first_traced(std::size_t rays) {
  return rays == 0 ? 0 : rays % std::min(rays_per_traced_one(), rays);
}

/// Whether the device gets ray `i`, and so whether there is an answer of its to be compared.
bool is_traced(std::size_t i, std::size_t rays) {
  return i % rays_per_traced_one() == first_traced(rays);
}

}  // namespace

Configuration random_configuration(Random& random, int bits) {
  constexpr std::array<int, 4> kPes{1, 2, 4, 8};
  constexpr std::array<std::size_t, 5> kBatches{1, 7, 64, 1000, 8192};
  constexpr std::array<Mapping, 3> kMappings{Mapping::kBoxes, Mapping::kContiguous,
                                             Mapping::kVoxel};
  Configuration s;
  const std::vector<std::string> asked = asked_devices();
  s.device.name = random.chance(0.6) ? "seq" : random.chance(0.7) ? "omp" : "seq-board";
  if (!asked.empty()) s.device.name = asked[random.below(asked.size())];
  s.device.threads = random.between(1, 3);
  if (s.device.name == "omp" && s.device.threads != 2) s.device.schedule = "pes";
  s.device.rays_per_frame = kBatches[1 + random.below(4)];
  if (random.chance(0.02)) s.device.rays_per_frame = 1;
  s.device.frames_in_flight = random.between(1, 6);
  s.image.bits = bits;
  s.image.pes = kPes[random.below(4)];
  s.image.mapping = kMappings[random.below(3)];
  s.image.with_scene = false;
  if (random.chance(0.7)) {
    const int most = random.chance(0.5) ? 6 : 24;
    const int x = random.between(1, most);
    const int y = random.between(1, most);
    s.image.grid = glm::ivec3{x, y, random.between(1, most)};
  }
  if (random.chance(0.3) && bits <= kMaxCompactBits && s.image.pes <= 4) {
    s.image.layout = protocol::Layout::kCompact;
  }
  return s;
}

std::string describe(const Configuration& s) {
  const glm::ivec3 g = s.image.grid.value_or(glm::ivec3{0});
  return fmt::format(
      "device {} {} ({} threads, {} rays a frame, {} in flight), {} bits, grid {}x{}x{}, {} PEs, "
      "mapping {}, {}",
      s.device.name, s.device.schedule, s.device.threads, s.device.rays_per_frame,
      s.device.frames_in_flight, s.image.bits, g.x, g.y, g.z, s.image.pes,
      mapping_name(s.image.mapping),
      s.image.layout == protocol::Layout::kCompact ? "compact" : "wide");
}

void Tally::add(std::string difference) {
  if (differences++ == 0) first = std::move(difference);
}

Tally& Tally::operator+=(const Tally& other) {
  rays += other.rays;
  hits += other.hits;
  if (differences == 0) first = other.first;
  differences += other.differences;
  return *this;
}

Result<SceneImages> Bench::build(const Scene& scene) {
  const protocol::CapabilitiesReport& can = device_->capabilities();
  ImageOptions& wanted = configuration_.image;
  wanted.bits = std::min<int>(wanted.bits, can.max_bits);
  wanted.pes = std::min<int>(wanted.pes, can.pes);
  if (((can.layouts >> static_cast<unsigned>(wanted.layout)) & 1U) == 0) {
    wanted.layout = protocol::Layout::kNone;
  }
  const MemorySizes memory = wanted.memory.value_or(memory_sizes(can));
  wanted = options_for(wanted, can);
  wanted.memory = smaller_of(memory, *wanted.memory);
  Result<SceneImages> images = build_scene_images(scene, wanted);
  if (!images && images.error().kind == ErrorKind::kLimit && wanted.grid) {
    wanted.grid.reset();
    images = build_scene_images(scene, wanted);
  }
  return images;
}

Result<Bench> Bench::open(const Scene& scene, const Configuration& configuration) {
  Bench bench;
  bench.configuration_ = configuration;
  auto device = open_device(configuration.device);
  if (!device) return std::unexpected(std::move(device.error()));
  bench.device_ = std::move(*device);
  auto images = bench.build(scene);
  if (!images) return std::unexpected(std::move(images.error()));
  bench.images_ = std::make_shared<const SceneImages>(std::move(*images));
  bench.lattice_ = bench.images_->front().lattice();
  bench.grid_ = bench.images_->front().grid();
  auto loaded = load_images(std::move(bench.device_), bench.images_);
  if (!loaded) return std::unexpected(std::move(loaded.error()));
  bench.device_ = std::move(*loaded);
  if (rays_per_traced_one() > 1) {
    DeviceOptions options;
    options.name = "seq";
    auto stand_in = open_device(options);
    if (!stand_in) return std::unexpected(std::move(stand_in.error()));
    bench.stand_in_ = std::move(*stand_in);
    ImageOptions wide = bench.configuration_.image;
    wide.layout = protocol::Layout::kWide;
    wide.memory.reset();
    const auto whole = build_image(scene, wide);
    if (!whole) return std::unexpected(whole.error());
    if (auto done = bench.stand_in_->load(*whole); !done) {
      return std::unexpected(std::move(done.error()));
    }
  }
  const auto search = scene.triangles.size() > 100 ? truth::Search::kPruned : truth::Search::kAll;
  bench.truth_ = std::make_unique<truth::Tracer>(scene, bench.configuration_.image.bits, search);
  return bench;
}

Result<void> Bench::trace(std::span<const Segment> segments, Query query,
                          std::span<Hit> hits) const {
  if (!stand_in_) return device_->trace(segments, query, hits);
  if (auto done = stand_in_->trace(segments, query, hits); !done) return done;
  const std::size_t step = rays_per_traced_one();
  std::vector<Segment> part;
  std::vector<std::size_t> places;
  for (std::size_t i = first_traced(segments.size()); i < segments.size(); i += step) {
    part.push_back(segments[i]);
    places.push_back(i);
  }
  std::vector<Hit> answers(part.size());
  if (auto done = device_->trace(part, query, answers); !done) return done;
  for (std::size_t i = 0; i < part.size(); ++i) hits[places[i]] = answers[i];
  return {};
}

std::vector<Hit> Bench::check_rays(std::span<const Ray> rays, Tally& tally,
                                   std::span<const Segment> also) const {
  std::vector<Segment> segments;
  std::vector<truth::Segment> expected;
  segments.reserve(rays.size());
  expected.reserve(rays.size());
  for (const Ray& ray : rays) {
    if (auto valid = validate(ray); !valid) {
      tally.add("refused: " + describe(ray) + ": " + valid.error().message);
    }
    segments.push_back(make_segment(lattice_, ray));
    if (!is_traced(segments.size() - 1, rays.size() + also.size())) {
      expected.emplace_back();
      continue;
    }
    expected.push_back(truth::cut(truth_->lattice(), to_truth(ray)));
    if (const auto wrong = compare(segments.back(), expected.back()); !wrong.empty()) {
      tally.add(fmt::format("{}\n  ray {}\n  segment {}\n  truth: {}", describe(configuration_),
                            describe(ray), describe(segments.back()), wrong));
    }
  }
  for (const Segment& s : also) {
    segments.push_back(s);
    expected.push_back(to_truth(s));
  }
  return check(segments, expected, tally);
}

std::vector<Hit> Bench::check_segments(std::span<const Segment> segments, Tally& tally) const {
  std::vector<truth::Segment> expected;
  expected.reserve(segments.size());
  for (const Segment& s : segments) expected.push_back(to_truth(s));
  return check(segments, expected, tally);
}

std::vector<Hit> Bench::check(std::span<const Segment> segments,
                              std::span<const truth::Segment> expected, Tally& tally) const {
  std::vector<Hit> hits(segments.size());
  std::vector<Hit> any(segments.size());
  for (const auto& [query, out] :
       {std::pair{Query::kClosestHit, &hits}, std::pair{Query::kAnyHit, &any}}) {
    if (auto done = trace(segments, query, *out); !done) {
      tally.add(fmt::format("{}\n  {}", describe(configuration_), done.error().message));
      return hits;
    }
  }
  for (std::size_t i = first_traced(segments.size()); i < segments.size();
       i += rays_per_traced_one()) {
    const auto closest = truth_->closest(expected[i]);
    ++tally.rays;
    tally.hits += closest ? 1 : 0;
    for (const auto& wrong :
         {compare(hits[i], expected[i], closest), compare_any(any[i], closest.has_value())}) {
      if (wrong.empty()) continue;
      tally.add(fmt::format("{}\n  segment {}\n  {}", describe(configuration_),
                            describe(segments[i]), wrong));
    }
  }
  return hits;
}

}  // namespace gridrt::adversarial
