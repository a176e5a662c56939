// gridrt-virtual-board: a board without hardware that a computer, real or virtual, enumerates.
#include <chrono>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <span>
#include <string>
#include <vector>
#include <utility>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "host/app/exit_code.hpp"
#include "virtual/board.hpp"
#include "virtual/listen.hpp"
#include "virtual/redirection.hpp"
#include "virtual/usb_function.hpp"

namespace gridrt {
namespace {

constexpr std::string_view kProgram = "gridrt-virtual-board";

struct Options {
  VirtualBoardOptions board;
  std::string flash;
  std::string redirect;
  bool full_speed = false;
  bool once = false;
};

Result<void> serve_redirection(UsbFunction& function, const Options& options) {
  constexpr std::chrono::milliseconds kPatience(1000);
  Result<Socket> listening = listen_at(options.redirect);
  if (!listening) return std::unexpected(std::move(listening.error()));
  fmt::print("{}: waiting at {}\n", kProgram, options.redirect);
  std::fflush(stdout);
  for (;;) {
    Result<Socket> socket = accept_one(*listening, kPatience);
    if (!socket) return std::unexpected(std::move(socket.error()));
    if (!socket->is_open()) continue;
    Redirection redirection(function, socket->file());
    Result<bool> going = true;
    while (going && *going) going = redirection.step(kPatience);
    if (!going) return std::unexpected(std::move(going.error()));
    if (options.once) return {};
  }
}

Result<void> run(Options options) {
  if (!options.flash.empty()) {
    std::ifstream file(options.flash, std::ios::binary);
    const std::vector<char> bytes{std::istreambuf_iterator<char>(file), {}};
    if (!file) return fail(ErrorKind::kFile, options.flash + ": cannot be read");
    const auto view = std::as_bytes(std::span(bytes));
    options.board.flash.assign(view.begin(), view.end());
  }
  Result<VirtualBoard> board = make_virtual_board(options.board);
  if (!board) return std::unexpected(std::move(board.error()));
  UsbFunction function(*board->endpoint, {.serial = options.board.serial,
                                          .high_speed = !options.full_speed,
                                          .input = board->input});
  return serve_redirection(function, options);
}

int main_of(int argc, const char* const* argv) {
  Options options;
  CLI::App app("A GridRT board without hardware, for USB redirection (QEMU, SPICE).",
               std::string(kProgram));
  app.add_option("--core", options.board.core, "seq, omp (software PEs; default) or sim (the RTL)");
  app.add_flag("--wide", options.board.wide, "software PEs without the board's limits");
  app.add_option("--serial", options.board.serial, "at most 16 characters (default: virtual-1)");
  app.add_option("--flash", options.flash, "a flash image to boot from");
  app.add_flag("--full-speed", options.full_speed, "12 Mbit/s instead of 480");
  app.add_option("--redirect", options.redirect,
                 "serve USB redirection at this path or TCP port of this machine")
      ->required();
  app.add_flag("--once", options.once, "end with the first connection");
  try {
    app.parse(argc, argv);
  } catch (const CLI::CallForHelp&) {
    std::fputs(app.help().c_str(), stdout);
    return kExitOk;
  } catch (const CLI::ParseError& error) {
    return report(kProgram, {ErrorKind::kUsage, error.what(), {}});
  }
  auto done = run(std::move(options));
  return done ? kExitOk : report(kProgram, done.error());
}

}  // namespace
}  // namespace gridrt

int main(int argc, char** argv) {
  return gridrt::run_program(gridrt::kProgram, gridrt::main_of, argc, argv);
}
