#include "host/app/progress.hpp"

#include <algorithm>
#include <cstdio>

#include <fmt/format.h>
#include <unistd.h>

namespace gridrt {

Progress::Progress(ProgressMode mode)
    : shown_(mode == ProgressMode::kOn ||
             (mode == ProgressMode::kAuto && ::isatty(STDERR_FILENO) == 1)) {}

Progress::~Progress() { clear(); }

void Progress::phase(std::string_view name) {
  if (!shown_) return;
  name_ = name;
  phase_start_ = std::chrono::steady_clock::now();
  last_draw_ = phase_start_;
  draw(name_ + " ...");
}

void Progress::update(std::uint64_t done, std::uint64_t total) {
  if (!shown_) return;
  constexpr auto kPause = std::chrono::milliseconds(100);
  const auto now = std::chrono::steady_clock::now();
  if (now - last_draw_ < kPause) return;
  last_draw_ = now;
  constexpr std::size_t kBar = 30;
  const double share = static_cast<double>(done) / static_cast<double>(total);
  const auto full = std::min(kBar, static_cast<std::size_t>(share * kBar));
  const double elapsed = std::chrono::duration<double>(now - phase_start_).count();
  const double left = share > 0.0 ? elapsed * (1.0 - share) / share : 0.0;
  draw(fmt::format("{} [{}{}] {:3.0f} %, {:.0f} s left", name_, std::string(full, '#'),
                   std::string(kBar - full, '.'), share * 100.0, left));
}

void Progress::clear() {
  if (!shown_ || drawn_ == 0) return;
  std::fprintf(stderr, "\r%*s\r", static_cast<int>(drawn_), "");
  std::fflush(stderr);
  drawn_ = 0;
}

void Progress::draw(std::string_view text) {
  const std::size_t padding = drawn_ > text.size() ? drawn_ - text.size() : 0;
  std::fprintf(stderr, "\r%.*s%*s", static_cast<int>(text.size()), text.data(),
               static_cast<int>(padding), "");
  std::fflush(stderr);
  drawn_ = text.size();
}

}  // namespace gridrt
