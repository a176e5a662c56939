// The reports of a board through its hidraw node. For the files of this folder only.
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include <hidapi.h>

#include "hal/error.hpp"

namespace gridrt {

class HidLink {
 public:
  /// `port` is where the board is plugged in. The kernel makes the node a moment after the board:
  /// waits for it for up to two seconds. Errors: kTransport.
  static Result<std::unique_ptr<HidLink>> open(const std::string& port);

  /// As Transport's functions of these names.
  Result<void> get_feature(std::uint8_t id, std::span<std::byte> body);
  Result<void> set_feature(std::uint8_t id, std::span<const std::byte> body);

  /// Waits for an input report; returns its id, its body in `body`, or nothing after the timeout.
  Result<std::optional<std::uint8_t>> read_input(std::span<std::byte> body,
                                                 std::chrono::milliseconds timeout);

  /// Sends an output report.
  Result<void> write_output(std::uint8_t id, std::span<const std::byte> body);

 private:
  struct Close {
    void operator()(hid_device* device) const { hid_close(device); }
  };

  HidLink(hid_device* device, std::string port) : device_(device), port_(std::move(port)) {}
  [[nodiscard]] Error failure(std::uint8_t id, int code, Error if_stalled) const;

  std::unique_ptr<hid_device, Close> device_;
  std::string port_;
};

}  // namespace gridrt
