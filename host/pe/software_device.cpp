#include "host/pe/software_device.hpp"

#include <algorithm>
#include <array>
#include <utility>
#include <variant>

#include <fmt/format.h>

#include "hal/record_sizes.hpp"
#include "host/pe/image_store.hpp"
#include "host/pe/thread_crew.hpp"

namespace gridrt {
namespace {

using protocol::ErrorCode;
using protocol::FrameType;
using protocol::Layout;

constexpr std::chrono::seconds kBeat(1);  ///< silence before the host is told that work goes on

template <class Report>
void put_report(const Report& report, std::span<std::byte> body) {
  std::array<std::byte, Report::kBytes> bytes{};
  protocol::store(report, bytes);
  std::ranges::fill(body, std::byte{0});
  std::copy_n(bytes.begin(), std::min(bytes.size(), body.size()), body.begin());
}

}  // namespace

SoftwareDevice::SoftwareDevice(SoftwareDeviceOptions options)
    : options_(std::move(options)),
      crew_(std::make_unique<ThreadCrew>(options_.schedule, options_.capabilities)) {}

SoftwareDevice::SoftwareDevice(SoftwareDeviceOptions options, std::unique_ptr<Crew> crew)
    : options_(std::move(options)), crew_(std::move(crew)) {}

Result<void> SoftwareDevice::consume(std::span<const std::byte> bytes) {
  reader_.push(bytes);
  if (options_.frame_patience.count() > 0) last_byte_ = std::chrono::steady_clock::now();
  return handle_frames();
}

Result<void> SoftwareDevice::handle_frames() {
  while (const std::optional<FrameEvent> event = reader_.next()) {
    const auto* fault = std::get_if<FrameFault>(&*event);
    const Result<void> done =
        fault != nullptr ? answer_error(fault->header.sequence, {fault->code, fault->detail})
                         : handle(std::get<Frame>(*event));
    if (!done) return done;
  }
  return {};
}

Result<void> SoftwareDevice::handle(const Frame& frame) {
  const std::uint32_t sequence = frame.header.sequence;
  if (frame.payload.size() > options_.capabilities.max_payload) {
    return answer_error(sequence, {ErrorCode::kBadLength, frame.header.length});
  }
  if (frame.type() == FrameType::kTrace) return trace(frame);
  if (auto done = answer_all(); !done) return done;
  Accepted<void> accepted;
  switch (frame.type()) {
    case FrameType::kNoOp:
      return append_frame(out_, FrameType::kNoOp, Layout::kNone, sequence, {});
    case FrameType::kLoadSection:
      accepted = load_section(frame.payload);
      break;
    case FrameType::kCommit:
      accepted = commit(frame.payload);
      break;
    default:
      accepted = refuse(ErrorCode::kBadType, frame.header.type);
  }
  if (auto health = crew_->health(); !health) return health;
  if (!accepted) return answer_error(sequence, accepted.error());
  if (frame.type() != FrameType::kCommit) return {};
  return append_frame(out_, FrameType::kNoOp, Layout::kNone, sequence, {});
}

Accepted<void> SoftwareDevice::load_section(std::span<const std::byte> payload) {
  constexpr std::size_t kHead = protocol::LoadHead::kBytes;
  const auto length = static_cast<std::uint32_t>(payload.size());
  if (payload.size() < kHead) return refuse(ErrorCode::kBadLength, length);
  const protocol::LoadHead head = protocol::load_load_head(payload.first<kHead>());
  if ((std::uint64_t{head.bytes} + 3) / 4 * 4 != payload.size() - kHead) {
    return refuse(ErrorCode::kBadLength, length);
  }
  const Accepted<void> stored = crew_->load(head, payload.subspan(kHead, head.bytes));
  if (stored && begins_image(head)) state_ = protocol::DeviceState::kLoading;
  return stored;
}

Accepted<void> SoftwareDevice::commit(std::span<const std::byte> payload) {
  constexpr std::size_t kHead = protocol::CommitHead::kBytes;
  if (payload.size() != kHead) {
    return refuse(ErrorCode::kBadLength, static_cast<std::uint32_t>(payload.size()));
  }
  const Accepted<void> committed =
      crew_->commit(protocol::load_commit_head(payload.first<kHead>()).pe_mask);
  state_ = committed ? protocol::DeviceState::kReady : protocol::DeviceState::kFailed;
  return committed;
}

Result<void> SoftwareDevice::trace(const Frame& frame) {
  const std::uint32_t sequence = frame.header.sequence;
  // Sent again because the answer takes long: it will come.
  if (std::ranges::count(under_way_, sequence) > 0) return {};
  const Accepted<void> started = start(frame);
  if (auto health = crew_->health(); !health) return health;
  if (!started) return answer_error(sequence, started.error());
  if (under_way_.empty()) last_word_ = std::chrono::steady_clock::now();
  under_way_.push_back(sequence);
  const Result<bool> answered = answer_one(std::chrono::milliseconds(0));
  return answered ? Result<void>{} : std::unexpected(answered.error());
}

Accepted<void> SoftwareDevice::start(const Frame& frame) {
  constexpr std::size_t kHead = protocol::TraceHead::kBytes;
  const Layout layout = crew_->layout();
  if (layout == Layout::kNone) return refuse(ErrorCode::kNotReady, 0);
  if (frame.layout() != layout) return refuse(ErrorCode::kBadLayout, frame.header.layout);
  if (frame.payload.size() < kHead) return refuse(ErrorCode::kBadLength, frame.header.length);
  const protocol::TraceHead head = protocol::load_trace_head(frame.payload.first<kHead>());
  const std::span<const std::byte> records = frame.payload.subspan(kHead);
  if (head.count == 0 || records.size() != head.count * ray_record_bytes(layout)) {
    return refuse(ErrorCode::kBadLength, frame.header.length);
  }
  return crew_->start({frame.header.sequence, head, records});
}

/// Appends the answer to one Trace frame; false if none is ready in time.
Result<bool> SoftwareDevice::answer_one(std::chrono::milliseconds patience) {
  const std::optional<TraceAnswer> answer = crew_->finish(patience);
  if (auto health = crew_->health(); !health) return std::unexpected(std::move(health.error()));
  if (!answer) return false;
  std::erase(under_way_, answer->sequence);
  last_word_ = std::chrono::steady_clock::now();
  Result<void> done;
  if (answer->refusal) {
    done = answer_error(answer->sequence, *answer->refusal);
  } else {
    FrameBuilder reply(out_, FrameType::kHits, crew_->layout(), answer->sequence);
    std::array<std::byte, protocol::TraceHead::kBytes> head{};
    protocol::store(answer->head, head);
    reply.append(head);
    reply.append(answer->hits);
    done = reply.finish();
  }
  if (!done) return std::unexpected(std::move(done.error()));
  return true;
}

Result<void> SoftwareDevice::answer_all() {
  constexpr std::chrono::milliseconds kPatience(100);
  while (!under_way_.empty()) {
    if (auto answered = answer_one(kPatience); !answered) {
      return std::unexpected(std::move(answered.error()));
    }
  }
  return {};
}

Result<void> SoftwareDevice::answer_error(std::uint32_t sequence, const Refusal& refusal) {
  last_error_ = refusal;
  protocol::ErrorBody body;
  body.code = static_cast<std::uint16_t>(refusal.code);
  body.detail = refusal.detail;
  std::array<std::byte, protocol::ErrorBody::kBytes> bytes{};
  protocol::store(body, bytes);
  return append_frame(out_, FrameType::kError, Layout::kNone, sequence, bytes);
}

Result<std::size_t> SoftwareDevice::produce(std::span<std::byte> out,
                                            std::chrono::milliseconds timeout) {
  // The host has sent all it wants to and waits, so an unfinished frame was cut short on the way;
  // what it would swallow are the frames behind it.
  const auto cut_short = [&] {
    return out_.empty() && reader_.buffered() > 0 &&
           (options_.frame_patience.count() == 0 ||
            std::chrono::steady_clock::now() - last_byte_ >= options_.frame_patience);
  };
  while (cut_short()) {
    const std::size_t before = reader_.buffered();
    reader_.resynchronise();
    if (auto done = handle_frames(); !done) return std::unexpected(std::move(done.error()));
    if (reader_.buffered() == before) break;
  }
  if (out_.empty() && !under_way_.empty()) {
    if (auto answered = answer_one(timeout); !answered) {
      return std::unexpected(std::move(answered.error()));
    }
    const auto now = std::chrono::steady_clock::now();
    if (out_.empty() && now - last_word_ >= kBeat) {
      last_word_ = now;
      if (auto done = append_frame(out_, FrameType::kNoOp, Layout::kNone, 0, {}); !done) {
        return std::unexpected(std::move(done.error()));
      }
    }
  }
  const std::size_t bytes = std::min(out.size(), out_.size() - taken_);
  std::copy_n(out_.begin() + static_cast<std::ptrdiff_t>(taken_), bytes, out.begin());
  taken_ += bytes;
  if (taken_ == out_.size()) {
    out_.clear();
    taken_ = 0;
  }
  return bytes;
}

Result<void> SoftwareDevice::get_feature(std::uint8_t id, std::span<std::byte> body) {
  switch (id) {
    case protocol::IdentityReport::kId: {
      protocol::IdentityReport report;
      report.protocol_version = protocol::kVersion;
      std::copy_n(options_.name.begin(), std::min(options_.name.size(), report.name.size()),
                  report.name.begin());
      put_report(report, body);
      return {};
    }
    case protocol::CapabilitiesReport::kId:
      put_report(options_.capabilities, body);
      return {};
    case protocol::StatusReport::kId: {
      protocol::StatusReport report;
      report.state = static_cast<std::uint8_t>(state_);
      report.last_error = static_cast<std::uint16_t>(last_error_.code);
      report.error_detail = last_error_.detail;
      report.bad_frames = static_cast<std::uint32_t>(reader_.bad_frames());
      put_report(report, body);
      return {};
    }
    case protocol::CountersReport::kId: {
      const PeCounters counters = crew_->counters();
      protocol::CountersReport report;
      report.rays = counters.rays;
      report.steps = counters.steps;
      report.tests = counters.tests;
      report.masked = counters.masked;
      report.interrupts = counters.interrupts;
      report.feedback_waits = counters.feedback_waits;
      put_report(report, body);
      return crew_->health();
    }
    case protocol::ExchangeReport::kId: {
      const PeCounters counters = crew_->counters();
      protocol::ExchangeReport report;
      report.barriers = counters.barriers;
      report.barrier_ns = counters.barrier_ns;
      report.messages = counters.messages;
      report.message_bytes = counters.message_bytes;
      report.message_ns = counters.message_ns;
      report.wait_ns = counters.wait_ns;
      report.worker_ns = counters.worker_ns;
      put_report(report, body);
      return crew_->health();
    }
    case protocol::AheadReport::kId: {
      const PeCounters counters = crew_->counters();
      protocol::AheadReport report;
      report.tests_ahead = counters.tests_ahead;
      report.tests_aborted = counters.tests_aborted;
      report.aborted_ns = counters.aborted_ns;
      report.interrupts_sent = counters.interrupts_sent;
      report.feedbacks_sent = counters.feedbacks_sent;
      put_report(report, body);
      return crew_->health();
    }
    default:
      return fail(ErrorKind::kUnsupported, fmt::format("the device has no report {}", id));
  }
}

Result<void> SoftwareDevice::set_feature(std::uint8_t id, std::span<const std::byte> body) {
  if (id != protocol::ResetReport::kId) {
    return fail(ErrorKind::kUnsupported, fmt::format("report {} cannot be written", id));
  }
  constexpr std::size_t kBytes = protocol::ResetReport::kBytes;
  if (body.size() < kBytes ||
      protocol::load_reset_report(body.first<kBytes>()).key != protocol::kResetKey) {
    return fail(ErrorKind::kProtocol, "a Reset report without its key");
  }
  reset();
  return {};
}

void SoftwareDevice::reset() {
  crew_->reset();
  under_way_.clear();
  state_ = protocol::DeviceState::kEmpty;
  last_error_ = {protocol::ErrorCode::kNone, 0};
  reader_.clear();
  out_.clear();
  taken_ = 0;
}

}  // namespace gridrt
