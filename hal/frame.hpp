// Frames on a byte stream: building them, and finding them again after garbage.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <variant>
#include <vector>

#include "gridrt_protocol.hpp"
#include "hal/error.hpp"

namespace gridrt {

/// Bytes that a frame takes besides its payload: header and payload CRC.
inline constexpr std::size_t kFrameOverhead = protocol::FrameHeader::kBytes + 4;

/// Builds one frame at the end of a byte vector, its payload in place. Nothing else may touch the
/// vector until finish().
class FrameBuilder {
 public:
  FrameBuilder(std::vector<std::byte>& out, protocol::FrameType type, protocol::Layout layout,
               std::uint32_t sequence);

  /// Appends `bytes` zero bytes to the payload; the span is valid until the next call.
  std::span<std::byte> extend(std::size_t bytes);

  /// Appends bytes to the payload.
  void append(std::span<const std::byte> bytes);

  /// Bytes of payload so far.
  [[nodiscard]] std::size_t payload_bytes() const;

  /// Pads the payload with zeros to a multiple of 4, adds its CRC and writes the header. Errors:
  /// kLimit for a payload above protocol::kMaxPayload (the vector is as before the frame).
  [[nodiscard]] Result<void> finish();

 private:
  std::vector<std::byte>& out_;
  std::size_t start_;
  protocol::FrameHeader header_;
};

/// Appends a whole frame; the payload is padded with zeros to a multiple of 4. Errors: kLimit as
/// FrameBuilder::finish().
[[nodiscard]] Result<void> append_frame(std::vector<std::byte>& out, protocol::FrameType type,
                                        protocol::Layout layout, std::uint32_t sequence,
                                        std::span<const std::byte> payload);

/// A good frame: header and payload CRC match.
struct Frame {
  protocol::FrameHeader header;
  std::span<const std::byte> payload;  ///< valid until the reader's next push() or space()
  std::span<const std::byte> bytes;    ///< the whole frame, header to CRC; as valid

  [[nodiscard]] protocol::FrameType type() const {
    return static_cast<protocol::FrameType>(header.type);
  }
  [[nodiscard]] protocol::Layout layout() const {
    return static_cast<protocol::Layout>(header.layout);
  }
};

/// A frame with a good header that cannot be used: kBadPayloadCrc or kBadVersion.
struct FrameFault {
  protocol::FrameHeader header;
  protocol::ErrorCode code = protocol::ErrorCode::kNone;
  std::uint32_t detail = 0;  ///< as the code says
};

using FrameEvent = std::variant<Frame, FrameFault>;

/// Finds frames in a stream of bytes that may be cut anywhere and hold garbage. A frame starts
/// where magic, header CRC, flags and length (a multiple of 4, at most max_payload) are right;
/// other bytes are skipped and counted. After a fault the search goes on behind the header, so
/// that a good frame behind a shortened one is found. Memory: one largest frame, and what was
/// pushed since next() last returned nothing.
class FrameReader {
 public:
  explicit FrameReader(std::uint32_t max_payload = protocol::kMaxPayload);

  /// Takes bytes in (copies them).
  void push(std::span<const std::byte> bytes);

  /// Room for `bytes` bytes at the end, to be filled by the caller without a copy; filled() then
  /// says how many came.
  std::span<std::byte> space(std::size_t bytes);
  void filled(std::size_t bytes);

  /// The next frame or fault in order, or nothing until more bytes come.
  std::optional<FrameEvent> next();

  /// Gives up the unfinished frame at hand (its sender has stopped within it): the search goes on
  /// behind its header.
  void resynchronise();

  /// Forgets all bytes; counters stay.
  void clear();

  [[nodiscard]] std::uint64_t garbage_bytes() const { return garbage_bytes_; }
  /// Headers that were refused and frames that were faulty.
  [[nodiscard]] std::uint64_t bad_frames() const { return bad_frames_; }
  /// Bytes waiting for the rest of their frame.
  [[nodiscard]] std::size_t buffered() const { return end_ - begin_; }

 private:
  [[nodiscard]] std::span<const std::byte> pending() const;
  std::optional<protocol::FrameHeader> find_header();
  void skip(std::size_t bytes);

  std::uint32_t max_payload_;
  std::vector<std::byte> buffer_;
  std::size_t begin_ = 0;                        // first byte not consumed
  std::size_t end_ = 0;                          // behind the last byte received
  std::optional<protocol::FrameHeader> header_;  // good header at begin_
  std::uint64_t garbage_bytes_ = 0;
  std::uint64_t bad_frames_ = 0;
};

}  // namespace gridrt
