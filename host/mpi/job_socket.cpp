#include "host/mpi/job_socket.hpp"

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <cstring>
#include <utility>

#include <fmt/format.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

namespace gridrt {
namespace {

/// An abstract address: a NUL and the name, no file.
struct Address {
  explicit Address(const std::string& name) {
    value.sun_family = AF_UNIX;
    const std::size_t length = std::min(name.size(), sizeof(value.sun_path) - 1);
    std::memcpy(value.sun_path + 1, name.data(), length);
    size = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + 1 + length);
  }
  [[nodiscard]] const sockaddr* raw() const { return reinterpret_cast<const sockaddr*>(&value); }
  sockaddr_un value{};
  socklen_t size = 0;
};

std::unexpected<Error> failure(const char* what) {
  return fail(ErrorKind::kTransport,
              fmt::format("device 'mpi': cannot {} a socket: {}", what, strerror(errno)));
}

}  // namespace

Result<JobSocket> JobSocket::listen(const std::string& name) {
  JobSocket made(socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0));
  const Address address(name);
  if (made.descriptor_ < 0) return failure("make");
  if (bind(made.descriptor_, address.raw(), address.size) != 0) return failure("name");
  if (::listen(made.descriptor_, 1) != 0) return failure("listen on");
  return made;
}

int JobSocket::accept(std::chrono::milliseconds timeout) {
  pollfd wanted{descriptor_, POLLIN, 0};
  if (poll(&wanted, 1, static_cast<int>(timeout.count())) <= 0) return -1;
  const int peer = accept4(descriptor_, nullptr, nullptr, SOCK_CLOEXEC);
  ucred who{};
  socklen_t size = sizeof(who);
  if (peer >= 0 &&
      (getsockopt(peer, SOL_SOCKET, SO_PEERCRED, &who, &size) != 0 || who.uid != geteuid())) {
    close(peer);
    return -1;
  }
  return peer;
}

JobSocket::~JobSocket() {
  if (descriptor_ >= 0) close(descriptor_);
}

JobSocket::JobSocket(JobSocket&& other) noexcept
    : descriptor_(std::exchange(other.descriptor_, -1)) {}

Result<int> connect_job_socket(const std::string& name) {
  const int made = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
  if (made < 0) return failure("make");
  const Address address(name);
  if (connect(made, address.raw(), address.size) != 0) {
    auto failed = failure("connect");
    close(made);
    return failed;
  }
  return made;
}

}  // namespace gridrt
