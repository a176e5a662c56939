// gridrt_shell with a link, a register bus and a stand-in engine around it, and frames to send.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <optional>
#include <random>
#include <span>
#include <vector>

#include <Vgridrt_shell.h>

#include "gridrt_protocol.hpp"
#include "hal/frame.hpp"
#include "host/image/image.hpp"
#include "tests/rtl/clocked.hpp"
#include "tests/rtl/payloads.hpp"

namespace gridrt::rtl {

/// A record on its way to the engine's memories.
struct LoadedRecord {
  std::uint8_t kind = 0;
  std::uint8_t pe = 0;
  std::uint16_t index = 0;
  std::uint64_t data = 0;  ///< 56 bits
  friend bool operator==(const LoadedRecord&, const LoadedRecord&) = default;
};

/// What the stand-in engine answers.
struct EngineHit {
  bool hit = false;
  std::uint32_t id = protocol::kNoIdCompact;
};

/// How often each side of a stream is willing, in percent of clocks.
struct Pace {
  int rx = 100;
  int tx = 100;
  int ray = 100;
  int hit = 100;
  int latency = 40;  ///< clocks from a ray to its answer, at the least
};

class ShellBench {
 public:
  explicit ShellBench(unsigned seed = 1);

  Pace pace;
  /// The stand-in's answer to a ray; by default made up of the ray's bits.
  std::function<EngineHit(const protocol::RayCompact&)> engine;

  /// Bytes that wait for the device, and bytes that it has sent.
  std::deque<std::byte> to_device;
  std::vector<std::byte> from_device;
  /// What went to the engine.
  std::vector<LoadedRecord> loads;
  std::vector<protocol::RayCompact> rays;
  int configs = 0;
  /// What the engine counts in this clock: gridrt_pkg::counts_t, and words of its tap.
  std::uint64_t counts = 0;
  std::array<std::uint32_t, 8> tap{};

  void tick();
  void run(int clocks);
  /// Until all bytes have been taken and the device has been silent for `clocks` clocks.
  void run_until_quiet(int clocks = 400);

  std::uint32_t read(std::uint32_t address);
  void write(std::uint32_t address, std::uint32_t data);
  /// The report behind a window of registers.
  template <class Report>
  Report report(std::uint32_t base) {
    std::array<std::byte, Report::kBytes> bytes{};
    for (std::size_t i = 0; i < bytes.size() / 4; ++i) {
      protocol::detail::put32(bytes.data() + 4 * i, read(base + 4 * static_cast<unsigned>(i)));
    }
    Report out;
    protocol::load(bytes, out);
    return out;
  }
  protocol::StatusReport status();
  void reset_report();

  void send(std::span<const std::byte> bytes);
  void send(protocol::FrameType type, std::uint32_t sequence, std::span<const std::byte> payload,
            protocol::Layout layout = protocol::Layout::kNone);

  [[nodiscard]] long clocks() const { return shell_.clocks(); }
  Vgridrt_shell& ports() { return *shell_; }

 private:
  struct Flying {
    EngineHit hit;
    long due = 0;
  };
  bool chance(int percent);
  void sample_load();
  [[nodiscard]] protocol::RayCompact ray_at_port();

  Clocked<Vgridrt_shell> shell_;
  std::mt19937 random_;
  std::deque<Flying> flying_;
  bool rx_offered_ = false;
  bool hit_offered_ = false;
  int config_left_ = 0;
  bool tx_held_ = false;
  std::uint8_t tx_byte_ = 0;
};

/// A frame that the device has sent.
struct Answer {
  protocol::FrameHeader header;
  bool good = false;  ///< the payload's CRC matches
  std::vector<std::byte> payload;
  [[nodiscard]] protocol::FrameType type() const {
    return static_cast<protocol::FrameType>(header.type);
  }
  /// Of an Error frame.
  [[nodiscard]] protocol::ErrorCode code() const;
  [[nodiscard]] std::uint32_t detail() const;
};

/// Takes the frames out of from_device, which must hold nothing else unless `garbage` is given.
std::vector<Answer> take_answers(ShellBench& bench, std::size_t* garbage = nullptr);

/// Sends a section in pieces of at most `piece` bytes (a multiple of 4); returns the next sequence
/// number.
std::uint32_t send_section(ShellBench& bench, protocol::SectionKind kind, std::uint8_t pe,
                           std::span<const std::byte> bytes, std::uint32_t sequence,
                           std::size_t piece = 4096);

/// Sends everything that a device needs of an image, and Commit; returns Commit's sequence number.
std::uint32_t send_image(ShellBench& bench, const Image& image, std::uint32_t sequence,
                         std::size_t piece = 4096);

/// The records of the image, in the order of its sections.
std::vector<LoadedRecord> records_of(const Image& image);

/// An image in the compact layout, of a scene with some hundred triangles.
Image small_image(int bits = 17, int pes = 4);

/// The engine's answers to these rays as the payload of a Hits frame.
std::vector<std::byte> hits_payload(const ShellBench& bench,
                                    std::span<const protocol::RayCompact> rays, std::uint32_t tag);

}  // namespace gridrt::rtl
