#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "host/app/command_line.hpp"
#include "host/app/exit_code.hpp"
#include "host/app/options.hpp"

namespace gridrt {
namespace {

constexpr const char* kExamples =
    "Examples:\n"
    "  gridrt-image builtin:teapot -o teapot.grt --pes 4\n"
    "  gridrt-image --info teapot.grt\n"
    "  gridrt-image --verify teapot.grt\n"
    "  gridrt-image builtin:teapot --firmware teapot.flash\n"
    "  gridrt-host teapot.grt -o teapot.png\n";

}  // namespace

Result<std::variant<ImageProgramOptions, PrintAndExit>> parse_image_options(
    int argc, const char* const* argv) {
  ImageProgramOptions options;
  CutTexts cut;
  std::string progress = "auto";
  bool version = false;
  CLI::App app("Makes, shows and checks .grt files: memory images of a scene for a device.",
               "gridrt-image");
  app.add_option("SCENE", options.scene, "the scene to make an image of; see below");
  constexpr const char* kActions = "What to do (one of these)";
  app.add_option("-o,--output", options.output, "make an image of SCENE")
      ->group(kActions)
      ->type_name("SCENE.grt");
  app.add_option("--info", options.info,
                 "show an image's sizes, lattice, grid and, for each PE, triangles, copies, "
                 "references, occupancy and balance")
      ->group(kActions)
      ->type_name("FILE.grt");
  app.add_option("--verify", options.verify, "check every bit of an image")
      ->group(kActions)
      ->type_name("FILE.grt");
  app.add_option("--firmware", options.firmware,
                 "make a flash image of SCENE, from which the board starts without a host")
      ->group(kActions)
      ->type_name("FILE");
  add_cut_options(app, cut);
  app.add_option("--progress", progress, "progress on standard error (auto: on a terminal)")
      ->group("Other")
      ->type_name("auto|on|off");
  app.set_help_flag("-h,--help", "this text")->group("Other");
  app.add_flag("--version", version, "the version")->group("Other");
  app.footer(fmt::format("\n{}\n{}\n{}", scene_help(), kExamples, exit_code_help()));
  auto parsed = parse_command_line(app, argc, argv);
  if (!parsed) return std::unexpected(parsed.error());
  if (const auto& exit = *parsed) return *exit;
  if (version) return PrintAndExit{version_text("gridrt-image")};
  auto mode = read_progress(progress);
  if (!mode) return std::unexpected(mode.error());
  options.progress = *mode;
  auto read = read_cut_options(cut);
  if (!read) return std::unexpected(read.error());
  options.cut = *read;

  const int actions = (options.output.empty() ? 0 : 1) + (options.info.empty() ? 0 : 1) +
                      (options.verify.empty() ? 0 : 1) + (options.firmware.empty() ? 0 : 1);
  if (actions != 1) {
    return fail(ErrorKind::kUsage, actions == 0 ? "nothing to do" : "more than one thing to do",
                "give SCENE and -o, or --info, or --verify, or --firmware");
  }
  if (options.output.empty() && options.firmware.empty() && !options.scene.empty()) {
    return fail(ErrorKind::kUsage, "--info and --verify take no SCENE: " + options.scene);
  }
  const bool cuts = !cut.bits.empty() || !cut.grid.empty() || !cut.pes.empty() ||
                    !cut.mapping.empty() || !cut.layout.empty();
  if (cuts && options.output.empty() && options.firmware.empty()) {
    return fail(ErrorKind::kUsage, "--bits, --grid, --pes, --mapping and --layout go with -o");
  }
  if ((!options.output.empty() || !options.firmware.empty()) && options.scene.empty()) {
    return fail(ErrorKind::kUsage, "no scene is given",
                "for example: gridrt-image builtin:teapot -o teapot.grt");
  }
  return options;
}

}  // namespace gridrt
