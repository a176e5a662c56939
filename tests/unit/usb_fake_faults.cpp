// The only bus, and what its faults do to a bulk transfer.
#include <algorithm>
#include <array>
#include <chrono>

#include "gridrt_usb.hpp"
#include "tests/unit/usb_fake_bus.hpp"

namespace gridrt::fake {

Bus& bus() {
  static Bus only;
  return only;
}

void Bus::plug_in(UsbFunction& board, std::uint64_t seed) {
  *this = Bus{};
  function = &board;
  plugged_in = true;
  random.seed(seed);
  function->reset();
  function->control({.request_type = 0, .request = 9, .value = 1}, {});
  show(*this);
}

bool Bus::happens(double chance) {
  return chance > 0.0 && static_cast<double>(random() >> 11U) * 0x1p-53 < chance;
}

namespace {

Moved::How how(TransferState state) {
  return state == TransferState::kDone      ? Moved::How::kDone
         : state == TransferState::kStalled ? Moved::How::kStall
                                            : Moved::How::kGone;
}

void reset_board(UsbFunction& board) {
  using Report = protocol::ResetReport;
  std::array<std::byte, 1 + Report::kBytes> bytes{static_cast<std::byte>(Report::kId)};
  protocol::store(Report{protocol::kResetKey}, std::span(bytes).subspan<1>());
  board.control({.request_type = 0x21,
                 .request = 9,
                 .value = static_cast<std::uint16_t>(0x300 | Report::kId),
                 .index = usb::kHidInterface,
                 .length = static_cast<std::uint16_t>(bytes.size())},
                bytes);
}

/// Counts a transfer, and what happens after so many.
void count(Bus& b) {
  if (++b.counts.transfers == b.faults.reset) reset_board(*b.function);
  if (b.is_dead() && !b.faults.still_there) b.plugged_in = false;
}

bool may_fail(const Bus& b) {
  return b.counts.stalls + b.counts.lost + b.counts.partial + b.counts.overflows < b.faults.most;
}

}  // namespace

std::optional<Moved> move_out(Bus& b, std::span<const std::byte> bytes) {
  if (b.counts.transfers >= b.faults.stop_taking) return std::nullopt;
  if (b.happens(b.faults.nak)) {
    ++b.counts.naks;
    return std::nullopt;
  }
  count(b);
  const bool may = may_fail(b);
  if (may && b.happens(b.faults.stall)) {
    ++b.counts.stalls;
    b.function->halt(usb::kBulkOut);
  } else if (may && b.happens(b.faults.lost)) {
    ++b.counts.lost;
    return Moved{Moved::How::kError, 0};
  } else if (may && b.happens(b.faults.partial)) {
    ++b.counts.partial;
    const std::size_t some = b.random() % (bytes.size() + 1);
    b.function->bulk_out(bytes.first(some));
    return Moved{Moved::How::kError, some};
  }
  const TransferState state = b.function->bulk_out(bytes);
  return Moved{how(state), state == TransferState::kDone ? bytes.size() : 0};
}

std::optional<Moved> move_in(Bus& b, std::span<std::byte> room) {
  if (b.counts.transfers >= b.faults.stop_giving) return std::nullopt;
  if (b.happens(b.faults.nak)) {
    ++b.counts.naks;
    return std::nullopt;
  }
  if (b.faults.most_in > 0) {
    room = room.first(std::min(room.size(), 1 + b.random() % b.faults.most_in));
    ++b.counts.cut;
  }
  const bool may = may_fail(b);
  Moved moved;
  if (may && b.happens(b.faults.stall)) {
    ++b.counts.stalls;
    b.function->halt(usb::kBulkIn);
  }
  if (b.happens(b.faults.empty)) {
    ++b.counts.empty;
  } else {
    const TransferState state =
        b.function->bulk_in(room, moved.bytes, std::chrono::milliseconds(0));
    if (state == TransferState::kWaiting) return std::nullopt;
    moved.how = how(state);
    if (state == TransferState::kDone && may && b.happens(b.faults.lost)) {
      ++b.counts.lost;
      moved = {Moved::How::kError, 0};
    } else if (state == TransferState::kDone && may && b.happens(b.faults.overflow)) {
      ++b.counts.overflows;
      moved.how = Moved::How::kOverflow;
    }
  }
  count(b);
  return moved;
}

}  // namespace gridrt::fake
