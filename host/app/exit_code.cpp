#include "host/app/exit_code.hpp"

#include <csignal>
#include <cstdio>
#include <exception>
#include <new>

#include <fmt/format.h>

namespace gridrt {

int exit_code(ErrorKind kind) {
  switch (kind) {
    case ErrorKind::kUsage:
      return kExitUsage;
    case ErrorKind::kInput:
      return kExitInput;
    case ErrorKind::kFile:
      return kExitFile;
    case ErrorKind::kLimit:
    case ErrorKind::kUnsupported:
      return kExitLimit;
    case ErrorKind::kTransport:
    case ErrorKind::kTimeout:
    case ErrorKind::kProtocol:
    case ErrorKind::kDevice:
      return kExitDevice;
    case ErrorKind::kInternal:
      break;
  }
  return kExitInternal;
}

std::string_view exit_code_help() {
  return "Exit codes:\n"
         "  0   done\n"
         "  2   an option or argument is wrong\n"
         "  3   the content of an input file is wrong\n"
         "  4   a file cannot be opened, read or written\n"
         "  5   too large, or not supported by this build or device\n"
         "  6   the device failed, did not answer in time or answered nonsense\n"
         "  70  a defect of this program, or no memory left\n";
}

int report(std::string_view program, const Error& error) {
  std::string text = fmt::format("{}: {}\n", program, error.message);
  if (!error.advice.empty()) text += fmt::format("  {}\n", error.advice);
  if (error.kind == ErrorKind::kUsage) text += fmt::format("  See '{} --help'.\n", program);
  if (error.kind == ErrorKind::kInternal) {
    text += "  This is a defect of the program; please report it with the command line.\n";
  }
  std::fputs(text.c_str(), stderr);
  return exit_code(error.kind);
}

int run_program(std::string_view program, int (*body)(int, const char* const*), int argc,
                const char* const* argv) {
  std::signal(SIGXFSZ, SIG_IGN);
  std::signal(SIGPIPE, SIG_IGN);
  try {
    return body(argc, argv);
  } catch (const std::bad_alloc&) {
    std::fprintf(
        stderr,
        "%.*s: not enough memory\n"
        "  A smaller picture, fewer samples, fewer triangles or a coarser --grid need less.\n",
        static_cast<int>(program.size()), program.data());
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%.*s: internal error: %s\n", static_cast<int>(program.size()),
                 program.data(), error.what());
  }
  return kExitInternal;
}

}  // namespace gridrt
