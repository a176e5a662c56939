// What both programs' command lines share.
#pragma once

#include <string>
#include <variant>

#include <CLI/CLI.hpp>

#include "hal/error.hpp"
#include "host/app/options.hpp"

namespace gridrt {

/// The raw texts of the options that cut a scene, until they are read strictly.
struct CutTexts {
  std::string bits;
  std::string grid;
  std::string pes;
  std::string mapping;
  std::string layout;
};

/// Adds --bits, --grid, --pes, --mapping and --layout in a group of their own.
void add_cut_options(CLI::App& app, CutTexts& texts);
Result<CutOptions> read_cut_options(const CutTexts& texts);

/// "auto", "on" or "off".
Result<ProgressMode> read_progress(const std::string& text);

/// Version text of --version.
std::string version_text(std::string_view program);

/// Help on what SCENE may be, with the built-in scenes.
std::string scene_help();

/// Runs the parser: nothing if the program is to go on, text to print, or a usage error.
Result<std::optional<PrintAndExit>> parse_command_line(CLI::App& app, int argc,
                                                       const char* const* argv);

}  // namespace gridrt
