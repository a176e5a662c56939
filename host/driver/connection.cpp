#include "host/driver/connection.hpp"

#include <algorithm>
#include <utility>
#include <variant>

#include <fmt/format.h>

namespace gridrt {
namespace {

/// For how long a device may send bytes that are no answer: so many time limits, and no less than
/// what any host may be busy with other things for. Late, doubled and damaged answers come sooner.
constexpr int kNoiseLimits = 8;
constexpr std::chrono::seconds kLeastNoise(10);

/// For how long a device is believed that it still works at one answer.
constexpr std::chrono::hours kLongestWork(1);

/// A device at work says so now and then.
bool is_sign_of_work(const Frame& frame) {
  return frame.type() == protocol::FrameType::kNoOp && frame.header.sequence == 0;
}

}  // namespace

Connection::Connection(std::unique_ptr<Transport> transport, std::chrono::milliseconds timeout)
    : transport_(std::move(transport)), timeout_(timeout) {
  progress();
}

void Connection::progress() {
  last_progress_ = last_sign_ = transport_->now();
  noisy_ = false;
}

Result<void> Connection::send(std::span<const std::byte> frames) {
  bytes_out_ += frames.size();
  return transport_->send(frames);
}

Result<void> Connection::send(protocol::FrameType type, std::uint32_t sequence,
                              std::span<const std::byte> payload) {
  std::vector<std::byte> bytes;
  if (auto built = append_frame(bytes, type, protocol::Layout::kNone, sequence, payload); !built) {
    return built;
  }
  return send(bytes);
}

Result<std::optional<Frame>> Connection::receive(std::chrono::milliseconds timeout) {
  constexpr std::size_t kRead = std::size_t{1} << 18;
  for (;;) {
    while (const std::optional<FrameEvent> event = reader_.next()) {
      const auto* frame = std::get_if<Frame>(&*event);
      if (frame == nullptr) continue;
      if (is_sign_of_work(*frame) && transport_->now() - last_progress_ < kLongestWork) {
        last_sign_ = transport_->now();
      }
      return *frame;
    }
    const auto patience = std::max<std::chrono::milliseconds>(kNoiseLimits * timeout, kLeastNoise);
    if (noisy_ && transport_->now() - last_sign_ > patience) {
      return fail(ErrorKind::kTimeout,
                  fmt::format("the device keeps sending, but no answer for {} ms",
                              (transport_->now() - last_progress_).count()),
                  "check the device and its cable");
    }
    const Result<std::size_t> got = transport_->receive(reader_.space(kRead), timeout);
    if (!got) return std::unexpected(got.error());
    reader_.filled(*got);
    bytes_in_ += *got;
    if (*got == 0) {
      // A frame that stopped half-way must not swallow the next one.
      reader_.resynchronise();
      last_sign_ = transport_->now();
      noisy_ = false;
      return std::nullopt;
    }
    noisy_ = true;
  }
}

}  // namespace gridrt
