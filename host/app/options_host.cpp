#include <array>
#include <limits>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "host/app/command_line.hpp"
#include "host/app/exit_code.hpp"
#include "host/app/options.hpp"
#include "host/app/parse.hpp"
#include "host/render/waves.hpp"

namespace gridrt {
namespace {

constexpr const char* kExamples =
    "Examples:\n"
    "  gridrt-host builtin:teapot -o teapot.png\n"
    "      a picture of a built-in scene\n"
    "  gridrt-host bunny.obj -o bunny.exr --size 1920x1080 --samples 16 --eye 0,1,3 --look 0,0,0\n"
    "      a mesh from a camera of your own, 16 samples a pixel, in linear light\n"
    "  gridrt-host bunny.obj --rays in.npy --hits out.npy\n"
    "      which triangle each of your rays hits: in.npy is float64 of shape (N, 6) or (N, 8),\n"
    "      origin, direction and, if given, tmin and tmax; out.npy holds id, t, u, v\n"
    "  gridrt-host bunny.obj --hits out.npy --lattice lattice.npz && tools/audit out.npy --lattice "
    "lattice.npz\n"
    "      the primary hits, row by row from the top, and a proof of them\n"
    "  gridrt-host scene.toml -o a.png --stats a.json --explain 320,240\n"
    "      where the time went, and the life of one pixel's ray\n";

constexpr const char* kOutputNotes =
    "At least one of -o, --hits, --lattice, --explain, --stats and --trace says what to do. With "
    "-o\n"
    "the whole picture is computed; with --stats or --trace alone too, and thrown away; with\n"
    "--hits, --lattice or --explain alone only the primary rays are traced. An output file "
    "appears\n"
    "when it is complete, or not at all; the waves of --trace grow while the simulation runs.\n";

struct HostTexts {
  std::string threads, groups, batch, size, samples, depth, eye, look, up, fov, explain;
  std::string progress = "auto";
  bool version = false;
  CutTexts cut;
};

void add_options(CLI::App& app, HostOptions& options, HostTexts& texts) {
  app.add_option("SCENE", options.scene, "the scene to trace; see below");
  constexpr const char* kOutputs = "What to make";
  const auto add = [&app](const char* group, const char* name, std::string& value, const char* type,
                          const std::string& help) {
    app.add_option(name, value, help)->group(group)->type_name(type);
  };
  add(kOutputs, "-o,--output", options.picture, "FILE",
      "the picture: .png (8-bit sRGB), .exr or .pfm (linear light, 32-bit float)");
  add(kOutputs, "--hits", options.hits, "OUT.npy",
      "the hit of every given or primary ray: id (-1: none), t, u, v");
  add(kOutputs, "--rays", options.rays, "IN.npy", "trace these rays instead of a camera's");
  add(kOutputs, "--stats", options.stats, "OUT.json", "counts and times");
  add(kOutputs, "--lattice", options.lattice, "OUT.npz",
      "what the answers were computed from: q, s, lo, P0, P1, bits, box, rays, vertices");
  add(kOutputs, "--explain", texts.explain, "X,Y",
      "tell the life of this pixel's first ray: voxels, PEs, tests, interrupts, feedback");
  add(kOutputs, "--trace", options.trace, "OUT.fst",
      "with --device sim: the waves of all signals while it runs; large, use a small --size");
  app.add_flag("--any-hit", options.any_hit,
               "with --hits: only whether a ray hits anything (id 0 or -1; t, u, v are NaN)")
      ->group(kOutputs);
  constexpr const char* kCamera = "Picture and camera";
  add(kCamera, "--size", texts.size, "WxH", "pixels (default 640x480)");
  add(kCamera, "--eye", texts.eye, "X,Y,Z", "where the camera is (default: the scene's camera,");
  add(kCamera, "--look", texts.look, "X,Y,Z", "the point it looks at    or one that shows all)");
  add(kCamera, "--up", texts.up, "X,Y,Z", "the way up (default 0,1,0)");
  add(kCamera, "--fov", texts.fov, "DEG", "vertical field of view, in (0, 180)");
  add(kCamera, "--samples", texts.samples, "N",
      "rays a pixel, in a fixed pattern (default 1: its centre)");
  add(kCamera, "--depth", texts.depth, "N",
      "longest chain of mirror and glass rays after a primary ray (default 6; 0: none)");
  constexpr const char* kDevice = "Device (never changes the answer)";
  add(kDevice, "--device", options.device, "NAME",
      "auto, usb[:SERIAL], sim, omp (threads), mpi or seq (one thread, the reference)");
  add(kDevice, "--flash", options.flash, "FILE",
      "with --device sim: what the board's flash holds (gridrt-image --firmware)");
  add(kDevice, "--schedule", options.schedule, "NAME",
      "how software PEs share the work: rays (default), pes (default of mpi) or paper");
  add(kDevice, "--threads", texts.threads, "N", "threads of omp and of the shading (default: all)");
  add(kDevice, "--groups", texts.groups, "N",
      "split mpi's ranks into N groups, each with all PEs and a part of the rays (default 1)");
  add(kDevice, "--batch", texts.batch, "N", "rays in a frame to the device (default 32768)");
  app.add_flag("--list-devices", options.list_devices, "list the devices that there are")
      ->group(kDevice);
  add_cut_options(app, texts.cut);
  app.add_flag("--exact", options.exact,
               "answer for the scene as given instead of its lattice (not built in yet)")
      ->group("How the scene is cut (never changes the answer but for --bits)");
  constexpr const char* kOther = "Other";
  add(kOther, "--progress", texts.progress, "auto|on|off",
      "progress on standard error (auto: on a terminal)");
  app.set_help_flag("-h,--help", "this text")->group(kOther);
  app.add_flag("--version", texts.version, "the version")->group(kOther);
}

/// Reads one text if it was given; the error, if any, goes where the first one is.
class Reader {
 public:
  template <class T, class Read>
  void operator()(const std::string& text, T& value, const Read& read) {
    if (text.empty() || error_) return;
    auto result = read(text);
    if (result) {
      value = *result;
    } else {
      error_ = result.error();
    }
  }
  [[nodiscard]] const std::optional<Error>& error() const { return error_; }

 private:
  std::optional<Error> error_;
};

Result<void> read_texts(const HostTexts& texts, HostOptions& options) {
  const auto integer = [](const char* name, std::int64_t least, std::int64_t most) {
    return [=](const std::string& text) { return parse_integer(name, text, least, most); };
  };
  const auto vector = [](const char* name) {
    return [=](const std::string& text) { return parse_vector(name, text); };
  };
  Reader read;
  constexpr std::int64_t kMaxThreads = 4096;
  constexpr std::int64_t kMaxGroups = 4096;
  constexpr std::int64_t kMaxBatch = 1 << 17;  // wide records of a frame's largest payload
  std::int64_t threads = options.threads;
  std::int64_t groups = options.groups;
  std::int64_t samples = options.samples;
  std::int64_t depth = options.depth;
  read(texts.threads, threads, integer("--threads", 1, kMaxThreads));
  read(texts.groups, groups, integer("--groups", 1, kMaxGroups));
  read(texts.batch, options.batch, integer("--batch", 1, kMaxBatch));
  read(texts.samples, samples, integer("--samples", 1, kMaxSamples));
  read(texts.depth, depth, integer("--depth", 0, kMaxDepth));
  read(texts.size, options.size,
       [](const std::string& text) { return parse_size("--size", text); });
  read(texts.eye, options.eye, vector("--eye"));
  read(texts.look, options.look, vector("--look"));
  read(texts.up, options.up, vector("--up"));
  read(texts.fov, options.fov, [](const std::string& text) -> Result<double> {
    auto fov = parse_number("--fov", text);
    if (fov && !is_field_of_view(*fov)) {
      return fail(ErrorKind::kUsage, fmt::format("--fov {}: expected degrees in (0, 180)", text));
    }
    return fov;
  });
  read(texts.explain, options.explain,
       [](const std::string& text) { return parse_pixel("--explain", text); });
  read(texts.progress, options.progress, read_progress);
  if (const std::optional<Error>& error = read.error()) return std::unexpected(*error);
  options.threads = static_cast<int>(threads);
  options.groups = static_cast<int>(groups);
  options.samples = static_cast<int>(samples);
  options.depth = static_cast<int>(depth);
  auto cut = read_cut_options(texts.cut);
  if (!cut) return std::unexpected(cut.error());
  options.cut = *cut;
  return {};
}

// Options that would be ignored together, and outputs that would overwrite each other.
Result<void> check_together(const HostTexts& texts, const HostOptions& options) {
  const auto refuse = [](std::string message, std::string advice = {}) {
    return fail(ErrorKind::kUsage, std::move(message), std::move(advice));
  };
  if (options.scene.empty())
    return refuse("no scene is given", "for example: gridrt-host builtin:teapot -o teapot.png");
  const bool makes_something = !options.picture.empty() || !options.hits.empty() ||
                               !options.stats.empty() || !options.lattice.empty() ||
                               options.explain.has_value() || !options.trace.empty();
  if (!makes_something) {
    return refuse("nothing to make",
                  "add -o picture.png, or --hits, --lattice, --stats, --explain or --trace");
  }
  if (!options.rays.empty()) {
    const std::array<std::pair<const char*, bool>, 9> camera = {{
        {"-o", !options.picture.empty()},
        {"--explain", options.explain.has_value()},
        {"--size", !texts.size.empty()},
        {"--samples", !texts.samples.empty()},
        {"--depth", !texts.depth.empty()},
        {"--eye", options.eye.has_value()},
        {"--look", options.look.has_value()},
        {"--up", options.up.has_value()},
        {"--fov", options.fov.has_value()},
    }};
    for (const auto& [name, given] : camera) {
      if (given)
        return refuse(fmt::format("{} does not go with --rays, which replace the camera", name));
    }
  }
  if (options.any_hit && !options.picture.empty()) {
    return refuse("--any-hit does not go with -o: a picture needs the closest hits");
  }
  if (options.any_hit && options.hits.empty() && options.rays.empty()) {
    return refuse("--any-hit needs --hits or --rays");
  }
  if (options.explain &&
      (options.explain->x >= options.size.x || options.explain->y >= options.size.y)) {
    return refuse(fmt::format("--explain {}: the picture has {}x{} pixels", texts.explain,
                              options.size.x, options.size.y));
  }
  const std::array<std::pair<const char*, const std::string*>, 5> outputs = {
      {{"-o", &options.picture},
       {"--hits", &options.hits},
       {"--stats", &options.stats},
       {"--lattice", &options.lattice},
       {"--trace", &options.trace}}};
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    for (std::size_t j = i + 1; j < outputs.size(); ++j) {
      if (!outputs[i].second->empty() && *outputs[i].second == *outputs[j].second) {
        return refuse(fmt::format("{} and {} name the same file {}", outputs[i].first,
                                  outputs[j].first, *outputs[i].second));
      }
    }
  }
  if (options.exact) {
    return fail(ErrorKind::kUnsupported, "--exact is not built in yet",
                "without it, answers are exact on the lattice; a higher --bits makes that finer");
  }
  return {};
}

}  // namespace

Result<std::variant<HostOptions, PrintAndExit>> parse_host_options(int argc,
                                                                   const char* const* argv) {
  HostOptions options;
  HostTexts texts;
  CLI::App app("Traces a scene on a grid of processing elements: pictures, or hits of given rays.",
               "gridrt-host");
  add_options(app, options, texts);
  app.footer(
      fmt::format("\n{}\n{}\n{}\n{}", kOutputNotes, scene_help(), kExamples, exit_code_help()));
  auto parsed = parse_command_line(app, argc, argv);
  if (!parsed) return std::unexpected(parsed.error());
  if (const auto& exit = *parsed) return *exit;
  if (texts.version) return PrintAndExit{version_text("gridrt-host")};
  if (auto read = read_texts(texts, options); !read) return std::unexpected(read.error());
  if (options.list_devices) return options;
  if (auto checked = check_together(texts, options); !checked) {
    return std::unexpected(checked.error());
  }
  return options;
}

}  // namespace gridrt
