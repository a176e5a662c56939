// How a program ends: one code for each kind of failure, and one way to report it.
#pragma once

#include <string>
#include <string_view>

#include "hal/error.hpp"

namespace gridrt {

inline constexpr int kExitOk = 0;
inline constexpr int kExitUsage = 2;
inline constexpr int kExitInput = 3;
inline constexpr int kExitFile = 4;
inline constexpr int kExitLimit = 5;
inline constexpr int kExitDevice = 6;
inline constexpr int kExitInternal = 70;

/// The exit code of a kind of failure.
int exit_code(ErrorKind kind);

/// The lines of --help that explain the exit codes.
std::string_view exit_code_help();

/// Writes "program: message" and the advice to standard error; returns the exit code.
int report(std::string_view program, const Error& error);

/// Runs `body` with what every program needs: a clear message when memory runs out or a library
/// throws, and write errors instead of signals where a file or a pipe cannot take more.
int run_program(std::string_view program, int (*body)(int, const char* const*), int argc,
                const char* const* argv);

}  // namespace gridrt
