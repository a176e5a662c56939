#include "hal/usb/bulk_link.hpp"

#include <algorithm>
#include <thread>
#include <utility>

#include "gridrt_usb.hpp"
#include "hal/usb/find.hpp"
#include "hal/usb/messages.hpp"

namespace gridrt {
namespace {

using std::chrono::milliseconds;

constexpr int kMostFailures = 8;  ///< in a row, of one pipe
constexpr milliseconds kSlice(100);
constexpr milliseconds kFarewell(2000);   ///< for transfers to come back when a link is closed
constexpr milliseconds kUnplugging(300);  ///< until the kernel has noticed

std::string status_text(libusb_transfer_status status) {
  switch (status) {
    case LIBUSB_TRANSFER_STALL:
      return "the board refuses transfers (stall)";
    case LIBUSB_TRANSFER_OVERFLOW:
      return "the board sent more than a transfer holds";
    case LIBUSB_TRANSFER_TIMED_OUT:
      return "time-out";
    default:
      return "errors on the wire";
  }
}

}  // namespace

UsbMemory::UsbMemory(libusb_device_handle* handle, std::size_t bytes) : handle_(handle) {
  if (unsigned char* shared = libusb_dev_mem_alloc(handle, bytes)) {
    bytes_ = std::as_writable_bytes(std::span(shared, bytes));
  } else {
    own_.resize(bytes);
    bytes_ = own_;
  }
}

UsbMemory::~UsbMemory() {
  if (own_.empty() && !bytes_.empty()) {
    libusb_dev_mem_free(handle_, reinterpret_cast<unsigned char*>(bytes_.data()), bytes_.size());
  }
}

BulkLink::BulkLink(libusb_context* context, libusb_device_handle* handle, std::string port,
                   const UsbOptions& options)
    : context_(context), handle_(handle), port_(std::move(port)), options_(options) {}

Result<std::unique_ptr<BulkLink>> BulkLink::open(libusb_context* context,
                                                 libusb_device_handle* handle, std::string port,
                                                 const UsbOptions& options) {
  if (options.transfers < 1 || options.transfer_bytes == 0 ||
      options.transfer_bytes % usb::kBulkPacketHigh != 0) {
    return fail(ErrorKind::kUsage,
                "USB transfers must be whole packets of 512 bytes, at least one");
  }
  std::unique_ptr<BulkLink> link(new BulkLink(context, handle, std::move(port), options));
  if (auto started = link->start(); !started) return std::unexpected(started.error());
  return link;
}

Result<void> BulkLink::start() {
  switch (const int code = libusb_claim_interface(handle_, usb::kBulkInterface)) {
    case LIBUSB_SUCCESS:
      claimed_ = true;
      break;
    case LIBUSB_ERROR_BUSY:
      return std::unexpected(usb_error::in_use(port_));
    case LIBUSB_ERROR_NO_DEVICE:
      return std::unexpected(gone());
    default:
      return std::unexpected(usb_error::failing("to the board", libusb_strerror(code), 1));
  }
  // What a program before this one left half-done ends here.
  libusb_clear_halt(handle_, usb::kBulkOut);
  libusb_clear_halt(handle_, usb::kBulkIn);
  if (auto added = add_pieces(out_, usb::kBulkOut); !added) return added;
  if (auto added = add_pieces(in_, usb::kBulkIn); !added) return added;
  for (Piece& piece : in_.pieces) {
    if (auto submitted = submit(piece, in_); !submitted) return submitted;
  }
  return {};
}

Result<void> BulkLink::add_pieces(Pipe& pipe, std::uint8_t endpoint) {
  for (std::size_t i = 0; i < options_.transfers; ++i) {
    Piece& piece = pipe.pieces.emplace_back(handle_, options_.transfer_bytes);
    piece.transfer.reset(libusb_alloc_transfer(0));
    if (!piece.transfer) return fail(ErrorKind::kTransport, "no memory for USB transfers");
    const std::span<std::byte> bytes = piece.memory.bytes();
    libusb_fill_bulk_transfer(piece.transfer.get(), handle_, endpoint,
                              reinterpret_cast<unsigned char*>(bytes.data()),
                              static_cast<int>(bytes.size()), &BulkLink::finished, &piece, 0);
  }
  return {};
}

BulkLink::~BulkLink() {
  const auto in_flight = [&] {
    const auto flies = [](const Piece& piece) { return piece.state == State::kInFlight; };
    return std::ranges::any_of(out_.pieces, flies) || std::ranges::any_of(in_.pieces, flies);
  };
  for (Pipe* pipe : {&out_, &in_}) {
    for (Piece& piece : pipe->pieces) {
      if (piece.state == State::kInFlight) libusb_cancel_transfer(piece.transfer.get());
    }
  }
  const auto end = Clock::now() + kFarewell;
  while (in_flight() && Clock::now() < end) {
    timeval time{0, 100000};
    libusb_handle_events_timeout_completed(context_, &time, nullptr);
  }
  // The kernel may still write to a transfer that never came back: better lost than used again.
  for (Pipe* pipe : {&out_, &in_}) {
    for (Piece& piece : pipe->pieces) {
      if (piece.state != State::kInFlight) continue;
      [[maybe_unused]] const libusb_transfer* lost = piece.transfer.release();
    }
  }
  if (claimed_) libusb_release_interface(handle_, usb::kBulkInterface);
}

void LIBUSB_CALL BulkLink::finished(libusb_transfer* transfer) noexcept {
  static_cast<Piece*>(transfer->user_data)->state = State::kDone;
}

Error BulkLink::gone() const {
  const auto end = Clock::now() + kUnplugging;
  while (is_plugged_in(port_)) {
    if (Clock::now() >= end) return usb_error::interrupted();
    std::this_thread::sleep_for(milliseconds(10));
  }
  return usb_error::unplugged();
}

Result<void> BulkLink::submit(Piece& piece, const Pipe& pipe) {
  const int code = libusb_submit_transfer(piece.transfer.get());
  if (code == LIBUSB_SUCCESS) {  // it cannot finish before events are handled
    piece.taken = 0;
    piece.clears = pipe.clears;
    piece.state = State::kInFlight;
    return {};
  }
  if (code == LIBUSB_ERROR_NO_DEVICE) return std::unexpected(gone());
  return std::unexpected(usb_error::failing("to the board", libusb_strerror(code), 1));
}

Result<void> BulkLink::settle(const Piece& piece, Pipe& pipe) {
  const libusb_transfer& transfer = *piece.transfer;
  if (transfer.status == LIBUSB_TRANSFER_COMPLETED) {
    pipe.failures = 0;
    return {};
  }
  if (transfer.status == LIBUSB_TRANSFER_NO_DEVICE) return std::unexpected(gone());
  if (transfer.status == LIBUSB_TRANSFER_CANCELLED)
    return std::unexpected(usb_error::interrupted());
  // One halt ends all transfers that were under way.
  const bool stalled = transfer.status == LIBUSB_TRANSFER_STALL;
  if (stalled && piece.clears != pipe.clears) return {};
  if (++pipe.failures >= kMostFailures) {
    const bool in = (transfer.endpoint & LIBUSB_ENDPOINT_IN) != 0;
    return std::unexpected(usb_error::failing(in ? "from the board" : "to the board",
                                              status_text(transfer.status), pipe.failures));
  }
  // The bytes of that transfer are lost; the frames that they belonged to are sent again.
  if (!stalled) return {};
  ++pipe.clears;
  if (libusb_clear_halt(handle_, transfer.endpoint) == LIBUSB_ERROR_NO_DEVICE) {
    return std::unexpected(gone());
  }
  return {};
}

Result<void> BulkLink::wait_for_events(milliseconds longest) {
  timeval time{longest.count() / 1000, static_cast<suseconds_t>(longest.count() % 1000 * 1000)};
  const int code = libusb_handle_events_timeout_completed(context_, &time, nullptr);
  if (code == LIBUSB_SUCCESS || code == LIBUSB_ERROR_INTERRUPTED) return {};
  if (code == LIBUSB_ERROR_NO_DEVICE) return std::unexpected(gone());
  return std::unexpected(usb_error::failing("to the board", libusb_strerror(code), 1));
}

bool BulkLink::nothing_coming() const {
  return std::ranges::none_of(in_.pieces,
                              [](const Piece& piece) { return piece.state == State::kInFlight; });
}

/// A board that cannot get rid of its answers takes no more questions: makes room for them.
Result<void> BulkLink::put_by() {
  Piece& piece = in_.pieces[in_.next];
  const std::span<std::byte> came =
      piece.memory.bytes().first(static_cast<std::size_t>(piece.transfer->actual_length));
  const std::span<std::byte> left = came.subspan(piece.taken);
  if (early_.size() + left.size() > options_.most_early_bytes) {
    return std::unexpected(usb_error::endless(early_.size()));
  }
  early_.insert(early_.end(), left.begin(), left.end());
  in_.next = (in_.next + 1) % in_.pieces.size();
  if (auto settled = settle(piece, in_); !settled) return settled;
  return submit(piece, in_);
}

Result<void> BulkLink::wait_for_room(Piece& piece) {
  const auto end = Clock::now() + options_.patience;
  while (piece.state == State::kInFlight) {
    if (nothing_coming()) {
      if (auto put = put_by(); !put) return put;
    }
    if (auto waited = wait_for_events(std::min(kSlice, options_.patience)); !waited) return waited;
    if (piece.state == State::kInFlight && Clock::now() >= end) {
      return std::unexpected(usb_error::takes_no_bytes(
          static_cast<std::size_t>(piece.transfer->length), options_.patience));
    }
  }
  return tend_out();
}

/// A halt of the pipe is cleared as soon as it is seen, not when its transfer is used again: the
/// host may be waiting for an answer to what was lost.
Result<void> BulkLink::tend_out() {
  for (Piece& piece : out_.pieces) {
    if (piece.state != State::kDone) continue;
    piece.state = State::kIdle;
    if (auto settled = settle(piece, out_); !settled) return settled;
  }
  return {};
}

Result<void> BulkLink::send(std::span<const std::byte> bytes) {
  while (!bytes.empty()) {
    Piece& piece = out_.pieces[out_.next];
    if (auto room = wait_for_room(piece); !room) return room;
    const std::size_t size = std::min(bytes.size(), piece.memory.bytes().size());
    std::ranges::copy(bytes.first(size), piece.memory.bytes().begin());
    piece.transfer->length = static_cast<int>(size);
    if (auto submitted = submit(piece, out_); !submitted) return submitted;
    out_.next = (out_.next + 1) % out_.pieces.size();
    bytes = bytes.subspan(size);
  }
  return {};
}

Result<void> BulkLink::flush() {
  for (Piece& piece : out_.pieces) {
    if (auto done = wait_for_room(piece); !done) return done;
  }
  return {};
}

Result<std::size_t> BulkLink::receive(std::span<std::byte> out, milliseconds timeout) {
  if (out.empty()) return 0;
  if (early_taken_ < early_.size()) {
    const std::size_t size = std::min(out.size(), early_.size() - early_taken_);
    std::copy_n(early_.begin() + static_cast<std::ptrdiff_t>(early_taken_), size, out.begin());
    early_taken_ += size;
    return size;
  }
  early_.clear();
  early_taken_ = 0;
  const auto end = Clock::now() + timeout;
  std::size_t given = 0;
  for (;;) {
    Piece& piece = in_.pieces[in_.next];
    if (piece.state == State::kInFlight) {
      // What there is is worth more than what may come.
      const auto left = std::chrono::ceil<milliseconds>(end - Clock::now());
      if (given > 0 || left <= milliseconds(0)) return given;
      Result<void> waited = wait_for_events(std::min(left, kSlice));
      if (waited) waited = tend_out();
      if (!waited) return std::unexpected(waited.error());
      continue;
    }
    const auto came = static_cast<std::size_t>(piece.transfer->actual_length);
    const std::size_t size = std::min(out.size() - given, came - piece.taken);
    std::ranges::copy(piece.memory.bytes().subspan(piece.taken, size),
                      out.begin() + static_cast<std::ptrdiff_t>(given));
    piece.taken += size;
    given += size;
    if (piece.taken == came) {
      const Result<void> settled = settle(piece, in_);
      const Result<void> again = settled ? submit(piece, in_) : settled;
      if (again) in_.next = (in_.next + 1) % in_.pieces.size();
      // The bytes before a failure count; the next call finds the failure again.
      if (!again && given == 0) return std::unexpected(again.error());
      if (!again) return given;
    }
    if (given == out.size()) return given;
  }
}

}  // namespace gridrt
