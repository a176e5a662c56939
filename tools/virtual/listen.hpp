// Sockets that a virtual board is reached through.
#pragma once

#include <chrono>
#include <string>
#include <utility>

#include "hal/error.hpp"

namespace gridrt {

/// A file descriptor with an owner.
class Socket {
 public:
  Socket() = default;
  explicit Socket(int file) : file_(file) {}
  Socket(Socket&& other) noexcept : file_(std::exchange(other.file_, -1)) {}
  Socket& operator=(Socket&& other) noexcept {
    std::swap(file_, other.file_);
    return *this;
  }
  ~Socket();

  [[nodiscard]] int file() const { return file_; }
  [[nodiscard]] bool is_open() const { return file_ >= 0; }

 private:
  int file_ = -1;
};

/// Listens on a path (a Unix socket; an old one of that name is removed) or, if `place` is a
/// number, on that TCP port of this machine only. Errors: kFile.
Result<Socket> listen_at(const std::string& place);

/// The next connection, not blocking, or a closed socket after the timeout. Errors: kFile.
Result<Socket> accept_one(const Socket& listening, std::chrono::milliseconds timeout);

}  // namespace gridrt
