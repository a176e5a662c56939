// The device's end of a link, for devices that live in this process.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <span>

#include "hal/error.hpp"

namespace gridrt {

/// A device seen from the wire. Calls come from one thread at a time; an endpoint may work on
/// threads of its own meanwhile.
class Endpoint {
 public:
  Endpoint() = default;
  Endpoint(const Endpoint&) = delete;
  Endpoint& operator=(const Endpoint&) = delete;
  virtual ~Endpoint() = default;

  /// Takes all bytes, cut anywhere, good or bad. Errors: kDevice if the device can go on no more.
  virtual Result<void> consume(std::span<const std::byte> bytes) = 0;

  /// Writes answer bytes to `out` and returns how many; waits for some while work is under way,
  /// but no longer than the timeout. 0: nothing to say (yet). Errors: kDevice.
  virtual Result<std::size_t> produce(std::span<std::byte> out,
                                      std::chrono::milliseconds timeout) = 0;

  /// Fills the bytes behind a feature report's id (zeros where there are no more). Errors:
  /// kUnsupported for an unknown id.
  virtual Result<void> get_feature(std::uint8_t id, std::span<std::byte> body) = 0;

  /// Takes a feature report's bytes behind its id. Errors: kUnsupported for an unknown id,
  /// kProtocol for wrong content.
  virtual Result<void> set_feature(std::uint8_t id, std::span<const std::byte> body) = 0;
};

}  // namespace gridrt
