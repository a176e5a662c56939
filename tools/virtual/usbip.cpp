#include "tools/virtual/usbip.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>

#include <poll.h>
#include <sys/socket.h>

#include "gridrt_usb.hpp"

namespace gridrt {
namespace {

using std::chrono::milliseconds;
using usbip::Urb;

constexpr std::size_t kRead = std::size_t{1} << 18U;

}  // namespace

/// False: more bytes are needed.
bool UsbIp::take_message() {
  const bool moved = imported_ ? take_urb() : take_operation();
  if (taken_ == in_.size()) {
    in_.clear();
    taken_ = 0;
  } else if (taken_ > in_.size() / 2) {
    in_.erase(in_.begin(), in_.begin() + static_cast<std::ptrdiff_t>(taken_));
    taken_ = 0;
  }
  return moved;
}

bool UsbIp::take_operation() {
  const auto bytes = std::span<const std::byte>(in_).subspan(taken_);
  if (bytes.size() < usbip::kOperationBytes) return false;
  const auto operation = usbip::read_operation(bytes.first<usbip::kOperationBytes>());
  bad_ = !operation;
  if (bad_) return false;
  const usbip::DeviceText device{.high_speed = function_.is_high_speed(),
                                 .configured = function_.is_configured()};
  if (*operation == usbip::Operation::kListDevices) {
    send(usbip::device_list(device));
    taken_ += usbip::kOperationBytes;
    return true;
  }
  constexpr std::size_t kBytes = usbip::kOperationBytes + usbip::kBusIdBytes;
  if (bytes.size() < kBytes) return false;
  const auto bus_id = bytes.subspan<usbip::kOperationBytes, usbip::kBusIdBytes>();
  send(usbip::import_answer(device, bus_id, imported_));
  if (imported_) function_.reset();
  taken_ += kBytes;
  return true;
}

bool UsbIp::take_urb() {
  const auto bytes = std::span<const std::byte>(in_).subspan(taken_);
  if (bytes.size() < usbip::kUrbBytes) return false;
  const auto urb = usbip::read_urb(bytes.first<usbip::kUrbBytes>());
  bad_ = !urb;
  if (bad_) return false;
  if (urb->kind == Urb::Kind::kUnlink) {
    const bool was_waiting =
        std::erase_if(waiting_, [&](const Urb& w) { return w.sequence == urb->length; }) > 0;
    send(usbip::unlink_answer(*urb, was_waiting));
    taken_ += usbip::kUrbBytes;
    return true;
  }
  const std::size_t data = urb->in ? 0 : urb->length;
  if (bytes.size() < usbip::kUrbBytes + data) return false;
  submit(*urb, bytes.subspan(usbip::kUrbBytes, data));
  taken_ += usbip::kUrbBytes + data;
  return true;
}

void UsbIp::submit(const Urb& urb, std::span<const std::byte> data) {
  switch (urb.address()) {
    case 0x00:
    case 0x80: {
      const ControlAnswer done = function_.control(urb.setup, data);
      if (!done) return answer(urb, TransferState::kStalled, {}, 0);
      const std::size_t size = urb.in ? std::min<std::size_t>(done->size(), urb.length) : 0;
      return answer(urb, TransferState::kDone, std::span(*done).first(size),
                    urb.in ? size : data.size());
    }
    case usb::kBulkOut:
      return answer(urb, function_.bulk_out(data), {}, data.size());
    case usb::kInterruptOut:
      return answer(urb, function_.interrupt_out(data), {}, data.size());
    case usb::kBulkIn:
    case usb::kInterruptIn:
      waiting_.push_back(urb);
      return;
    default:
      return answer(urb, TransferState::kStalled, {}, 0);
  }
}

void UsbIp::answer(const Urb& urb, TransferState state, std::span<const std::byte> data,
                   std::size_t moved) {
  gone_ = gone_ || state == TransferState::kGone;
  send(usbip::submit_answer(urb, state, state == TransferState::kDone ? moved : 0));
  send(data);
}

/// Answers a transfer to the host, if there is something to say.
bool UsbIp::serve_one(const Urb& urb) {
  room_.resize(std::max<std::size_t>(room_.size(), urb.length));
  const auto room = std::span(room_).first(urb.length);
  std::size_t given = 0;
  const TransferState state = urb.address() == usb::kBulkIn
                                  ? function_.bulk_in(room, given, milliseconds(0))
                                  : function_.interrupt_in(room, given);
  if (state == TransferState::kWaiting) return false;
  answer(urb, state, room.first(given), given);
  return true;
}

bool UsbIp::serve_waiting() {
  bool moved = false;
  // In order on each endpoint.
  for (const std::uint16_t address : {usb::kBulkIn, usb::kInterruptIn}) {
    for (auto urb = waiting_.begin(); urb != waiting_.end();) {
      if (urb->address() != address) {
        ++urb;
        continue;
      }
      if (!serve_one(*urb)) break;
      urb = waiting_.erase(urb);
      moved = true;
    }
  }
  return moved;
}

Result<bool> UsbIp::move_bytes(milliseconds patience) {
  pollfd watched{socket_, POLLIN, 0};
  if (sent_ < out_.size()) watched.events |= POLLOUT;
  if (poll(&watched, 1, static_cast<int>(patience.count())) < 0 && errno != EINTR) {
    return fail(ErrorKind::kTransport, std::string("poll: ") + std::strerror(errno));
  }
  if ((watched.revents & POLLOUT) != 0) {
    const ssize_t put = ::send(socket_, out_.data() + sent_, out_.size() - sent_, MSG_NOSIGNAL);
    if (put < 0 && errno != EAGAIN && errno != EINTR) return false;
    sent_ += static_cast<std::size_t>(std::max<ssize_t>(put, 0));
    if (sent_ == out_.size()) {
      out_.clear();
      sent_ = 0;
    }
  }
  if ((watched.revents & (POLLIN | POLLHUP | POLLERR)) != 0) {
    const std::size_t before = in_.size();
    in_.resize(before + kRead);
    const ssize_t got = recv(socket_, in_.data() + before, kRead, 0);
    in_.resize(before + static_cast<std::size_t>(std::max<ssize_t>(got, 0)));
    if (got == 0 || (got < 0 && errno != EAGAIN && errno != EINTR)) return false;
  }
  return true;
}

Result<bool> UsbIp::step(milliseconds patience) {
  while (take_message()) {
  }
  const bool moved = serve_waiting();
  if (gone_) return fail(ErrorKind::kDevice, "the device behind the virtual board has failed");
  if (bad_) return false;
  // With work under way an answer may come from the device, not from the socket.
  milliseconds longest = waiting_.empty() ? patience : std::min(patience, milliseconds(1));
  if (moved) longest = milliseconds(0);
  return move_bytes(longest);
}

}  // namespace gridrt
