#include "host/driver/connection.hpp"

#include <utility>
#include <variant>

namespace gridrt {

Connection::Connection(std::unique_ptr<Transport> transport, std::chrono::milliseconds timeout)
    : transport_(std::move(transport)), timeout_(timeout) {}

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
      if (const auto* frame = std::get_if<Frame>(&*event)) return *frame;
    }
    const Result<std::size_t> got = transport_->receive(reader_.space(kRead), timeout);
    if (!got) return std::unexpected(got.error());
    reader_.filled(*got);
    bytes_in_ += *got;
    if (*got == 0) {
      // A frame that stopped half-way must not swallow the next one.
      reader_.resynchronise();
      return std::nullopt;
    }
  }
}

}  // namespace gridrt
