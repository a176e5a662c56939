// A board behind USB/IP: what Linux's `usbip attach` and Windows' clients of the same name take.
#pragma once

#include <chrono>
#include <cstddef>
#include <deque>
#include <span>
#include <vector>

#include "hal/error.hpp"
#include "tools/virtual/usb_function.hpp"
#include "tools/virtual/usbip_messages.hpp"

namespace gridrt {

/// One connection. Used by one thread.
class UsbIp {
 public:
  /// `function` must outlive it; `socket` is a connected stream, not blocking, that it does not
  /// own.
  UsbIp(UsbFunction& function, int socket) : function_(function), socket_(socket) {}

  /// Moves what can be moved, waits for up to `patience` if that is nothing. False: the other side
  /// has gone, or has said what makes no sense. Errors: kTransport (the socket), kDevice (the
  /// device has gone).
  Result<bool> step(std::chrono::milliseconds patience);

 private:
  bool take_message();
  bool take_operation();
  bool take_urb();
  void submit(const usbip::Urb& urb, std::span<const std::byte> data);
  void answer(const usbip::Urb& urb, TransferState state, std::span<const std::byte> data,
              std::size_t moved);
  bool serve_waiting();
  bool serve_one(const usbip::Urb& urb);
  Result<bool> move_bytes(std::chrono::milliseconds patience);
  void send(std::span<const std::byte> bytes) {
    out_.insert(out_.end(), bytes.begin(), bytes.end());
  }

  UsbFunction& function_;
  int socket_;
  bool imported_ = false;
  bool bad_ = false;
  bool gone_ = false;
  std::vector<std::byte> in_;
  std::size_t taken_ = 0;  // of in_
  std::vector<std::byte> out_;
  std::size_t sent_ = 0;  // of out_
  std::deque<usbip::Urb> waiting_;
  std::vector<std::byte> room_;
};

}  // namespace gridrt
