// A board in software: the firmware's logic around a core that is any Endpoint (software PEs, for
// one), with a mailbox, a feed, a flash and a watch as the hardware has them.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "firmware/firmware.hpp"
#include "hal/endpoint.hpp"
#include "hal/frame.hpp"

namespace gridrt::firmware {

struct BoardModelOptions {
  std::string serial = {};            ///< at most 16 characters
  std::vector<std::byte> flash = {};  ///< from flash_address on; empty: an erased flash
  SelfTestVectors vectors = {};       ///< memory stays the caller's
  /// Of tests: what firmware reads at an address instead of the value that is there.
  std::function<std::uint32_t(std::uint32_t address, std::uint32_t value)> reads = {};
  /// Of tests: told what firmware writes before it takes effect.
  std::function<void(std::uint32_t address, std::uint32_t data)> writes = {};
};

/// An input report on its way to the host.
struct InputReport {
  std::uint8_t id = 0;
  std::array<std::byte, protocol::kReportBytes - 1> body{};
};

/// The board as the wire sees it. Reports pass through the firmware; so do frames while it boots or
/// tests itself, else they go to the core. Used by one thread at a time.
class BoardModel final : public Endpoint, private Registers {
 public:
  /// Powers it up: boots from flash if there is an image.
  BoardModel(std::unique_ptr<Endpoint> core, const BoardModelOptions& options);

  Result<void> consume(std::span<const std::byte> bytes) override;
  Result<std::size_t> produce(std::span<std::byte> out, std::chrono::milliseconds timeout) override;
  /// Errors besides the core's: kUnsupported if the firmware refuses (a stall on the wire).
  Result<void> get_feature(std::uint8_t id, std::span<std::byte> body) override;
  Result<void> set_feature(std::uint8_t id, std::span<const std::byte> body) override;

  /// The input report that waits for the host, if one does.
  std::optional<InputReport> take_input();

  /// Lets the firmware do what it does without being asked.
  void poll();

  /// Faults, until the core is reset: its engine has rays and answers none; its registers are not
  /// served; its loader takes nothing.
  void hang_engine() { stuck_ = kLimit; }
  void break_bus() { bus_broken_ = true; }
  void stop_loader() { loader_stopped_ = true; }
  /// A fault of the flash: no word comes from this one on.
  void silence_flash(std::size_t from_word) { flash_words_ = from_word; }

  /// Times that the core was reset from outside.
  [[nodiscard]] int core_resets() const { return core_resets_; }

 private:
  static constexpr std::uint32_t kLimit = 1U << 20U;

  std::uint32_t read(std::uint32_t address) override;
  std::uint32_t read_honestly(std::uint32_t address);
  void write(std::uint32_t address, std::uint32_t data) override;
  std::uint32_t read_window(std::uint32_t address);
  void write_window(std::uint32_t address, std::uint32_t data);
  std::uint32_t read_watch(std::uint32_t address) const;
  std::uint32_t read_answer();
  std::uint32_t flash_word();
  void set_source(std::uint32_t data);
  void reset_core();
  void look_at_image();
  Result<void> ask(wire::MailboxKind kind, std::uint8_t id, std::size_t length);

  std::unique_ptr<Endpoint> core_;
  std::array<std::uint32_t, 4> serial_{};
  std::uint32_t reports_ = 0;  // that the core has, a bit each
  std::vector<std::byte> flash_;
  std::function<std::uint32_t(std::uint32_t, std::uint32_t)> reads_;
  std::function<void(std::uint32_t, std::uint32_t)> writes_;
  std::map<std::uint32_t, std::vector<std::byte>> windows_;  // by base: what was read or written
  std::array<std::uint32_t, 16> body_{};
  std::array<std::uint32_t, 16> event_body_{};
  std::optional<std::uint8_t> event_;
  std::uint32_t request_ = 0;
  std::optional<std::uint32_t> answer_;
  std::uint32_t tag_ = 0;
  FrameReader link_frames_;  // only to know whether one is under way
  bool firmware_speaks_ = true;
  std::vector<std::byte> answers_;  // of the core, for the firmware
  std::size_t taken_ = 0;
  std::vector<std::byte> held_;  // from the link while the firmware speaks
  std::size_t flash_at_ = 0;     // words
  std::size_t flash_words_ = ~std::size_t{0};
  bool image_lost_ = true;
  std::uint32_t bus_ = 0;
  std::uint32_t stuck_ = 0;
  bool bus_broken_ = false;
  bool loader_stopped_ = false;
  int core_resets_ = 0;
  std::uint32_t clocks_ = 0;
  std::optional<Error> broken_;  // of the core
  Firmware firmware_;
};

}  // namespace gridrt::firmware
