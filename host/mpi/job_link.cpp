#include "host/mpi/job_link.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <utility>

#include <fcntl.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

namespace gridrt {
namespace {

struct LinkHead {
  std::uint32_t kind = 0;
  std::uint32_t number = 0;
  std::uint64_t bytes = 0;
};

constexpr std::size_t kReadBytes = std::size_t{1} << 18U;

std::unexpected<Error> gone() { return fail(ErrorKind::kTransport, "the other end is gone"); }

}  // namespace

JobLink::JobLink(int descriptor) : descriptor_(descriptor) {
  if (descriptor_ >= 0) fcntl(descriptor_, F_SETFL, fcntl(descriptor_, F_GETFL) | O_NONBLOCK);
}

JobLink::~JobLink() { close(); }

JobLink::JobLink(JobLink&& other) noexcept
    : descriptor_(std::exchange(other.descriptor_, -1)),
      buffer_(std::move(other.buffer_)),
      begin_(std::exchange(other.begin_, 0)) {}

JobLink& JobLink::operator=(JobLink&& other) noexcept {
  if (this == &other) return *this;
  close();
  descriptor_ = std::exchange(other.descriptor_, -1);
  buffer_ = std::move(other.buffer_);
  begin_ = std::exchange(other.begin_, 0);
  return *this;
}

void JobLink::close() {
  if (descriptor_ >= 0) ::close(descriptor_);
  descriptor_ = -1;
}

Result<void> JobLink::send(LinkKind kind, std::uint32_t number,
                           std::span<const std::byte> content) {
  const LinkHead head{static_cast<std::uint32_t>(kind), number, content.size()};
  std::array<std::span<const std::byte>, 2> parts{std::as_bytes(std::span(&head, 1)), content};
  for (std::span<const std::byte>& part : parts) {
    while (!part.empty()) {
      const ssize_t sent = ::send(descriptor_, part.data(), part.size(), MSG_NOSIGNAL);
      if (sent > 0) {
        part = part.subspan(static_cast<std::size_t>(sent));
        continue;
      }
      if (sent < 0 && errno != EAGAIN && errno != EINTR) return gone();
      // Full: the other end may be waiting for us to read.
      pollfd wanted{descriptor_, POLLIN | POLLOUT, 0};
      poll(&wanted, 1, -1);
      if ((wanted.revents & POLLIN) != 0) {
        if (auto done = read_some(); !done) return done;
      }
    }
  }
  return {};
}

Result<LinkMessage> JobLink::receive(std::chrono::milliseconds timeout) {
  const auto end = std::chrono::steady_clock::now() + timeout;
  LinkMessage message;
  while (!next(message)) {
    const auto left =
        std::chrono::ceil<std::chrono::milliseconds>(end - std::chrono::steady_clock::now());
    pollfd wanted{descriptor_, POLLIN, 0};
    const int ready = poll(&wanted, 1, std::max(0, static_cast<int>(left.count())));
    if (ready > 0) {
      if (auto done = read_some(); !done) return std::unexpected(std::move(done.error()));
    } else if (left.count() <= 0) {
      return LinkMessage{};
    }
  }
  return message;
}

Result<void> JobLink::read_some() {
  if (begin_ == buffer_.size()) {
    buffer_.clear();
    begin_ = 0;
  }
  const std::size_t size = buffer_.size();
  buffer_.resize(size + kReadBytes);
  const ssize_t got = ::recv(descriptor_, buffer_.data() + size, kReadBytes, 0);
  const int error = errno;
  buffer_.resize(size + static_cast<std::size_t>(std::max<ssize_t>(got, 0)));
  if (got > 0 || (got < 0 && (error == EAGAIN || error == EINTR))) return {};
  return gone();
}

/// Hands out the first message if it is whole.
bool JobLink::next(LinkMessage& message) {
  const std::span<const std::byte> there = std::span(buffer_).subspan(begin_);
  LinkHead head;
  if (there.size() < sizeof(head)) return false;
  std::memcpy(&head, there.data(), sizeof(head));
  if (there.size() - sizeof(head) < head.bytes) return false;
  const auto content = there.subspan(sizeof(head), head.bytes);
  message.kind = static_cast<LinkKind>(head.kind);
  message.number = head.number;
  message.content.assign(content.begin(), content.end());
  begin_ += sizeof(head) + head.bytes;
  return true;
}

std::vector<std::byte> pack_error(const Error& error) {
  const std::string text = error.message + '\0' + error.advice;
  const auto raw = std::as_bytes(std::span(text));
  return {raw.begin(), raw.end()};
}

Error unpack_error(const LinkMessage& message) {
  std::string text(message.content.size(), ' ');
  std::memcpy(text.data(), message.content.data(), text.size());
  const std::size_t cut = std::min(text.find('\0'), text.size());
  return {static_cast<ErrorKind>(message.number), text.substr(0, cut),
          text.substr(std::min(cut + 1, text.size()))};
}

}  // namespace gridrt
