#include "hal/frame.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <string>

#include "hal/crc32c.hpp"

namespace gridrt {
namespace {

using protocol::FrameHeader;

constexpr std::size_t kCrcOffset = FrameHeader::kBytes - 4;  // header_crc covers what is before
constexpr std::size_t kMinimumBuffer = 4096;

constexpr std::array<std::byte, 4> kMagicBytes = [] {
  std::array<std::byte, 4> bytes{};
  protocol::detail::put32(bytes.data(), protocol::kFrameMagic);
  return bytes;
}();

}  // namespace

FrameBuilder::FrameBuilder(std::vector<std::byte>& out, protocol::FrameType type,
                           protocol::Layout layout, std::uint32_t sequence)
    : out_(out), start_(out.size()) {
  header_.magic = protocol::kFrameMagic;
  header_.version = static_cast<std::uint8_t>(protocol::kVersion);
  header_.type = static_cast<std::uint8_t>(type);
  header_.layout = static_cast<std::uint8_t>(layout);
  header_.sequence = sequence;
  out_.resize(start_ + FrameHeader::kBytes);
}

std::span<std::byte> FrameBuilder::extend(std::size_t bytes) {
  out_.resize(out_.size() + bytes);
  return std::span(out_).last(bytes);
}

void FrameBuilder::append(std::span<const std::byte> bytes) {
  out_.insert(out_.end(), bytes.begin(), bytes.end());
}

std::size_t FrameBuilder::payload_bytes() const {
  return out_.size() - start_ - FrameHeader::kBytes;
}

Result<void> FrameBuilder::finish() {
  const std::size_t length = (payload_bytes() + 3) / 4 * 4;
  if (length > protocol::kMaxPayload) {
    out_.resize(start_);
    return fail(ErrorKind::kLimit,
                "a frame's payload of " + std::to_string(length) + " bytes exceeds " +
                    std::to_string(protocol::kMaxPayload),
                "send it in several frames");
  }
  out_.resize(start_ + FrameHeader::kBytes + length + 4);
  header_.length = static_cast<std::uint32_t>(length);
  const std::span<std::byte> frame = std::span(out_).subspan(start_);
  store(header_, frame.first<FrameHeader::kBytes>());
  protocol::detail::put32(frame.data() + kCrcOffset, crc32c(frame.first(kCrcOffset)));
  const std::span<std::byte> payload = frame.subspan(FrameHeader::kBytes, length);
  protocol::detail::put32(payload.data() + length, crc32c(payload));
  return {};
}

Result<void> append_frame(std::vector<std::byte>& out, protocol::FrameType type,
                          protocol::Layout layout, std::uint32_t sequence,
                          std::span<const std::byte> payload) {
  FrameBuilder builder(out, type, layout, sequence);
  builder.append(payload);
  return builder.finish();
}

FrameReader::FrameReader(std::uint32_t max_payload) : max_payload_(max_payload) {}

std::span<const std::byte> FrameReader::pending() const {
  return std::span(buffer_).subspan(begin_, end_ - begin_);
}

std::span<std::byte> FrameReader::space(std::size_t bytes) {
  if (begin_ == end_) {
    begin_ = end_ = 0;
  }
  if (buffer_.size() - end_ < bytes && begin_ > 0) {
    std::memmove(buffer_.data(), buffer_.data() + begin_, end_ - begin_);
    end_ -= begin_;
    begin_ = 0;
  }
  if (buffer_.size() - end_ < bytes) {
    buffer_.resize(std::max({kMinimumBuffer, end_ + bytes, end_ + end_ / 2}));
  }
  return std::span(buffer_).subspan(end_, bytes);
}

void FrameReader::filled(std::size_t bytes) { end_ += std::min(bytes, buffer_.size() - end_); }

void FrameReader::push(std::span<const std::byte> bytes) {
  if (bytes.empty()) {
    return;
  }
  std::ranges::copy(bytes, space(bytes.size()).begin());
  filled(bytes.size());
}

void FrameReader::skip(std::size_t bytes) {
  begin_ += bytes;
  garbage_bytes_ += bytes;
}

std::optional<protocol::FrameHeader> FrameReader::find_header() {
  while (true) {
    // Skip to the next place where the magic, or as much of it as has come, stands.
    const std::span<const std::byte> bytes = pending();
    std::size_t at = 0;
    while (at < bytes.size()) {
      const auto found = std::ranges::find(bytes.subspan(at), kMagicBytes[0]);
      at = static_cast<std::size_t>(found - bytes.begin());
      const std::size_t seen = std::min(kMagicBytes.size(), bytes.size() - at);
      if (std::ranges::equal(bytes.subspan(at, seen), std::span(kMagicBytes).first(seen))) {
        break;
      }
      ++at;
    }
    skip(at);
    if (pending().size() < FrameHeader::kBytes) {
      return std::nullopt;
    }
    const std::span<const std::byte> raw = pending().first(FrameHeader::kBytes);
    const FrameHeader header = protocol::load_frame_header(raw.first<FrameHeader::kBytes>());
    if (header.header_crc == crc32c(raw.first(kCrcOffset)) && header.flags == 0 &&
        header.length % 4 == 0 && header.length <= max_payload_) {
      return header;
    }
    ++bad_frames_;
    skip(1);
  }
}

std::optional<FrameEvent> FrameReader::next() {
  if (!header_) {
    header_ = find_header();
  }
  if (!header_) {
    return std::nullopt;
  }
  const FrameHeader header = *header_;
  const auto fault = [&](protocol::ErrorCode code, std::uint32_t detail) {
    ++bad_frames_;
    skip(FrameHeader::kBytes);
    header_.reset();
    return FrameFault{header, code, detail};
  };
  if (header.version != protocol::kVersion) {
    return fault(protocol::ErrorCode::kBadVersion, protocol::kVersion);
  }
  const std::size_t size = kFrameOverhead + header.length;
  if (pending().size() < size) {
    return std::nullopt;
  }
  const std::span<const std::byte> bytes = pending().first(size);
  const std::span<const std::byte> payload = bytes.subspan(FrameHeader::kBytes, header.length);
  if (protocol::detail::get32(payload.data() + payload.size()) != crc32c(payload)) {
    return fault(protocol::ErrorCode::kBadPayloadCrc, 0);
  }
  begin_ += size;
  header_.reset();
  return Frame{header, payload, bytes};
}

void FrameReader::resynchronise() {
  if (header_) {
    ++bad_frames_;
    skip(FrameHeader::kBytes);
    header_.reset();
  }
}

void FrameReader::clear() {
  garbage_bytes_ += buffered();
  begin_ = end_ = 0;
  header_.reset();
}

}  // namespace gridrt
