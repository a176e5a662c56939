// A board behind the USB redirection protocol (usbredir 0.7): what QEMU's usb-redir and SPICE
// clients connect to.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <span>
#include <vector>

#include "hal/error.hpp"
#include "tools/virtual/usb_function.hpp"

struct usbredirparser;

namespace gridrt {

/// One connection. Used by one thread.
class Redirection {
 public:
  /// `function` must outlive it; `socket` is a connected stream, not blocking, that it does not
  /// own.
  Redirection(UsbFunction& function, int socket);
  ~Redirection();
  Redirection(const Redirection&) = delete;
  Redirection& operator=(const Redirection&) = delete;

  /// Moves what can be moved, waits for up to `patience` if that is nothing. False: the other side
  /// has gone. Errors: kTransport (the socket), kDevice (the device has gone; the other side has
  /// been told).
  Result<bool> step(std::chrono::milliseconds patience);

  /// Tells the other side that the board has been unplugged, or is there again.
  void unplug();
  void plug_in();

 private:
  struct Wanted {  ///< a bulk IN transfer that has no bytes yet
    std::uint64_t id = 0;
    std::size_t bytes = 0;
  };
  struct Calls;  // what the parser calls
  struct Free {
    void operator()(usbredirparser* parser) const;
  };

  void connect();
  void describe();
  void answer_bulk(std::uint64_t id, TransferState state, std::span<std::byte> data,
                   std::uint8_t endpoint, std::size_t length);
  bool serve_bulk(std::chrono::milliseconds patience);
  bool serve_interrupts();

  UsbFunction& function_;
  int socket_;
  std::unique_ptr<usbredirparser, Free> parser_;
  std::deque<Wanted> wanted_;
  std::vector<std::byte> room_;
  std::chrono::steady_clock::time_point next_interrupt_;
  bool greeted_ = false;
  bool connected_ = false;
  bool interrupts_ = false;  // the other side wants input reports
  bool closed_ = false;
  bool gone_ = false;
};

}  // namespace gridrt
