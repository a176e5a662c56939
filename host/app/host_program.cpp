#include "host/app/host_program.hpp"

#include <algorithm>
#include <cstdio>
#include <string>
#include <utility>
#include <variant>

#include <fmt/format.h>

#include "hal/usb/usb.hpp"
#include "host/app/exit_code.hpp"
#include "host/app/host_run.hpp"
#include "host/app/options.hpp"
#include "host/driver/device.hpp"

namespace gridrt {
namespace {

constexpr std::string_view kProgram = "gridrt-host";

int print(const std::string& text) {
  if (std::fputs(text.c_str(), stdout) < 0 || std::fflush(stdout) != 0) {
    return report(kProgram, {ErrorKind::kFile, "cannot write to standard output", {}});
  }
  return kExitOk;
}

/// A line for each board on USB, that it can be used or why not.
std::string board_list() {
  if (!usb_is_built_in()) return {};
  const auto boards = list_usb_boards();
  if (!boards) return fmt::format("      {}\n", boards.error().message);
  if (boards->empty()) return "      no board is plugged in\n";
  std::string text;
  for (const UsbBoard& board : *boards) {
    text += fmt::format("      usb:{} at {}: {}\n", board.serial, board.port,
                        board.trouble.empty() ? "ready" : board.trouble);
  }
  return text;
}

std::string device_list() {
  constexpr std::pair<std::string_view, std::string_view> kKnown[] = {
      {"seq", "software, one thread: the reference"},
      {"omp", "software, threads as processing elements"},
      {"mpi", "software, MPI ranks as processing elements"},
      {"sim", "the board's RTL, simulated"},
      {"usb", "the board"}};
  const std::vector<std::string> built_in = built_in_devices();
  std::string text;
  for (const auto& [name, summary] : kKnown) {
    const bool there = std::ranges::count(built_in, name) > 0;
    text += fmt::format("{:<5} {}{}\n", name, summary, there ? "" : " (not built in)");
  }
  return text + board_list();
}

}  // namespace

int run_host(int argc, const char* const* argv) {
  auto parsed = parse_host_options(argc, argv);
  if (!parsed) return report(kProgram, parsed.error());
  if (const auto* text = std::get_if<PrintAndExit>(&*parsed)) return print(text->text);
  const HostOptions& options = std::get<HostOptions>(*parsed);
  if (options.list_devices) return print(device_list());
  HostRun run(options);
  if (auto done = run.run(); !done) return report(kProgram, done.error());
  return kExitOk;
}

}  // namespace gridrt
