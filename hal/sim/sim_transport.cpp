#include "hal/sim/sim_transport.hpp"

#include <algorithm>
#include <array>
#include <string>
#include <utility>

namespace gridrt {
namespace {

constexpr std::uint64_t kGap = 256;  ///< clocks between two bytes that end a receive()
constexpr std::size_t kPiece = 4096;
constexpr std::size_t kWord = 4;

const protocol::RegisterWindow* find_window(std::uint8_t report, bool write) {
  const auto found = std::ranges::find_if(protocol::kRegisterWindows, [=](const auto& window) {
    return window.report == report && (write ? window.writable : window.readable);
  });
  return found == protocol::kRegisterWindows.end() ? nullptr : &*found;
}

}  // namespace

SimTransport::SimTransport(std::unique_ptr<SimBoard> board, SimTransportOptions options)
    : board_(std::move(board)), options_(options) {}

std::span<const std::byte> SimTransport::queued() const {
  return std::span(to_board_).subspan(taken_);
}

void SimTransport::drop(std::size_t taken) {
  taken_ += taken;
  if (taken_ == to_board_.size()) {
    to_board_.clear();
    taken_ = 0;
  }
}

std::unexpected<Error> SimTransport::stuck() const {
  return fail(ErrorKind::kTimeout,
              "the simulated board has taken none of " + std::to_string(queued().size()) +
                  " bytes and said nothing for " + std::to_string(options_.silent_clocks) +
                  " clocks (at clock " + std::to_string(clocks()) + ")",
              "this is a defect of the RTL; --trace FILE.fst shows where it waits");
}

Result<void> SimTransport::send(std::span<const std::byte> bytes) {
  // What has been taken goes once it is the larger half, so that a byte is moved once on average.
  if (taken_ > to_board_.size() / 2) {
    to_board_.erase(to_board_.begin(), to_board_.begin() + static_cast<std::ptrdiff_t>(taken_));
    taken_ = 0;
  }
  to_board_.insert(to_board_.end(), bytes.begin(), bytes.end());
  return {};
}

Result<std::size_t> SimTransport::receive(std::span<std::byte> out,
                                          std::chrono::milliseconds /*timeout*/) {
  if (out.empty()) return 0;
  if (given_ < early_.size()) {
    const std::size_t bytes = std::min(out.size(), early_.size() - given_);
    std::copy_n(early_.begin() + static_cast<std::ptrdiff_t>(given_), bytes, out.begin());
    given_ += bytes;
    silences_ = 0;
    return bytes;
  }
  early_.clear();
  given_ = 0;
  const RunResult moved =
      board_->run(queued(), out, {.quiet = options_.silent_clocks, .gap = kGap});
  drop(moved.taken);
  if (moved.given > 0) {
    silences_ = 0;
    return moved.given;
  }
  if (!queued().empty()) return stuck();
  if (++silences_ > options_.most_silences) {
    return fail(ErrorKind::kTimeout,
                "the simulated board has taken every byte and said nothing for " +
                    std::to_string(silences_) + " times " + std::to_string(options_.silent_clocks) +
                    " clocks (at clock " + std::to_string(clocks()) + ")",
                "this is a defect of the RTL; --trace FILE.fst shows where it waits");
  }
  return 0;
}

/// Hands the board what has been sent before a report is asked for.
Result<void> SimTransport::deliver() {
  std::array<std::byte, kPiece> piece{};
  while (!queued().empty()) {
    const RunResult moved = board_->run(
        queued(), piece, {.quiet = options_.silent_clocks, .gap = kGap, .stop_if_sent = true});
    drop(moved.taken);
    early_.insert(early_.end(), piece.begin(),
                  piece.begin() + static_cast<std::ptrdiff_t>(moved.given));
    if (moved.taken == 0 && moved.given == 0) return stuck();
  }
  return {};
}

Result<std::uint32_t> SimTransport::access(RegisterAccess access) {
  board_->run({}, {}, {.quiet = options_.silent_clocks, .gap = 1}, &access);
  if (!access.done) {
    return fail(ErrorKind::kTimeout,
                "the simulated board has not served its register " +
                    std::to_string(access.address) + " for " +
                    std::to_string(options_.silent_clocks) + " clocks",
                "this is a defect of the RTL");
  }
  return access.data;
}

Result<void> SimTransport::get_feature(std::uint8_t id, std::span<std::byte> body) {
  const protocol::RegisterWindow* window = find_window(id, false);
  if (window == nullptr) {
    return fail(ErrorKind::kUnsupported,
                "the simulated board has no report " + std::to_string(id) + " to read");
  }
  if (auto sent = deliver(); !sent) return sent;
  std::ranges::fill(body, std::byte{0});
  for (std::size_t w = 0; w < window->words && kWord * w < body.size(); ++w) {
    const auto read = access({.address = window->base + static_cast<std::uint32_t>(kWord * w)});
    if (!read) return std::unexpected(read.error());
    std::array<std::byte, kWord> word{};
    protocol::detail::put32(word.data(), *read);
    const std::size_t bytes = std::min(kWord, body.size() - kWord * w);
    std::copy_n(word.begin(), bytes, body.begin() + static_cast<std::ptrdiff_t>(kWord * w));
  }
  return {};
}

Result<void> SimTransport::set_feature(std::uint8_t id, std::span<const std::byte> body) {
  const protocol::RegisterWindow* window = find_window(id, true);
  if (window == nullptr) {
    return fail(ErrorKind::kUnsupported, "report " + std::to_string(id) + " cannot be written");
  }
  const std::size_t bytes = kWord * window->words;
  const bool is_reset = id == protocol::ResetReport::kId;
  if (body.size() < bytes ||
      (is_reset && protocol::detail::get32(body.data()) != protocol::kResetKey)) {
    return fail(ErrorKind::kProtocol,
                is_reset ? "a Reset report without its key" : "a report that is cut short");
  }
  const auto sent = deliver();
  if (!sent && !is_reset) return sent;  // Reset is for boards that take no more
  for (std::size_t at = 0; at < bytes; at += kWord) {
    const auto written = access({.write = true,
                                 .address = window->base + static_cast<std::uint32_t>(at),
                                 .data = protocol::detail::get32(body.data() + at)});
    if (!written) return std::unexpected(written.error());
  }
  if (is_reset) {
    to_board_.clear();
    early_.clear();
    taken_ = given_ = 0;
    silences_ = 0;
  }
  return {};
}

}  // namespace gridrt
