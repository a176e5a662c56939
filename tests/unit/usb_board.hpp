// A board on the fake bus: software PEs with the board's limits behind frames that go wrong.
#pragma once

#include <chrono>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "hal/fault_injector.hpp"
#include "host/pe/software_device.hpp"
#include "tests/unit/usb_fake_bus.hpp"
#include "tools/virtual/usb_function.hpp"

namespace gridrt::fake {

/// An endpoint whose frames suffer in both directions.
class BadFrames final : public Endpoint {
 public:
  BadFrames(std::unique_ptr<Endpoint> inner, const FaultRates& to_device, const FaultRates& to_host,
            std::uint64_t seed)
      : inner_(std::move(inner)) {
    if (to_device.any()) to_device_.emplace(to_device, seed);
    if (to_host.any()) to_host_.emplace(to_host, seed + 1);
  }

  Result<void> consume(std::span<const std::byte> bytes) override {
    if (!to_device_) return inner_->consume(bytes);
    std::vector<std::byte> left;
    to_device_->apply(bytes, left);
    return left.empty() ? Result<void>{} : inner_->consume(left);
  }

  Result<std::size_t> produce(std::span<std::byte> out,
                              std::chrono::milliseconds timeout) override {
    if (!to_host_) return inner_->produce(out, timeout);
    if (taken_ == ready_.size()) {
      std::vector<std::byte> raw(std::size_t{1} << 16U);
      const auto got = inner_->produce(raw, timeout);
      if (!got) return got;
      ready_.clear();
      taken_ = 0;
      to_host_->apply(std::span(raw).first(*got), ready_);
    }
    const std::size_t size = std::min(out.size(), ready_.size() - taken_);
    std::copy_n(ready_.begin() + static_cast<std::ptrdiff_t>(taken_), size, out.begin());
    taken_ += size;
    return size;
  }

  Result<void> get_feature(std::uint8_t id, std::span<std::byte> body) override {
    auto done = inner_->get_feature(id, body);
    if (id == protocol::IdentityReport::kId && wrong_version_) body[0] ^= std::byte{0x80};
    return done;
  }

  Result<void> set_feature(std::uint8_t id, std::span<const std::byte> body) override {
    return inner_->set_feature(id, body);
  }

  /// Says that it speaks another version of the protocol.
  void speak_another_version() { wrong_version_ = true; }

  [[nodiscard]] std::uint64_t faults() const {
    return (to_device_ ? to_device_->faults() : 0) + (to_host_ ? to_host_->faults() : 0);
  }

 private:
  std::unique_ptr<Endpoint> inner_;
  std::optional<FaultInjector> to_device_;
  std::optional<FaultInjector> to_host_;
  std::vector<std::byte> ready_;
  std::size_t taken_ = 0;
  bool wrong_version_ = false;
};

/// Software PEs with the board's limits.
inline std::unique_ptr<Endpoint> software_board(std::chrono::milliseconds frame_patience) {
  SoftwareDeviceOptions options{.name = "board", .capabilities = board_capabilities()};
  options.frame_patience = frame_patience;
  return std::make_unique<SoftwareDevice>(std::move(options));
}

}  // namespace gridrt::fake
