#include "hal/loopback.hpp"

#include <algorithm>
#include <utility>

namespace gridrt {
namespace {

constexpr std::size_t kReadBytes = 65536;

}  // namespace

LoopbackTransport::LoopbackTransport(std::unique_ptr<Endpoint> endpoint, LoopbackOptions options)
    : endpoint_(std::move(endpoint)), options_(options), random_(options.seed) {
  if (options_.to_device.any()) {
    to_device_.emplace(options_.to_device, random_());
  }
  if (options_.to_host.any()) {
    to_host_.emplace(options_.to_host, random_());
  }
}

std::size_t LoopbackTransport::cut(std::size_t bytes) {
  if (options_.max_transfer == 0 || bytes == 0) {
    return bytes;
  }
  return std::min(bytes, 1 + random_() % options_.max_transfer);
}

Result<void> LoopbackTransport::consume_in_pieces(std::span<const std::byte> bytes) {
  while (!bytes.empty()) {
    const std::size_t size = cut(bytes.size());
    if (auto done = endpoint_->consume(bytes.first(size)); !done) {
      return done;
    }
    bytes = bytes.subspan(size);
  }
  return {};
}

Result<void> LoopbackTransport::send(std::span<const std::byte> bytes) {
  if (!to_device_) {
    return consume_in_pieces(bytes);
  }
  outgoing_.clear();
  to_device_->apply(bytes, outgoing_);
  return consume_in_pieces(outgoing_);
}

Result<std::size_t> LoopbackTransport::receive(std::span<std::byte> out,
                                               std::chrono::milliseconds timeout) {
  if (!to_host_) {
    return endpoint_->produce(out.first(cut(out.size())), timeout);
  }
  const auto end = std::chrono::steady_clock::now() + timeout;
  while (taken_ == incoming_.size()) {
    incoming_.resize(kReadBytes);
    taken_ = 0;
    const auto left =
        std::chrono::ceil<std::chrono::milliseconds>(end - std::chrono::steady_clock::now());
    auto count = endpoint_->produce(incoming_, std::max(left, std::chrono::milliseconds(0)));
    const std::vector<std::byte> raw(
        incoming_.begin(), incoming_.begin() + static_cast<std::ptrdiff_t>(count.value_or(0)));
    incoming_.clear();
    if (!count || *count == 0) {
      return count;
    }
    to_host_->apply(raw, incoming_);
  }
  const std::size_t size = cut(std::min(out.size(), incoming_.size() - taken_));
  std::copy_n(incoming_.begin() + static_cast<std::ptrdiff_t>(taken_), size, out.begin());
  taken_ += size;
  return size;
}

Result<void> LoopbackTransport::get_feature(std::uint8_t id, std::span<std::byte> body) {
  return endpoint_->get_feature(id, body);
}

Result<void> LoopbackTransport::set_feature(std::uint8_t id, std::span<const std::byte> body) {
  return endpoint_->set_feature(id, body);
}

std::uint64_t LoopbackTransport::faults() const {
  return (to_device_ ? to_device_->faults() : 0) + (to_host_ ? to_host_->faults() : 0);
}

}  // namespace gridrt
