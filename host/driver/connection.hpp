// Frames over a transport: numbered, counted, read back one at a time.
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "hal/error.hpp"
#include "hal/frame.hpp"
#include "hal/transport.hpp"

namespace gridrt {

/// Used by one thread at a time.
class Connection {
 public:
  Connection(std::unique_ptr<Transport> transport, std::chrono::milliseconds timeout);

  [[nodiscard]] Transport& transport() { return *transport_; }

  /// A sequence number that no frame of this connection has had (wraps after 2^32).
  std::uint32_t next_sequence() { return sequence_++; }

  /// Starts counting at `sequence`; for tests of the roll-over.
  void set_next_sequence(std::uint32_t sequence) { sequence_ = sequence; }

  /// Sends bytes of one or more whole frames.
  Result<void> send(std::span<const std::byte> frames);

  /// Builds and sends a frame.
  Result<void> send(protocol::FrameType type, std::uint32_t sequence,
                    std::span<const std::byte> payload);

  /// The next good frame, or nothing when the device has been silent for the time limit. Faulty
  /// frames are skipped: what they carried comes again when it is asked for again. The payload is
  /// valid until the next call. Errors: the link's, and kTimeout for a device that sends and sends,
  /// but nothing that its caller calls progress().
  Result<std::optional<Frame>> receive() { return receive(timeout_); }

  /// The same with another time limit.
  Result<std::optional<Frame>> receive(std::chrono::milliseconds timeout);

  /// What is waited for has come, or begins to be waited for.
  void progress();

  /// Counts bytes from here on.
  void forget_counts() { bytes_out_ = bytes_in_ = 0; }

  [[nodiscard]] std::uint64_t bytes_out() const { return bytes_out_; }
  [[nodiscard]] std::uint64_t bytes_in() const { return bytes_in_; }

 private:
  std::unique_ptr<Transport> transport_;
  std::chrono::milliseconds timeout_;
  FrameReader reader_;
  std::chrono::milliseconds last_progress_{0};
  std::chrono::milliseconds last_sign_{0};  // progress, silence, or word that work goes on
  bool noisy_ = false;                      // bytes have come since
  std::uint32_t sequence_ = 1;
  std::uint64_t bytes_out_ = 0;
  std::uint64_t bytes_in_ = 0;
};

}  // namespace gridrt
