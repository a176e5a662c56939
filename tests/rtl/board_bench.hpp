// What tests of the board with its firmware share: the simulated board from its pins, an image, a
// flash image, rays.
#pragma once

#include <array>
#include <random>
#include <vector>

#include <Vgridrt_board.h>
#include <gtest/gtest.h>

#include "hal/frame.hpp"
#include "hal/sim/sim_transport.hpp"
#include "hal/sim/verilated_board.hpp"
#include "host/driver/flash_image.hpp"
#include "host/driver/session.hpp"
#include "host/image/image_file.hpp"
#include "tests/rtl/board_image.hpp"
#include "tests/unit/image_support.hpp"

namespace gridrt {

inline constexpr std::uint32_t kHangs = 0xDEAD0;  ///< of GRIDRT_TEST_HANG in rtl/gridrt_core.sv

class Bench {
 public:
  explicit Bench(std::vector<std::byte> flash = {}) {
    auto board = std::make_unique<VerilatedBoard<Vgridrt_board>>();
    board->set_flash(std::move(flash));
    board->power_up();
    board_ = board.get();
    link_ = std::make_unique<SimTransport>(
        std::move(board), SimTransportOptions{.silent_clocks = 5000, .most_silences = 20});
  }

  SimTransport& link() { return *link_; }
  SimBoard& board() { return *board_; }

  template <class Report>
  Report report() {
    const auto got = get_report<Report>(*link_);
    EXPECT_TRUE(got) << got.error().message;
    return got.value_or(Report{});
  }
  bool command(protocol::BoardCommand what) {
    return set_report(*link_, protocol::CommandReport{.command = static_cast<std::uint8_t>(what)})
        .has_value();
  }
  protocol::DeviceState state() {
    return static_cast<protocol::DeviceState>(report<protocol::StatusReport>().state);
  }
  /// Codes of all that the journal holds.
  std::vector<protocol::JournalCode> journal() {
    std::vector<protocol::JournalCode> all;
    for (;;) {
      const auto part = report<protocol::JournalReport>();
      if (part.count == 0) return all;
      for (std::size_t i = 0; i < part.count; ++i) {
        all.push_back(static_cast<protocol::JournalCode>(part.codes[i]));
      }
    }
  }
  /// The link as a device that is open. The bench has no link of its own any more.
  std::unique_ptr<Session> open() {
    auto session = Session::open(std::move(link_), {.name = "sim"});
    EXPECT_TRUE(session) << session.error().message;
    return std::move(*session);
  }
  /// Lets so many clocks pass in silence, and reads what the board has to say before.
  void run(std::uint64_t clocks) {
    std::array<std::byte, 4096> read{};
    board_->run({}, read, {.quiet = clocks, .gap = clocks});
  }

 private:
  std::unique_ptr<SimTransport> link_;
  SimBoard* board_ = nullptr;
};

inline const Image& image() {
  static const Image made = board_image({5, 4, 5}, 40, 3, 0.6F);
  return made;
}

inline protocol::CapabilitiesReport capabilities() {
  Bench bench;
  return bench.report<protocol::CapabilitiesReport>();
}

inline std::vector<std::byte> flash() {
  auto made = flash_image(image(), capabilities());
  EXPECT_TRUE(made) << made.error().message;
  return made.value_or(std::vector<std::byte>{});
}

inline std::vector<Segment> segments() {
  std::mt19937 random(5);
  std::vector<Segment> out(200);
  for (Segment& s : out) {
    for (int a = 0; a < 3; ++a) {
      const auto box = static_cast<unsigned>(image().header.max_q[static_cast<std::size_t>(a)]) + 3;
      s.p0[a] = static_cast<int>(random() % box);
      s.p1[a] = static_cast<int>(random() % box);
    }
    s.t1 = 1.0;
  }
  return out;
}

inline std::vector<Hit> trace(Device& device) {
  const auto rays = segments();
  std::vector<Hit> hits(rays.size());
  const auto done = device.trace(rays, Query::kClosestHit, hits);
  EXPECT_TRUE(done) << done.error().message;
  return hits;
}

/// The software PEs' hits of segments() in image().
inline const std::vector<Hit>& expected() {
  static const std::vector<Hit> only = [] {
    auto seq = open_device({.name = "seq-board"});
    EXPECT_TRUE(seq);
    EXPECT_TRUE((*seq)->load(image()));
    return trace(**seq);
  }();
  return only;
}

inline std::vector<std::byte> trace_frame(std::uint32_t ignore) {
  std::vector<std::byte> frame;
  FrameBuilder builder(frame, protocol::FrameType::kTrace, protocol::Layout::kCompact, 99);
  std::array<std::byte, protocol::TraceHead::kBytes> head{};
  protocol::store(protocol::TraceHead{1, 1}, head);
  builder.append(head);
  std::array<std::byte, protocol::RayCompact::kBytes> ray{};
  protocol::pack(protocol::RayCompact{.p0 = {1, 1, 1}, .p1 = {9, 9, 9}, .ignore = ignore}, ray);
  builder.append(ray);
  EXPECT_TRUE(builder.finish());
  return frame;
}

}  // namespace gridrt
