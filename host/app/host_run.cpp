#include "host/app/host_run.hpp"

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "host/app/npy.hpp"
#include "host/driver/chunked_device.hpp"
#include "host/render/picture.hpp"

namespace gridrt {
namespace {

using Clock = std::chrono::steady_clock;

/// Rays in memory at a time where every batch costs an upload of each chunk that it meets: a
/// picture of 640x480 is one wave of some 250 MB.
constexpr std::size_t kChunkedWave = std::size_t{1} << 19U;
constexpr std::size_t kChunkedStream = std::size_t{1} << 20U;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

Result<void> open_output(const std::string& path, OutputFile& file) {
  if (path.empty()) return {};
  auto created = OutputFile::create(path);
  if (!created) return std::unexpected(created.error());
  file = std::move(*created);
  return {};
}

/// GRIDRT_PES_WITHOUT=interrupt or feedback: switches for measurements (docs/schedules.md).
Result<void> read_pes_switches(DeviceOptions& device) {
  const char* without = std::getenv("GRIDRT_PES_WITHOUT");
  if (without == nullptr || *without == 0) return {};
  const std::string_view word(without);
  device.pes_interrupt = word != "interrupt";
  device.pes_feedback = word != "feedback";
  if (device.pes_interrupt && device.pes_feedback) {
    return fail(ErrorKind::kUsage,
                fmt::format("GRIDRT_PES_WITHOUT={}: expected interrupt or feedback", word));
  }
  return {};
}

}  // namespace

Camera choose_camera(const HostOptions& options, const Scene& scene) {
  const double aspect = static_cast<double>(options.size.x) / options.size.y;
  Camera camera = scene.camera ? *scene.camera : frame_scene(scene, aspect);
  if (options.eye) camera.eye = *options.eye;
  if (options.look) camera.look = *options.look;
  if (options.up) camera.up = *options.up;
  if (options.fov) camera.fov_degrees = *options.fov;
  return camera;
}

Result<void> HostRun::run() {
  const auto start = Clock::now();
  for (const auto step : {&HostRun::open, &HostRun::load, &HostRun::trace}) {
    if (auto done = (this->*step)(); !done) {
      progress_.clear();
      return done;
    }
  }
  progress_.phase("writing");
  const auto write_start = Clock::now();
  auto written = write();
  progress_.clear();
  if (!written) return written;
  statistics_.write = seconds_since(write_start);
  statistics_.total = seconds_since(start);
  if (outputs_.stats.is_open()) {
    const std::string text = statistics_json(options_, prepared_, statistics_);
    if (auto done = outputs_.stats.write(text); !done) return done;
  }
  for (OutputFile* file : {&outputs_.picture, &outputs_.hits, &outputs_.lattice, &outputs_.stats}) {
    if (!file->is_open()) continue;
    if (auto done = file->commit(); !done) return done;
  }
  if (!explanation_.empty() &&
      (std::fputs(explanation_.c_str(), stdout) < 0 || std::fflush(stdout) != 0)) {
    return fail(ErrorKind::kFile, "cannot write to standard output");
  }
  return {};
}

Result<void> HostRun::open() {
  if (!options_.picture.empty()) {
    if (auto format = picture_format(options_.picture); !format) {
      return std::unexpected(format.error());
    }
  }
  DeviceOptions device;
  device.name = options_.device;
  if (device.name == "auto") {
    const AutoChoice choice = choose_device();
    device.name = choice.name;
    if (options_.progress != ProgressMode::kOff) {
      progress_.clear();
      std::fputs(fmt::format("Device {}: {}.\n", choice.name, choice.reason).c_str(), stderr);
    }
  }
  device.schedule = options_.schedule;
  device.threads = options_.threads;
  device.groups = options_.groups;
  device.rays_per_frame = options_.batch;
  device.waves = options_.trace;
  device.flash = options_.flash;
  if (auto read = read_pes_switches(device); !read) return read;
  auto opened = open_device(device);
  if (!opened) return std::unexpected(opened.error());
  device_ = std::move(*opened);
  const std::pair<const std::string*, OutputFile*> files[] = {
      {&options_.picture, &outputs_.picture},
      {&options_.hits, &outputs_.hits},
      {&options_.lattice, &outputs_.lattice},
      {&options_.stats, &outputs_.stats}};
  for (const auto& [path, file] : files) {
    if (auto done = open_output(*path, *file); !done) return done;
  }
  return {};
}

Result<void> HostRun::load() {
  progress_.phase("loading and building");
  auto prepared = prepare_scene(options_.scene, options_.cut, device_->capabilities());
  if (!prepared) return std::unexpected(prepared.error());
  prepared_ = std::move(*prepared);
  progress_.clear();
  print_warnings("gridrt-host", prepared_.scene);
  progress_.phase("sending the image");
  auto ready = load_images(std::move(device_), prepared_.images);
  if (!ready) return std::unexpected(ready.error());
  device_ = std::move(*ready);
  statistics_.load = prepared_.load_seconds;
  statistics_.build = prepared_.build_seconds;
  statistics_.device = device_->name();
  return {};
}

Result<void> HostRun::trace() {
  progress_.phase("tracing");
  const auto before = device_->counters();
  if (!before) return std::unexpected(before.error());
  auto traced = options_.rays.empty() ? trace_picture() : trace_given_rays();
  if (!traced) return traced;
  auto counters = device_->counters();
  if (!counters) return std::unexpected(counters.error());
  statistics_.counters = *counters;
  // Chunks are loaded while rays wait for them.
  statistics_.upload = counters->upload_seconds;
  statistics_.report.trace_seconds -= counters->upload_seconds - before->upload_seconds;
  return {};
}

PrimarySink HostRun::recorder() {
  if (!outputs_.hits.is_open() && !outputs_.lattice.is_open()) return {};
  return [this](std::span<const Ray> rays, std::span<const Segment> segments,
                std::span<const Hit> hits) -> Result<void> {
    if (outputs_.lattice.is_open()) lattice_.add(rays, segments);
    if (outputs_.hits.is_open()) return write_hits(outputs_.hits, hits);
    return {};
  };
}

ProgressSink HostRun::reporter() {
  return [this](std::uint64_t done, std::uint64_t total) { progress_.update(done, total); };
}

StreamOptions HostRun::stream_options() const {
  StreamOptions stream;
  stream.query = options_.any_hit ? Query::kAnyHit : Query::kClosestHit;
  stream.threads = options_.threads;
  if (prepared_.images->chunks.size() > 1) stream.chunk = kChunkedStream;
  return stream;
}

Result<void> HostRun::trace_given_rays() {
  auto reader = NpyRayReader::open(options_.rays);
  if (!reader) return std::unexpected(reader.error());
  if (outputs_.hits.is_open()) {
    if (auto done = outputs_.hits.write(hits_header(reader->count())); !done) return done;
  }
  const StreamOptions stream = stream_options();
  const RaySource source = [&reader](std::uint64_t, std::span<Ray> rays) {
    return reader->read(rays);
  };
  return trace_stream(prepared_.lattice, *device_, reader->count(), source, recorder(), stream,
                      statistics_.report, reporter());
}

Result<void> HostRun::trace_picture() {
  const auto [width, height] = std::pair(options_.size.x, options_.size.y);
  auto camera = PinholeCamera::create(choose_camera(options_, prepared_.scene), width, height);
  if (!camera) return std::unexpected(camera.error());
  if (options_.explain) {
    if (auto done = explain_pixel(*camera); !done) return done;
  }
  const auto total = static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(height) *
                     static_cast<std::uint64_t>(options_.samples);
  if (outputs_.hits.is_open()) {
    if (auto done = outputs_.hits.write(hits_header(total)); !done) return done;
  }
  if (options_.shades()) {
    RenderOptions render_options;
    render_options.width = width;
    render_options.height = height;
    render_options.samples = options_.samples;
    render_options.depth = options_.depth;
    render_options.threads = options_.threads;
    if (prepared_.images->chunks.size() > 1) render_options.wave_rays = kChunkedWave;
    const RenderInput input{prepared_.scene, prepared_.lattice, prepared_.images->triangles,
                            *camera};
    auto film = render(input, render_options, *device_, statistics_.report, recorder(), reporter());
    if (!film) return std::unexpected(film.error());
    film_ = std::move(*film);
    return {};
  }
  if (options_.hits.empty() && options_.lattice.empty()) return {};  // only one ray to explain
  const StreamOptions stream = stream_options();
  return trace_stream(prepared_.lattice, *device_, total,
                      primary_rays(*camera, width, options_.samples, options_.threads), recorder(),
                      stream, statistics_.report, reporter());
}

Result<void> HostRun::explain_pixel(const PinholeCamera& camera) {
  if (!options_.explain) return {};
  const glm::ivec2 pixel = *options_.explain;
  const Ray ray = camera.ray(pixel.x, pixel.y, sample_position(0, options_.samples));
  const Segment segment = make_segment(prepared_.lattice, ray);
  explanation_ = fmt::format("pixel {},{}\nray origin {} {} {} direction {} {} {}\n", pixel.x,
                             pixel.y, ray.origin.x, ray.origin.y, ray.origin.z, ray.direction.x,
                             ray.direction.y, ray.direction.z);
  if (segment.is_miss()) {
    explanation_ +=
        "the ray does not meet the lattice box: a miss, nothing is sent to the device\n";
    return {};
  }
  explanation_ +=
      fmt::format("segment {} {} {} to {} {} {}, t {} to {}\n", segment.p0.x, segment.p0.y,
                  segment.p0.z, segment.p1.x, segment.p1.y, segment.p1.z, segment.t0, segment.t1);
  const std::size_t chunks = prepared_.images->chunks.size();
  for (std::size_t i = 0; i < chunks; ++i) {
    auto events = device_->explain(prepared_.images->chunks[i].image, segment);
    if (!events) return std::unexpected(events.error());
    if (chunks > 1) explanation_ += fmt::format("chunk {} of {}\n", i + 1, chunks);
    explanation_ += describe(*events);
  }
  return {};
}

Result<void> HostRun::write() {
  if (outputs_.picture.is_open() && film_) {
    auto format = picture_format(options_.picture);
    if (!format) return std::unexpected(format.error());
    auto bytes = encode_picture(*film_, *format);
    if (!bytes) return std::unexpected(bytes.error());
    if (auto done = outputs_.picture.write(*bytes); !done) return done;
  }
  if (outputs_.lattice.is_open()) {
    auto bytes = lattice_.pack(prepared_);
    if (!bytes) return std::unexpected(bytes.error());
    if (auto done = outputs_.lattice.write(*bytes); !done) return done;
  }
  return {};
}

}  // namespace gridrt
