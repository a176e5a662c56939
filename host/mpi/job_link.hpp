// What travels over the socket between a program and rank 0 of the job that it has started: the
// bytes of frames, and reports.
#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <span>
#include <string>
#include <vector>

#include "hal/error.hpp"

namespace gridrt {

enum class LinkKind : std::uint32_t {
  kBytes,       ///< either way: what a Transport carries
  kGetFeature,  ///< to rank 0: number is the report's id, 4 bytes say how long its body is
  kSetFeature,  ///< to rank 0: number is the report's id
  kFeature,     ///< reply: the body
  kRefused,     ///< reply: number is an ErrorKind, the content message NUL advice
  kFailed,      ///< from rank 0: the device has failed; as kRefused
};

struct LinkMessage {
  LinkKind kind = LinkKind::kBytes;
  std::uint32_t number = 0;
  std::vector<std::byte> content;
};

/// One end of the socket, which it owns.
class JobLink {
 public:
  /// `descriptor` < 0: closed.
  explicit JobLink(int descriptor = -1);
  ~JobLink();
  JobLink(JobLink&& other) noexcept;
  JobLink& operator=(JobLink&& other) noexcept;
  JobLink(const JobLink&) = delete;
  JobLink& operator=(const JobLink&) = delete;

  /// Sends all of it; takes in what comes meanwhile. Errors: kTransport if the other end is gone.
  Result<void> send(LinkKind kind, std::uint32_t number, std::span<const std::byte> content);

  /// The next message that has come, waiting for it no longer than the timeout; kind kBytes without
  /// content: none. Errors: kTransport if the other end is gone.
  Result<LinkMessage> receive(std::chrono::milliseconds timeout);

  void close();

 private:
  Result<void> read_some();
  bool next(LinkMessage& message);

  int descriptor_;
  std::vector<std::byte> buffer_;  ///< bytes that have come
  std::size_t begin_ = 0;          ///< of what has not been handed out
};

/// An Error as content of kRefused and kFailed, and back.
std::vector<std::byte> pack_error(const Error& error);
Error unpack_error(const LinkMessage& message);

}  // namespace gridrt
