// What a board does on USB, without a bus: descriptors, requests, bulk pipes and HID reports in
// front of an Endpoint. Servers and tests put a bus before it.
#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "gridrt_protocol.hpp"
#include "hal/endpoint.hpp"

namespace gridrt {

/// The eight bytes that begin a control transfer.
struct SetupPacket {
  std::uint8_t request_type = 0;
  std::uint8_t request = 0;
  std::uint16_t value = 0;
  std::uint16_t index = 0;
  std::uint16_t length = 0;
};

/// How a transfer ended, or that it has not yet.
enum class TransferState {
  kDone,
  kWaiting,  ///< nothing to give yet (NAK)
  kStalled,
  kGone,  ///< the device has failed and is off the bus
};

/// The answer to a control transfer: nothing is a stall. Transfers to the device answer no bytes.
using ControlAnswer = std::optional<std::vector<std::byte>>;

/// Writes an input report that the device sends by itself, id first, and returns its bytes; 0: none
/// waits.
using InputSource = std::function<std::size_t(std::span<std::byte> report)>;

struct UsbFunctionOptions {
  std::string serial = "virtual-1";  ///< at most 16 characters of ASCII
  bool high_speed = true;
  InputSource input = {};  ///< none: a Status report each time that it has changed
};

/// Used by one thread at a time.
class UsbFunction {
 public:
  /// `endpoint` must outlive it.
  explicit UsbFunction(Endpoint& endpoint, UsbFunctionOptions options = {});

  /// A bus reset: not configured, nothing halted.
  void reset();

  /// `data` are the bytes of a transfer to the device.
  ControlAnswer control(const SetupPacket& setup, std::span<const std::byte> data);

  /// Bytes of bulk OUT transfers, all of which are taken.
  TransferState bulk_out(std::span<const std::byte> bytes);

  /// Bytes for a bulk IN transfer; waits up to `patience` for the first. `given` is how many.
  TransferState bulk_in(std::span<std::byte> room, std::size_t& given,
                        std::chrono::milliseconds patience);

  /// An input report, id first.
  TransferState interrupt_in(std::span<std::byte> room, std::size_t& given);

  /// An output report, id first.
  TransferState interrupt_out(std::span<const std::byte> bytes);

  [[nodiscard]] bool is_configured() const { return configuration_ != 0; }
  [[nodiscard]] bool is_high_speed() const { return options_.high_speed; }

  /// Halts an endpoint, as SET_FEATURE does: its transfers stall until the host clears that.
  void halt(std::uint8_t endpoint) { halted_[slot(endpoint)] = true; }

 private:
  static std::size_t slot(std::uint8_t endpoint) {
    return (endpoint & 0x0FU) | ((endpoint & 0x80U) != 0 ? 0x10U : 0U);
  }
  [[nodiscard]] ControlAnswer descriptor(const SetupPacket& setup) const;
  [[nodiscard]] ControlAnswer text(std::uint8_t index) const;
  ControlAnswer standard(const SetupPacket& setup);
  ControlAnswer of_endpoint(const SetupPacket& setup);
  ControlAnswer report(const SetupPacket& setup, std::span<const std::byte> data);
  [[nodiscard]] TransferState state_of(std::uint8_t endpoint) const;

  using Report = std::array<std::byte, protocol::kReportBytes>;

  Endpoint& endpoint_;
  UsbFunctionOptions options_;
  std::uint8_t configuration_ = 0;
  std::uint8_t idle_ = 0;
  bool gone_ = false;
  std::array<bool, 32> halted_{};
  std::optional<Report> told_;  // the Status report that interrupt_in() gave last
};

}  // namespace gridrt
