// gridrt-virtual-board: a board without hardware that a computer, real or virtual, enumerates.
#include <array>
#include <chrono>
#include <cstdio>
#include <fstream>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "host/app/exit_code.hpp"
#include "tools/virtual/board.hpp"
#include "tools/virtual/listen.hpp"
#include "tools/virtual/redirection.hpp"
#include "tools/virtual/usb_function.hpp"
#include "tools/virtual/usbip.hpp"

namespace gridrt {
namespace {

constexpr std::string_view kProgram = "gridrt-virtual-board";

struct Options {
  VirtualBoardOptions board;
  std::string flash;
  std::string redirect;
  std::string usbip;
  bool full_speed = false;
  bool once = false;
};

/// Serves one connection after the other with a Bus: Redirection or UsbIp.
template <class Bus>
Result<void> serve(UsbFunction& function, const std::string& place, const Options& options) {
  constexpr std::chrono::milliseconds kPatience(1000);
  Result<Socket> listening = listen_at(place);
  if (!listening) return std::unexpected(std::move(listening.error()));
  fmt::print("{}: waiting at {}\n", kProgram, place);
  std::fflush(stdout);
  for (;;) {
    Result<Socket> socket = accept_one(*listening, kPatience);
    if (!socket) return std::unexpected(std::move(socket.error()));
    if (!socket->is_open()) continue;
    Bus bus(function, socket->file());
    Result<bool> going = true;
    while (going && *going) going = bus.step(kPatience);
    if (!going) return std::unexpected(std::move(going.error()));
    if (options.once) return {};
  }
}

Result<std::vector<std::byte>> read_flash(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::array<char, 4096> piece{};
  std::vector<std::byte> bytes;
  while (file) {
    file.read(piece.data(), static_cast<std::streamsize>(piece.size()));
    const auto came =
        std::as_bytes(std::span(piece)).first(static_cast<std::size_t>(file.gcount()));
    bytes.insert(bytes.end(), came.begin(), came.end());
  }
  // A folder can be opened, but has no end to come to.
  if (!file.eof()) return fail(ErrorKind::kFile, path + ": cannot be read");
  return bytes;
}

Result<void> run(Options options) {
  if (!options.flash.empty()) {
    Result<std::vector<std::byte>> flash = read_flash(options.flash);
    if (!flash) return std::unexpected(std::move(flash.error()));
    options.board.flash = std::move(*flash);
  }
  Result<VirtualBoard> board = make_virtual_board(options.board);
  if (!board) return std::unexpected(std::move(board.error()));
  UsbFunction function(
      *board->endpoint,
      {.serial = options.board.serial, .high_speed = !options.full_speed, .input = board->input});
  return options.usbip.empty() ? serve<Redirection>(function, options.redirect, options)
                               : serve<UsbIp>(function, options.usbip, options);
}

int main_of(int argc, const char* const* argv) {
  Options options;
  CLI::App app("A GridRT board without hardware, to plug into this computer or a virtual one.",
               std::string(kProgram));
  app.add_option("--core", options.board.core, "seq, omp (software PEs; default) or sim (the RTL)");
  app.add_flag("--wide", options.board.wide, "software PEs without the board's limits");
  app.add_option("--serial", options.board.serial, "at most 16 characters (default: virtual-1)");
  app.add_option("--flash", options.flash, "a flash image to boot from");
  app.add_flag("--full-speed", options.full_speed, "12 Mbit/s instead of 480");
  auto* bus = app.add_option_group("bus", "How it is plugged in");
  bus->add_option("--redirect", options.redirect,
                  "USB redirection (QEMU, SPICE) at this path or TCP port of this machine");
  bus->add_option("--usbip", options.usbip,
                  "USB/IP at this path or TCP port of this machine (3240 is the usual one)");
  bus->require_option(1);
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
