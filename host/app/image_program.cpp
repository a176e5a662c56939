#include "host/app/image_program.hpp"

#include <cstdio>
#include <string>
#include <variant>

#include <fmt/format.h>

#include "host/app/exit_code.hpp"
#include "host/app/options.hpp"
#include "host/app/prepared_scene.hpp"
#include "host/app/progress.hpp"
#include "host/driver/flash_image.hpp"
#include "host/image/image_file.hpp"
#include "host/image/output_file.hpp"
#include "host/pe/capabilities.hpp"
#include "host/scene/load.hpp"

namespace gridrt {
namespace {

constexpr std::string_view kProgram = "gridrt-image";

Result<void> print(const std::string& text) {
  if (std::fputs(text.c_str(), stdout) < 0 || std::fflush(stdout) != 0) {
    return fail(ErrorKind::kFile, "cannot write to standard output");
  }
  return {};
}

Result<void> make(const ImageProgramOptions& options) {
  if (is_image_path(options.scene)) {
    return fail(ErrorKind::kUsage, options.scene + " is an image already",
                "make it anew from the scene that it was made from");
  }
  auto file = OutputFile::create(options.output);  // first: a bad place is no surprise at the end
  if (!file) return std::unexpected(file.error());
  Progress progress(options.progress);
  progress.phase("loading");
  auto scene = load_scene(options.scene);
  if (!scene) return std::unexpected(scene.error());
  progress.clear();
  print_warnings(kProgram, *scene);
  progress.phase("building");
  auto image = build_image(*scene, image_options(options.cut, true));
  if (!image) return std::unexpected(image.error());
  progress.phase("writing");
  if (auto done = file->write(serialize_image(*image)); !done) return done;
  return file->commit();
}

Result<void> make_flash(const ImageProgramOptions& options) {
  auto file = OutputFile::create(options.firmware);
  if (!file) return std::unexpected(file.error());
  Progress progress(options.progress);
  progress.phase("building");
  const protocol::CapabilitiesReport board = board_capabilities();
  auto prepared = prepare_scene(options.scene, options.cut, board);
  if (!prepared) return std::unexpected(prepared.error());
  progress.clear();
  print_warnings(kProgram, prepared->scene);
  progress.phase("writing");
  if (prepared->images->chunks.size() != 1) {
    return fail(ErrorKind::kLimit,
                fmt::format("{}: takes {} images of the board's size, a flash image holds one",
                            options.scene, prepared->images->chunks.size()),
                "use a scene with fewer triangles");
  }
  auto flash = flash_image(prepared->image(), board);
  if (!flash) return std::unexpected(flash.error());
  if (auto done = file->write(*flash); !done) return done;
  return file->commit();
}

Result<void> verify(const std::string& path) {
  auto image = read_image(path);
  if (!image) return std::unexpected(image.error());
  if (auto verified = verify_image(*image); !verified) {
    Error error = verified.error();
    if (error.message.find(path) == std::string::npos) error.message = path + ": " + error.message;
    return std::unexpected(error);
  }
  return print(path + ": every bit is as it should be\n");
}

Result<void> run(const ImageProgramOptions& options) {
  if (!options.firmware.empty()) return make_flash(options);
  if (!options.info.empty()) {
    auto image = read_image(options.info);
    if (!image) return std::unexpected(image.error());
    return print(describe_image(*image));
  }
  if (!options.verify.empty()) return verify(options.verify);
  return make(options);
}

}  // namespace

int run_image(int argc, const char* const* argv) {
  auto parsed = parse_image_options(argc, argv);
  if (!parsed) return report(kProgram, parsed.error());
  auto done = std::holds_alternative<PrintAndExit>(*parsed)
                  ? print(std::get<PrintAndExit>(*parsed).text)
                  : run(std::get<ImageProgramOptions>(*parsed));
  return done ? kExitOk : report(kProgram, done.error());
}

}  // namespace gridrt
