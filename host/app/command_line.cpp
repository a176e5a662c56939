#include "host/app/command_line.hpp"

#include <fmt/format.h>

#include "host/app/parse.hpp"
#include "host/scene/load.hpp"

namespace gridrt {

void add_cut_options(CLI::App& app, CutTexts& texts) {
  constexpr const char* kGroup = "How the scene is cut (never changes the answer but for --bits)";
  app.add_option("--bits", texts.bits, "lattice bits an axis: auto (17), or 4 to 24")
      ->group(kGroup)
      ->type_name("auto|B");
  app.add_option("--grid", texts.grid,
                 "voxels an axis; auto chooses by the number of triangles, in "
                 "the compact layout by the work of sample rays")
      ->group(kGroup)
      ->type_name("auto|NXxNYxNZ");
  app.add_option(
         "--pes", texts.pes,
         fmt::format("processing elements that share the voxels, 1 to {} (default 4)", kMaxPes))
      ->group(kGroup)
      ->type_name("N");
  app.add_option("--mapping", texts.mapping,
                 "how voxels are dealt to them: measured (default: boxes, in the compact layout "
                 "dealt by the work of sample rays), boxes, contiguous or voxel")
      ->group(kGroup)
      ->type_name("NAME");
  app.add_option(
         "--layout", texts.layout,
         "record layout: wide or compact, the board's, with its limits (default: the device's)")
      ->group(kGroup)
      ->type_name("compact|wide");
}

Result<CutOptions> read_cut_options(const CutTexts& texts) {
  CutOptions options;
  if (!texts.bits.empty()) {
    auto bits = parse_bits("--bits", texts.bits);
    if (!bits) return std::unexpected(bits.error());
    if (texts.bits != "auto") options.bits = *bits;
  }
  if (!texts.grid.empty()) {
    auto grid = parse_grid("--grid", texts.grid);
    if (!grid) return std::unexpected(grid.error());
    options.grid = *grid;
  }
  if (!texts.pes.empty()) {
    auto pes = parse_integer("--pes", texts.pes, 1, kMaxPes);
    if (!pes) return std::unexpected(pes.error());
    options.pes = static_cast<int>(*pes);
  }
  if (!texts.mapping.empty()) {
    auto mapping = parse_mapping(texts.mapping);
    if (!mapping) {
      return fail(ErrorKind::kUsage, "--mapping " + texts.mapping + ": " + mapping.error().message,
                  mapping.error().advice);
    }
    options.mapping = *mapping;
  }
  if (!texts.layout.empty()) {
    auto layout = parse_layout("--layout", texts.layout);
    if (!layout) return std::unexpected(layout.error());
    options.layout = *layout;
  }
  return options;
}

Result<ProgressMode> read_progress(const std::string& text) {
  if (text == "auto") return ProgressMode::kAuto;
  if (text == "on") return ProgressMode::kOn;
  if (text == "off") return ProgressMode::kOff;
  return fail(ErrorKind::kUsage,
              fmt::format("--progress {}: expected \"auto\", \"on\" or \"off\"", text));
}

std::string version_text(std::string_view program) {
  return fmt::format("{} {} (protocol {}, image format {})\n", program, GRIDRT_VERSION,
                     protocol::kVersion, protocol::kImageVersion);
}

std::string scene_help() {
  std::string text =
      "SCENE is one of\n"
      "  a mesh: .obj (with its .mtl), .ply, .stl, .gltf or .glb\n"
      "  a .toml file that places meshes, materials, lights and camera\n"
      "  a .grt image that gridrt-image has made\n"
      "  builtin:NAME, or builtin:NAME?key=value&key=value, made by code:\n";
  for (const BuiltinInfo& scene : builtin_names()) {
    text += fmt::format("    {:<16} {}\n", scene.name, scene.summary);
    for (const std::string& option : scene.options)
      text += fmt::format("    {:<16}   {}\n", "", option);
  }
  return text;
}

Result<std::optional<PrintAndExit>> parse_command_line(CLI::App& app, int argc,
                                                       const char* const* argv) {
  try {
    app.parse(argc, argv);
  } catch (const CLI::CallForHelp&) {
    return PrintAndExit{app.help()};
  } catch (const CLI::ParseError& error) {
    return fail(ErrorKind::kUsage, error.what());
  }
  return std::nullopt;
}

}  // namespace gridrt
