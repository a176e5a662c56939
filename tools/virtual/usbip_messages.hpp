// The messages of USB/IP 1.1.1 (Linux, Documentation/usb/usbip_protocol.rst), all big endian.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tools/virtual/usb_function.hpp"

namespace gridrt::usbip {

inline constexpr std::size_t kOperationBytes = 8;  ///< head of a request before a device is taken
inline constexpr std::size_t kBusIdBytes = 32;     ///< follows an import request's head
inline constexpr std::size_t kUrbBytes = 48;       ///< head of everything after that
inline constexpr std::uint32_t kMostTransfer = 1U << 24U;  ///< bytes of one transfer

enum class Operation : std::uint16_t {
  kListDevices = 0x8005,
  kImport = 0x8003,
};

/// The operation that a head asks for; nothing for other versions and unknown codes.
std::optional<Operation> read_operation(std::span<const std::byte, kOperationBytes> head);

/// What the other side is told about the only device.
struct DeviceText {
  std::string bus_id = "1-1";
  bool high_speed = true;
  bool configured = false;
};

std::vector<std::byte> device_list(const DeviceText& device);

/// The answer to an import request for `bus_id`, and whether it is a yes.
std::vector<std::byte> import_answer(const DeviceText& device,
                                     std::span<const std::byte, kBusIdBytes> bus_id, bool& taken);

/// A transfer, or the wish to forget one.
struct Urb {
  enum class Kind { kSubmit, kUnlink };
  Kind kind = Kind::kSubmit;
  std::uint32_t sequence = 0;
  bool in = false;            ///< to the host
  std::uint8_t endpoint = 0;  ///< number, without the direction
  std::uint32_t length = 0;   ///< of the transfer; for kUnlink the sequence that it is about
  SetupPacket setup = {};
  [[nodiscard]] std::uint8_t address() const {
    return static_cast<std::uint8_t>(endpoint | (in ? 0x80U : 0U));
  }
};

/// Nothing for heads that are not as they should be: an unknown command, an endpoint above 15, more
/// than kMostTransfer bytes, isochronous packets.
std::optional<Urb> read_urb(std::span<const std::byte, kUrbBytes> head);

/// The head of the answer to a transfer; bytes of transfers to the host follow. `moved` counts
/// bytes in either direction.
std::array<std::byte, kUrbBytes> submit_answer(const Urb& urb, TransferState state,
                                               std::size_t moved);

/// The answer to kUnlink: whether the transfer had not ended yet.
std::array<std::byte, kUrbBytes> unlink_answer(const Urb& urb, bool was_waiting);

}  // namespace gridrt::usbip
