// A board on USB as a Transport.
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>

#include "hal/transport.hpp"
#include "hal/usb/usb.hpp"

namespace gridrt {

class BulkLink;
class HidLink;

class UsbTransport final : public Transport {
 public:
  /// See open_usb().
  static Result<std::unique_ptr<UsbTransport>> open(const UsbOptions& options);
  ~UsbTransport() override;

  /// Errors: those of Transport, and kInternal without UsbOptions::frames.
  Result<void> send(std::span<const std::byte> bytes) override;
  Result<std::size_t> receive(std::span<std::byte> out, std::chrono::milliseconds timeout) override;
  Result<void> get_feature(std::uint8_t id, std::span<std::byte> body) override;
  Result<void> set_feature(std::uint8_t id, std::span<const std::byte> body) override;

  Result<std::optional<std::uint8_t>> read_input(std::span<std::byte> body,
                                                 std::chrono::milliseconds timeout) override;

  /// Waits until the board has taken all that was sent. Errors: as send().
  Result<void> flush();

  /// Sends a report on the interrupt endpoint. Errors: as set_feature().
  Result<void> write_output(std::uint8_t id, std::span<const std::byte> body);

  [[nodiscard]] const UsbBoard& board() const { return board_; }

 private:
  struct Libusb;  // context and handle, which outlive the links
  UsbTransport();

  UsbBoard board_;
  std::unique_ptr<Libusb> libusb_;
  std::unique_ptr<HidLink> reports_;
  std::unique_ptr<BulkLink> frames_;
};

}  // namespace gridrt
