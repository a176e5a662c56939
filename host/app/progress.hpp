// A line of progress on standard error, for people who wait.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>
#include <string_view>

#include "host/app/options.hpp"

namespace gridrt {

/// Redraws one line at most ten times a second and clears it in the end; silent where it is off,
/// or on auto where standard error is no terminal.
class Progress {
 public:
  explicit Progress(ProgressMode mode);
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  ~Progress();

  /// A phase without a known end.
  void phase(std::string_view name);

  /// `done` of `total` in the present phase, total > 0.
  void update(std::uint64_t done, std::uint64_t total);

  /// Clears the line; so that other text can be written.
  void clear();

 private:
  void draw(std::string_view text);

  bool shown_;
  std::string name_;
  std::size_t drawn_ = 0;  ///< characters on the line
  std::chrono::steady_clock::time_point phase_start_;
  std::chrono::steady_clock::time_point last_draw_;
};

}  // namespace gridrt
