#include "tests/rtl/hostile_board.hpp"

#include <algorithm>
#include <array>
#include <utility>
#include <variant>

#include <gtest/gtest.h>

#include "tests/rtl/payloads.hpp"

namespace gridrt::rtl {

using protocol::BoardCommand;
using protocol::FrameType;

namespace {

constexpr std::uint32_t kHangs = 0xDEAD0;  ///< of GRIDRT_TEST_HANG in rtl/gridrt_core.sv
constexpr std::uint32_t kKnownSequence = 0xA5C30000U;  ///< and the numbers behind it: known_trace()
/// Within which firmware answers a report whatever goes on: a self-test and a boot may come first.
constexpr std::uint64_t kReportClocks = 1'000'000;
constexpr std::uint64_t kQuiet = 2 * GRIDRT_RTL_HANG_CLOCKS;

}  // namespace

HostileBoard::HostileBoard(std::unique_ptr<SimBoard> board, std::uint64_t seed, const KnownImage& a,
                           const KnownImage& b, Harm harm, NoiseCounts& counts)
    : board_(std::move(board)),
      hostile_(seed, a.image, harm >= Harm::kLoads),
      a_(a),
      b_(b),
      harm_(harm),
      counts_(counts) {}

void HostileBoard::load() {
  waiting_.insert(waiting_.end(), a_.frames.begin(), a_.frames.end());
  calm_down();
}

void HostileBoard::make_noise(int actions) {
  if (below(4) != 0) {  // else an unfinished frame swallows what comes behind it
    ReportAccess access{.set = true, .id = protocol::ControlReport::kId};
    access.length = protocol::ControlReport::kBytes;
    protocol::store(protocol::ControlReport{.idle_clocks = 100 + below(2000), .log = below(2)},
                    std::span(access.body).first<protocol::ControlReport::kBytes>());
    run(kReportClocks, &access);
    EXPECT_TRUE(access.good);
  }
  for (int i = 0; i < actions && !testing::Test::HasFailure(); ++i) {
    act();
    if (below(2) == 0) throw_frame(known_trace(kKnownSequence + asked_++));
    run(1 + below(3000));
    InputReport input;
    if (below(4) == 0 && board_->take_input(input)) {
      EXPECT_TRUE(input.id == protocol::EventReport::kId ||
                  input.id == protocol::StatusReport::kId);
    }
  }
}

void HostileBoard::calm_down() {
  constexpr int kMostRounds = 400;
  for (int round = 0; round < kMostRounds; ++round) {
    const std::size_t before = waiting_.size();
    run(kQuiet);
    if (waiting_.empty() && before == 0) break;
  }
  EXPECT_TRUE(waiting_.empty()) << "the board takes no more: " << waiting_.size() << " bytes left";
  // Firmware that brings the board back answers no report before it has done so.
  ReportAccess access{.id = protocol::StatusReport::kId};
  run(kReportClocks, &access);
  EXPECT_TRUE(access.done && access.good) << "the firmware does not answer";
  run(kQuiet);
}

bool HostileBoard::is_right(std::span<const std::byte> hits) const {
  return std::ranges::equal(hits, a_.hits) || std::ranges::equal(hits, b_.hits);
}

void HostileBoard::act() {
  switch (below(harm_ < Harm::kLoads ? 8 : 14)) {
    case 0:
      return throw_frame(hostile_.bytes(below(300)));
    case 1:
      return throw_frame(hostile_.trace());
    case 2:
      return throw_frame(hostile_.any());
    case 3:
      return throw_frame(hostile_.promise());
    case 4:
      return throw_frame(endless());
    case 5:
      return stop_reading();
    case 6:
      return harm_ != Harm::kNone && below(8) == 0 ? hang() : report();
    case 7:
      return report();
    case 8:
      return throw_frame(hostile_.load());
    case 9:
      return throw_frame(hostile_.commit());
    case 10:
      if (harm_ == Harm::kImages) {
        throw_frame(hostile_.sections());
        return throw_frame(hostile_.commit());
      }
      return throw_frame(hostile_.load());
    case 11:
    case 12:
      throw_frame(late_piece());
      return throw_frame(known_trace(kKnownSequence + asked_++));
    default: {
      // An image as it should be, or all of it but for its end or its beginning.
      std::vector<std::byte> frames = below(2) == 0 ? a_.frames : b_.frames;
      const std::uint32_t cut = below(static_cast<std::uint32_t>(frames.size()));
      if (below(4) == 0) frames.resize(cut);
      if (below(2) == 0) frames.erase(frames.begin(), frames.begin() + cut / 2);
      return throw_frame(std::move(frames));
    }
  }
}

/// An engine that answers no more.
void HostileBoard::hang() {
  std::vector<protocol::RayCompact> ray(1, known_rays().front());
  ray.front().ignore = kHangs;
  std::vector<std::byte> frame;
  EXPECT_TRUE(
      append_frame(frame, FrameType::kTrace, protocol::Layout::kCompact, 3, trace_payload(ray, 3)));
  ++counts_.hangs;
  throw_frame(std::move(frame));
  run(GRIDRT_RTL_HANG_CLOCKS + below(3000));
}

/// A piece of a known image's section that comes once more, with other bytes in it.
std::vector<std::byte> HostileBoard::late_piece() {
  FrameReader pieces;
  pieces.push(below(4) == 0 ? b_.frames : a_.frames);
  std::vector<std::byte> out;
  // The header's piece is the first one.
  for (std::uint32_t skip = 1 + below(8); auto event = pieces.next();) {
    const auto* frame = std::get_if<Frame>(&*event);
    if (frame == nullptr || frame->type() != FrameType::kLoadSection) continue;
    if (skip-- > 0) continue;
    std::vector<std::byte> payload(frame->payload.begin(), frame->payload.end());
    const auto bytes = static_cast<std::uint32_t>(payload.size() - protocol::LoadHead::kBytes);
    if (bytes == 0) continue;
    for (std::uint32_t i = 1 + below(60); i > 0; --i) {
      payload[protocol::LoadHead::kBytes + below(bytes)] = static_cast<std::byte>(below(256));
    }
    EXPECT_TRUE(append_frame(out, FrameType::kLoadSection, protocol::Layout::kNone, 5, payload));
    break;
  }
  return out;
}

/// Bytes without an end in sight: random ones, headers, or the payload of a large frame.
std::vector<std::byte> HostileBoard::endless() {
  const std::uint32_t count = 2000 + below(12000);
  switch (below(3)) {
    case 0:
      return hostile_.bytes(count);
    case 1: {
      std::vector<std::byte> out;
      const auto header = hostile_.any();
      const auto piece = std::span(header).first(std::min<std::size_t>(header.size(), 20));
      while (out.size() < count) {
        out.insert(out.end(), piece.begin(), piece.end());
        if (piece.empty()) out.push_back(std::byte{0});
      }
      return out;
    }
    default: {
      auto out = hostile_.promise();
      const auto more = hostile_.bytes(count);
      out.insert(out.end(), more.begin(), more.end());
      return out;
    }
  }
}

void HostileBoard::throw_frame(std::vector<std::byte> frame) {
  ++counts_.frames;
  counts_.bytes += frame.size();
  waiting_.insert(waiting_.end(), frame.begin(), frame.end());
}

void HostileBoard::run(std::uint64_t clocks, ReportAccess* access) {
  std::array<std::byte, 4096> said{};
  const RunResult moved =
      board_->run(waiting_, said, {.quiet = clocks, .gap = ~std::uint64_t{0}}, access);
  waiting_.erase(waiting_.begin(), waiting_.begin() + static_cast<std::ptrdiff_t>(moved.taken));
  listen(std::span(said).first(moved.given));
}

/// The board gets rid of nothing for a while.
void HostileBoard::stop_reading() {
  const RunResult moved =
      board_->run(waiting_, {}, {.quiet = 1 + below(2 * GRIDRT_RTL_HANG_CLOCKS), .gap = 1});
  waiting_.erase(waiting_.begin(), waiting_.begin() + static_cast<std::ptrdiff_t>(moved.taken));
}

void HostileBoard::listen(std::span<const std::byte> bytes) {
  reader_.push(bytes);
  while (const auto event = reader_.next()) {
    const auto* frame = std::get_if<Frame>(&*event);
    if (frame == nullptr || frame->header.sequence - kKnownSequence >= asked_) continue;
    if (frame->type() == FrameType::kError) ++counts_.errors;
    if (frame->type() != FrameType::kHits || harm_ == Harm::kImages) continue;
    EXPECT_TRUE(is_right(frame->payload)) << "a wrong answer without a word";
    ++counts_.right;
  }
}

ReportAccess HostileBoard::random_report() {
  ReportAccess access;
  access.set = below(2) == 0;
  access.id = static_cast<std::uint8_t>(below(4) == 0 ? below(256) : below(18));
  if (!access.set) return access;
  constexpr std::array kWritable{protocol::ResetReport::kId, protocol::ControlReport::kId,
                                 protocol::CommandReport::kId};
  if (below(3) != 0) access.id = kWritable.at(below(3));
  access.length = below(static_cast<std::uint32_t>(access.body.size()) + 1);
  std::ranges::copy(hostile_.bytes(access.body.size()), access.body.begin());
  if (below(2) == 0) {
    const std::uint32_t word = access.id == protocol::ResetReport::kId     ? protocol::kResetKey
                               : access.id == protocol::CommandReport::kId ? below(3)
                                                                           : hostile_.value();
    protocol::detail::put32(access.body.data(), word);
  }
  return access;
}

void HostileBoard::report() {
  ReportAccess access = random_report();
  const std::uint32_t first = protocol::detail::get32(access.body.data());
  const auto command = static_cast<BoardCommand>(first & 0xFFU);
  const bool sets_control = access.id == protocol::ControlReport::kId &&
                            access.length >= protocol::ControlReport::kBytes && first != 0;
  const bool resets = access.id == protocol::ResetReport::kId &&
                      access.length >= protocol::ResetReport::kBytes &&
                      first == protocol::kResetKey;
  const bool commands = access.id == protocol::CommandReport::kId && access.length >= 1 &&
                        (command == BoardCommand::kSelfTest || command == BoardCommand::kBoot);
  if (access.set && (resets || commands)) {
    if (harm_ == Harm::kNone) return;
    (resets ? counts_.resets : counts_.commands) += 1;
  }
  ++counts_.reports;
  if (below(5) == 0) {  // the host gives up at once
    ++counts_.given_up;
    return run(1 + below(300), &access);
  }
  run(kReportClocks, &access);
  EXPECT_TRUE(access.done) << "the firmware does not answer report " << int{access.id};
  if (access.set) {
    EXPECT_EQ(access.good, sets_control || resets || commands) << "report " << int{access.id};
  }
  counts_.refused += access.good ? 0 : 1;
}

}  // namespace gridrt::rtl
