// The program gridrt-image.
#pragma once

namespace gridrt {

/// Runs gridrt-image with its command line; returns the exit code (see exit_code_help).
int run_image(int argc, const char* const* argv);

}  // namespace gridrt
