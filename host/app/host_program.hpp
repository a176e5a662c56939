// The program gridrt-host.
#pragma once

namespace gridrt {

/// Runs gridrt-host with its command line; returns the exit code (see exit_code_help).
int run_host(int argc, const char* const* argv);

}  // namespace gridrt
