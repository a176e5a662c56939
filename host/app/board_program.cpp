#include "host/app/board_program.hpp"

#include <array>
#include <chrono>
#include <cstdio>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "hal/usb/usb.hpp"
#include "host/app/board_text.hpp"
#include "host/app/command_line.hpp"
#include "host/app/exit_code.hpp"
#include "host/driver/device.hpp"
#include "host/image/image_file.hpp"

namespace gridrt {
namespace {

constexpr std::string_view kProgram = "gridrt-board";

struct Options {
  std::string device = "usb";
  std::string file;
  int follow = 0;  ///< seconds
};

Result<void> print(const std::string& text) {
  if (std::fputs(text.c_str(), stdout) < 0 || std::fflush(stdout) != 0) {
    return fail(ErrorKind::kFile, "cannot write to standard output");
  }
  return {};
}

/// The reports of a board, without its frames: another program may be using those.
Result<std::unique_ptr<Transport>> open_reports(const Options& options) {
  UsbOptions usb;
  usb.frames = false;
  if (options.device.starts_with("usb:")) {
    usb.serial = options.device.substr(4);
  } else if (options.device != "usb") {
    return fail(ErrorKind::kUsage, "--device " + options.device + ": no board is called that",
                "use usb or usb:SERIAL");
  }
  return open_usb(usb);
}

/// A report that not every board has.
template <class Report>
Result<std::optional<Report>> if_there(Transport& link) {
  auto report = get_report<Report>(link);
  if (report) return std::optional<Report>(*report);
  if (report.error().kind == ErrorKind::kUnsupported) return std::optional<Report>();
  return std::unexpected(std::move(report.error()));
}

Result<void> list(const Options& /*options*/) {
  auto boards = list_usb_boards();
  if (!boards) return std::unexpected(std::move(boards.error()));
  if (boards->empty()) return print("no GridRT board is plugged in\n");
  std::string text;
  for (const UsbBoard& board : *boards) {
    text += fmt::format("usb:{}  port {}  {}  {}  {}\n", board.serial, board.port,
                        board.device_node, board.hid_node.empty() ? "-" : board.hid_node,
                        board.trouble.empty() ? "ready" : board.trouble);
  }
  return print(text);
}

Result<void> info(const Options& options) {
  auto link = open_reports(options);
  if (!link) return std::unexpected(std::move(link.error()));
  const auto identity = get_report<protocol::IdentityReport>(**link);
  if (!identity) return std::unexpected(identity.error());
  if (identity->protocol_version != protocol::kVersion) {
    return fail(ErrorKind::kUnsupported,
                fmt::format("the board speaks protocol version {}, this program version {}",
                            identity->protocol_version, protocol::kVersion),
                "use the firmware and the program of one release");
  }
  const auto capabilities = get_report<protocol::CapabilitiesReport>(**link);
  if (!capabilities) return std::unexpected(capabilities.error());
  const auto status = get_report<protocol::StatusReport>(**link);
  if (!status) return std::unexpected(status.error());
  const auto boot = if_there<protocol::BootReport>(**link);
  if (!boot) return std::unexpected(boot.error());
  const auto self_test = if_there<protocol::SelfTestReport>(**link);
  if (!self_test) return std::unexpected(self_test.error());
  return print(describe_info({*identity, *capabilities, *status, *boot, *self_test}));
}

Result<void> self_test(const Options& options) {
  auto link = open_reports(options);
  if (!link) return std::unexpected(std::move(link.error()));
  const protocol::CommandReport command{
      .command = static_cast<std::uint8_t>(protocol::BoardCommand::kSelfTest), .reserved = {}};
  if (auto set = set_report(**link, command); !set) return set;
  const auto report = get_report<protocol::SelfTestReport>(**link);
  if (!report) return std::unexpected(report.error());
  if (auto done = print(describe_self_test(*report)); !done) return done;
  switch (static_cast<protocol::SelfTestState>(report->state)) {
    case protocol::SelfTestState::kPassed:
      return {};
    case protocol::SelfTestState::kBusy:
      return fail(ErrorKind::kTimeout, "the self-test was not run: frames are under way",
                  "wait until other programs are done with the board, and try again");
    default:
      return fail(ErrorKind::kDevice, "the self-test failed",
                  "'gridrt-board log' says where; reset the board and try again");
  }
}

Result<void> counters(const Options& options) {
  auto link = open_reports(options);
  if (!link) return std::unexpected(std::move(link.error()));
  const auto report = get_report<protocol::CountersReport>(**link);
  if (!report) return std::unexpected(report.error());
  const auto stalls = if_there<protocol::StallsReport>(**link);
  if (!stalls) return std::unexpected(stalls.error());
  return print(describe_counters(*report, *stalls));
}

/// Prints what the board sends by itself, for a time.
Result<void> follow(Transport& link, std::chrono::seconds time) {
  const auto end = std::chrono::steady_clock::now() + time;
  for (;;) {
    const auto left =
        std::chrono::ceil<std::chrono::milliseconds>(end - std::chrono::steady_clock::now());
    if (left <= std::chrono::milliseconds(0)) return {};
    std::array<std::byte, protocol::kReportBytes> body{};
    const auto id = link.read_input(body, left);
    if (!id) return std::unexpected(id.error());
    constexpr std::size_t kBytes = protocol::EventReport::kBytes;
    if (*id != protocol::EventReport::kId) continue;
    const auto event = protocol::load_event_report(std::span(body).first<kBytes>());
    if (auto done = print(describe_event(event)); !done) return done;
  }
}

Result<void> log(const Options& options) {
  constexpr int kMostReports = 1000;  // a board in order has far fewer
  auto link = open_reports(options);
  if (!link) return std::unexpected(std::move(link.error()));
  bool lost = false;
  for (int i = 0; i < kMostReports; ++i) {
    const auto journal = get_report<protocol::JournalReport>(**link);
    if (!journal) return std::unexpected(journal.error());
    lost = lost || journal->lost != 0;
    if (journal->count == 0) {
      if (lost) {
        if (auto done = print("older entries were lost\n"); !done) return done;
      }
      return options.follow > 0 ? follow(**link, std::chrono::seconds(options.follow))
                                : Result<void>{};
    }
    if (auto done = print(describe_journal(*journal)); !done) return done;
  }
  return fail(ErrorKind::kProtocol, "the board's journal does not end",
              "this is a defect of the board");
}

Result<void> reset(const Options& options) {
  auto link = open_reports(options);
  if (!link) return std::unexpected(std::move(link.error()));
  if (auto set = set_report(**link, protocol::ResetReport{protocol::kResetKey}); !set) return set;
  const auto status = get_report<protocol::StatusReport>(**link);
  if (!status) return std::unexpected(status.error());
  return print(fmt::format("reset; state {}\n",
                           protocol::name(static_cast<protocol::DeviceState>(status->state))));
}

Result<void> load(const Options& options) {
  auto image = read_image(options.file);
  if (!image) return std::unexpected(std::move(image.error()));
  DeviceOptions device;
  device.name = options.device;
  auto board = open_device(device);
  if (!board) return std::unexpected(std::move(board.error()));
  if (auto loaded = (*board)->load(*image); !loaded) return loaded;
  const auto done = (*board)->counters();
  if (!done) return std::unexpected(done.error());
  return print(fmt::format("{}: {} bytes in {:.3f} s; the board answers rays\n", options.file,
                           done->bytes_out, done->upload_seconds));
}

using Action = Result<void> (*)(const Options&);

Result<std::variant<std::pair<Options, Action>, PrintAndExit>> parse(int argc,
                                                                     const char* const* argv) {
  Options options;
  Action action = nullptr;
  bool version = false;
  CLI::App app("Looks after a GridRT board on USB.", std::string(kProgram));
  app.add_option("--device", options.device, "usb or usb:SERIAL (default: the only board)");
  app.add_flag("--version", version, "the version");
  const auto verb = [&](const char* name, const char* help, Action what) {
    CLI::App* command = app.add_subcommand(name, help);
    command->fallthrough();
    command->callback([&action, what] { action = what; });
    return command;
  };
  verb("list", "the boards that there are, and whether they can be used", list);
  verb("info", "what the board is and what state it is in", info);
  verb("selftest", "trace known rays and compare every byte; the loaded image is lost", self_test);
  verb("counters", "what the board has counted since power-up or reset", counters);
  verb("log", "what the firmware has written down since the last time", log)
      ->add_option("--follow", options.follow, "then print what comes, for so many seconds")
      ->check(CLI::Range(1, 1000000));
  verb("reset", "back to no image, counters to 0", reset);
  verb("load", "send an image made by gridrt-image", load)
      ->add_option("FILE", options.file, "a .grt file")
      ->required();
  app.footer(std::string(exit_code_help()));
  auto parsed = parse_command_line(app, argc, argv);
  if (!parsed) return std::unexpected(std::move(parsed.error()));
  if (const auto& exit = *parsed) return *exit;
  if (version) return PrintAndExit{version_text(kProgram)};
  if (action == nullptr) {
    return fail(ErrorKind::kUsage, "nothing to do",
                "say list, info, selftest, counters, log, reset or load FILE");
  }
  return std::pair(std::move(options), action);
}

}  // namespace

int run_board(int argc, const char* const* argv) {
  auto parsed = parse(argc, argv);
  if (!parsed) return report(kProgram, parsed.error());
  Result<void> done;
  if (const auto* text = std::get_if<PrintAndExit>(&*parsed)) {
    done = print(text->text);
  } else {
    const auto& [options, action] = std::get<0>(*parsed);
    done = action(options);
  }
  return done ? kExitOk : report(kProgram, done.error());
}

}  // namespace gridrt
