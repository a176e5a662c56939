// A board with its firmware on the soft core and a hostile host at its pins: frames, reports, a
// reader that stops. What the board says to known rays meanwhile has to be right.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "hal/frame.hpp"
#include "hal/sim/board.hpp"
#include "host/image/image.hpp"
#include "tests/rtl/hostile_frames.hpp"
#include "tests/rtl/known_image.hpp"

namespace gridrt::rtl {

/// What was thrown and what came of it.
struct NoiseCounts {
  std::uint64_t frames = 0, bytes = 0, reports = 0, refused = 0, given_up = 0, hangs = 0,
                resets = 0, commands = 0, right = 0, errors = 0;
};

/// How much harm the noise may do.
enum class Harm {
  kNone,    ///< no LoadSection and no Commit has a right CRC: what is loaded stays
  kResets,  ///< also Resets, commands and an engine that hangs
  kLoads,   ///< also pieces of sections, broken ones; both known images
  kImages,  ///< also whole images of nonsense with right CRCs
};

class HostileBoard {
 public:
  /// `a` may be in the board's flash; `b` is another image. Both and `counts` must outlive this.
  HostileBoard(std::unique_ptr<SimBoard> board, std::uint64_t seed, const KnownImage& a,
               const KnownImage& b, Harm harm, NoiseCounts& counts);

  /// Loads `a` as a host in order does.
  void load();
  void make_noise(int actions);
  /// Reads until the board has taken all bytes and, after a hang, is back.
  void calm_down();

  /// Whether a payload answers known_rays() rightly for a known image.
  [[nodiscard]] bool is_right(std::span<const std::byte> hits) const;

  std::unique_ptr<SimBoard> release() { return std::move(board_); }

 private:
  void act();
  void throw_frame(std::vector<std::byte> frame);
  void run(std::uint64_t clocks, ReportAccess* access = nullptr);
  void listen(std::span<const std::byte> bytes);
  void stop_reading();
  void report();
  void hang();
  ReportAccess random_report();
  std::vector<std::byte> endless();
  std::vector<std::byte> late_piece();
  std::uint32_t below(std::uint32_t bound) { return hostile_.below(bound); }

  std::unique_ptr<SimBoard> board_;
  HostileFrames hostile_;
  const KnownImage& a_;
  const KnownImage& b_;
  Harm harm_;
  NoiseCounts& counts_;
  std::vector<std::byte> waiting_;  // for the board
  FrameReader reader_;
  std::uint32_t asked_ = 0;  // known_trace()s so far
};

}  // namespace gridrt::rtl
