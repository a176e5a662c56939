#include "hal/sim/sim_transport.hpp"

#include <algorithm>
#include <array>
#include <string>
#include <utility>

namespace gridrt {
namespace {

constexpr std::uint64_t kGap = 256;  ///< clocks between two bytes that end a receive()
constexpr std::size_t kPiece = 4096;
constexpr std::size_t kMostEarly = std::size_t{1} << 16U;  ///< that read_input() adds to

/// Reports that a host may write.
bool is_writable(std::uint8_t id) {
  return id == protocol::ResetReport::kId || id == protocol::ControlReport::kId ||
         id == protocol::CommandReport::kId;
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

/// Runs the board while nobody waits for its answers.
RunResult SimTransport::run_early(bool stop_if_sent) {
  std::array<std::byte, kPiece> piece{};
  const RunResult moved =
      board_->run(queued(), piece,
                  {.quiet = options_.silent_clocks, .gap = kGap, .stop_if_sent = stop_if_sent});
  drop(moved.taken);
  early_.insert(early_.end(), piece.begin(),
                piece.begin() + static_cast<std::ptrdiff_t>(moved.given));
  return moved;
}

Result<void> SimTransport::deliver(std::size_t left) {
  while (queued().size() > left) {
    const RunResult moved = run_early(true);
    if (moved.taken == 0 && moved.given == 0) return stuck();
  }
  return {};
}

Result<void> SimTransport::exchange(ReportAccess& access) {
  board_->run({}, {}, {.quiet = options_.report_clocks, .gap = 1}, &access);
  if (!access.done) {
    return fail(ErrorKind::kTimeout,
                "the simulated board's firmware has not answered for " +
                    std::to_string(options_.report_clocks) + " clocks, asked for report " +
                    std::to_string(access.id),
                "this is a defect of the firmware or the RTL");
  }
  if (access.good) return {};
  if (access.set && is_writable(access.id)) {
    return fail(ErrorKind::kProtocol,
                "the simulated board refuses what report " + std::to_string(access.id) + " says");
  }
  return fail(ErrorKind::kUnsupported, "the simulated board has no report " +
                                           std::to_string(access.id) +
                                           (access.set ? " to write" : " to read"));
}

Result<void> SimTransport::get_feature(std::uint8_t id, std::span<std::byte> body) {
  if (options_.reports_wait) {
    if (auto sent = deliver(); !sent) return sent;
  }
  ReportAccess access{.id = id};
  if (auto done = exchange(access); !done) return done;
  std::ranges::fill(body, std::byte{0});
  std::copy_n(access.body.begin(), std::min(access.length, body.size()), body.begin());
  return {};
}

Result<void> SimTransport::set_feature(std::uint8_t id, std::span<const std::byte> body) {
  const bool is_reset = id == protocol::ResetReport::kId;
  const auto sent = options_.reports_wait ? deliver() : Result<void>{};
  if (!sent && !is_reset) return sent;  // Reset is for boards that take no more
  ReportAccess access{.set = true, .id = id};
  access.length = std::min(body.size(), access.body.size());
  std::copy_n(body.begin(), access.length, access.body.begin());
  if (auto done = exchange(access); !done) return done;
  if (is_reset) {
    board_->forget();
    to_board_.clear();
    early_.clear();
    taken_ = given_ = 0;
    silences_ = 0;
  }
  return {};
}

Result<std::optional<std::uint8_t>> SimTransport::read_input(
    std::span<std::byte> body, std::chrono::milliseconds /*timeout*/) {
  InputReport report;
  if (!board_->take_input(report)) {
    if (early_.size() - given_ >= kMostEarly) return std::nullopt;
    run_early(false);
    if (!board_->take_input(report)) return std::nullopt;
  }
  std::ranges::fill(body, std::byte{0});
  std::copy_n(report.body.begin(), std::min(report.body.size(), body.size()), body.begin());
  return report.id;
}

}  // namespace gridrt
