#include "tools/virtual/listen.hpp"

#include <cerrno>
#include <charconv>
#include <cstdint>
#include <cstring>

#include <arpa/inet.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

namespace gridrt {
namespace {

constexpr int kFlags = SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC;

std::unexpected<Error> refused(const std::string& place) {
  return fail(ErrorKind::kFile, place + ": cannot listen there: " + std::strerror(errno),
              "give a path for a new socket, or a free port");
}

Result<Socket> listen_on_port(const std::string& place, std::uint16_t port) {
  Socket socket(::socket(AF_INET, kFlags, 0));
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(port);
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  const int on = 1;
  if (!socket.is_open() ||
      setsockopt(socket.file(), SOL_SOCKET, SO_REUSEADDR, &on, sizeof on) != 0 ||
      bind(socket.file(), reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0 ||
      listen(socket.file(), 1) != 0) {
    return refused(place);
  }
  return socket;
}

Result<Socket> listen_on_path(const std::string& place) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (place.empty() || place.size() >= sizeof address.sun_path) {
    errno = ENAMETOOLONG;
    return refused(place);
  }
  place.copy(address.sun_path, place.size());
  unlink(place.c_str());
  Socket socket(::socket(AF_UNIX, kFlags, 0));
  if (!socket.is_open() ||
      bind(socket.file(), reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0 ||
      listen(socket.file(), 1) != 0) {
    return refused(place);
  }
  return socket;
}

}  // namespace

Socket::~Socket() {
  if (file_ >= 0) close(file_);
}

Result<Socket> listen_at(const std::string& place) {
  std::uint16_t port = 0;
  const auto [end, error] = std::from_chars(place.data(), place.data() + place.size(), port);
  const bool number = error == std::errc{} && end == place.data() + place.size();
  return number ? listen_on_port(place, port) : listen_on_path(place);
}

Result<Socket> accept_one(const Socket& listening, std::chrono::milliseconds timeout) {
  pollfd watched{listening.file(), POLLIN, 0};
  if (poll(&watched, 1, static_cast<int>(timeout.count())) <= 0) return Socket();
  const int file = accept4(listening.file(), nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC);
  if (file < 0) {
    if (errno == EAGAIN || errno == EINTR || errno == ECONNABORTED) return Socket();
    return fail(ErrorKind::kFile,
                std::string("a connection was not accepted: ") + std::strerror(errno));
  }
  const int on = 1;
  setsockopt(file, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);  // no such thing on a Unix socket
  return Socket(file);
}

}  // namespace gridrt
