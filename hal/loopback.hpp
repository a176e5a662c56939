// A link to a device in this process, as clean or as nasty as a test wants it.
#pragma once

#include <memory>
#include <optional>
#include <random>
#include <vector>

#include "hal/endpoint.hpp"
#include "hal/fault_injector.hpp"
#include "hal/transport.hpp"

namespace gridrt {

/// What a LoopbackTransport does to the bytes; by default nothing.
struct LoopbackOptions {
  std::size_t max_transfer = 0;  ///< cut transfers at random sizes in [1, this]; 0: never
  FaultRates to_device = {};     ///< faults on frames from host to device
  FaultRates to_host = {};       ///< faults on frames from device to host
  std::uint64_t seed = 1;        ///< of cuts and faults
};

/// A Transport whose far end is an Endpoint that it owns.
class LoopbackTransport final : public Transport {
 public:
  explicit LoopbackTransport(std::unique_ptr<Endpoint> endpoint, LoopbackOptions options = {});

  Result<void> send(std::span<const std::byte> bytes) override;
  Result<std::size_t> receive(std::span<std::byte> out, std::chrono::milliseconds timeout) override;
  Result<void> get_feature(std::uint8_t id, std::span<std::byte> body) override;
  Result<void> set_feature(std::uint8_t id, std::span<const std::byte> body) override;

  /// Faults injected so far, both ways.
  [[nodiscard]] std::uint64_t faults() const;

 private:
  std::size_t cut(std::size_t bytes);
  Result<void> consume_in_pieces(std::span<const std::byte> bytes);

  std::unique_ptr<Endpoint> endpoint_;
  LoopbackOptions options_;
  std::mt19937_64 random_;
  std::optional<FaultInjector> to_device_;
  std::optional<FaultInjector> to_host_;
  std::vector<std::byte> outgoing_;  // behind the injector, on the way to the device
  std::vector<std::byte> incoming_;  // behind the injector, not yet received
  std::size_t taken_ = 0;            // of incoming_
};

}  // namespace gridrt
