// The two byte streams over bulk pipes: many libusb transfers in flight in each direction. For the
// files of this folder only.
#pragma once

#include <chrono>
#include <cstddef>
#include <deque>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "hal/error.hpp"
#include "hal/usb/libusb.hpp"
#include "hal/usb/usb.hpp"

namespace gridrt {

/// Memory of a transfer: the kernel's own where it grants that (the controller then reads and
/// writes it without a copy), else this program's.
class UsbMemory {
 public:
  UsbMemory(libusb_device_handle* handle, std::size_t bytes);
  ~UsbMemory();
  UsbMemory(const UsbMemory&) = delete;
  UsbMemory& operator=(const UsbMemory&) = delete;

  [[nodiscard]] std::span<std::byte> bytes() const { return bytes_; }

 private:
  libusb_device_handle* handle_;
  std::span<std::byte> bytes_;
  std::vector<std::byte> own_;
};

/// Used by one thread at a time; libusb's events are handled within its calls, and nowhere else.
class BulkLink {
 public:
  /// Claims the interface. `handle` and `context` must outlive the link.
  static Result<std::unique_ptr<BulkLink>> open(libusb_context* context,
                                                libusb_device_handle* handle, std::string port,
                                                const UsbOptions& options);
  ~BulkLink();
  BulkLink(const BulkLink&) = delete;
  BulkLink& operator=(const BulkLink&) = delete;

  Result<void> send(std::span<const std::byte> bytes);
  Result<std::size_t> receive(std::span<std::byte> out, std::chrono::milliseconds timeout);

  /// Waits until the board has taken all that was sent.
  Result<void> flush();

 private:
  using Clock = std::chrono::steady_clock;
  enum class State { kIdle, kInFlight, kDone };
  struct Piece {
    Piece(libusb_device_handle* handle, std::size_t bytes) : memory(handle, bytes) {}
    UsbMemory memory;
    LibusbTransfer transfer;
    State state = State::kIdle;
    std::size_t taken = 0;     ///< of what came in
    std::uint64_t clears = 0;  ///< of its pipe, when it was submitted
  };
  struct Pipe {
    std::deque<Piece> pieces;
    std::size_t next = 0;      ///< the oldest piece: used next, or the one whose bytes come next
    int failures = 0;          ///< in a row
    std::uint64_t clears = 0;  ///< times that a halt was cleared
  };

  BulkLink(libusb_context* context, libusb_device_handle* handle, std::string port,
           const UsbOptions& options);
  Result<void> start();
  Result<void> add_pieces(Pipe& pipe, std::uint8_t endpoint);
  Result<void> submit(Piece& piece, const Pipe& pipe);
  Result<void> wait_for_events(std::chrono::milliseconds longest);
  Result<void> wait_for_room(Piece& piece);
  /// Takes note of how a transfer ended; an error only if the link cannot go on.
  Result<void> settle(const Piece& piece, Pipe& pipe);
  Result<void> tend_out();
  Result<void> put_by();
  [[nodiscard]] bool nothing_coming() const;
  [[nodiscard]] Error gone() const;
  static void LIBUSB_CALL finished(libusb_transfer* transfer) noexcept;

  libusb_context* context_;
  libusb_device_handle* handle_;
  std::string port_;
  UsbOptions options_;
  bool claimed_ = false;
  Pipe out_;
  Pipe in_;
  std::vector<std::byte> early_;  // came while send() waited and no transfer was free to hold it
  std::size_t early_taken_ = 0;
};

}  // namespace gridrt
