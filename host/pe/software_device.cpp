#include "host/pe/software_device.hpp"

#include <algorithm>
#include <array>
#include <utility>
#include <variant>

#include <fmt/format.h>

#include "hal/record_sizes.hpp"
#include "host/pe/ray_batch.hpp"
#include "host/pe/schedule_paper.hpp"
#include "host/pe/schedule_pes.hpp"
#include "host/pe/schedule_rays.hpp"

namespace gridrt {
namespace {

using protocol::ErrorCode;
using protocol::FrameType;
using protocol::Layout;

template <class Report>
void put_report(const Report& report, std::span<std::byte> body) {
  std::array<std::byte, Report::kBytes> bytes{};
  protocol::store(report, bytes);
  std::ranges::fill(body, std::byte{0});
  std::copy_n(bytes.begin(), std::min(bytes.size(), body.size()), body.begin());
}

}  // namespace

SoftwareDevice::SoftwareDevice(SoftwareDeviceOptions options)
    : options_(std::move(options)), store_(options_.capabilities) {}

Result<void> SoftwareDevice::consume(std::span<const std::byte> bytes) {
  reader_.push(bytes);
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
  Accepted<void> accepted;
  switch (frame.type()) {
    case FrameType::kNoOp:
      return append_frame(out_, FrameType::kNoOp, Layout::kNone, sequence, {});
    case FrameType::kLoadSection:
      accepted = load_section(frame.payload);
      break;
    case FrameType::kCommit:
      accepted = commit(frame.payload);
      if (accepted) return append_frame(out_, FrameType::kNoOp, Layout::kNone, sequence, {});
      break;
    case FrameType::kTrace: {
      const std::size_t before = out_.size();
      FrameBuilder reply(out_, FrameType::kHits, frame.layout(), sequence);
      accepted = trace(frame, reply);
      if (accepted) return reply.finish();
      out_.resize(before);
      break;
    }
    default:
      accepted = refuse(ErrorCode::kBadType, frame.header.type);
  }
  return accepted ? Result<void>{} : answer_error(sequence, accepted.error());
}

Accepted<void> SoftwareDevice::load_section(std::span<const std::byte> payload) {
  constexpr std::size_t kHead = protocol::LoadHead::kBytes;
  const auto length = static_cast<std::uint32_t>(payload.size());
  if (payload.size() < kHead) return refuse(ErrorCode::kBadLength, length);
  const protocol::LoadHead head = protocol::load_load_head(payload.first<kHead>());
  if ((std::uint64_t{head.bytes} + 3) / 4 * 4 != payload.size() - kHead) {
    return refuse(ErrorCode::kBadLength, length);
  }
  // The committed image goes on answering until another one is begun.
  const Accepted<void> stored = store_.add(head, payload.subspan(kHead, head.bytes));
  if (stored && head.kind == static_cast<std::uint8_t>(protocol::SectionKind::kHeader)) {
    image_.reset();
    state_ = protocol::DeviceState::kLoading;
  }
  return stored;
}

Accepted<void> SoftwareDevice::commit(std::span<const std::byte> payload) {
  constexpr std::size_t kHead = protocol::CommitHead::kBytes;
  if (payload.size() != kHead) {
    return refuse(ErrorCode::kBadLength, static_cast<std::uint32_t>(payload.size()));
  }
  Accepted<std::unique_ptr<CommittedImage>> image =
      store_.commit(protocol::load_commit_head(payload.first<kHead>()).pe_mask);
  if (!image) {
    state_ = protocol::DeviceState::kFailed;
    return std::unexpected(image.error());
  }
  const ScheduleOptions& schedule = options_.schedule;
  if (schedule.schedule == Schedule::kRays && !schedule.plain) {
    (*image)->stream = make_stream(**image, schedule.simd, schedule.threads);
  }
  image_ = std::move(*image);
  state_ = protocol::DeviceState::kReady;
  return {};
}

Accepted<void> SoftwareDevice::trace(const Frame& frame, FrameBuilder& reply) {
  constexpr std::size_t kHead = protocol::TraceHead::kBytes;
  if (!image_) return refuse(ErrorCode::kNotReady, 0);
  if (frame.header.layout != image_->header.layout) {
    return refuse(ErrorCode::kBadLayout, frame.header.layout);
  }
  if (frame.payload.size() < kHead) return refuse(ErrorCode::kBadLength, frame.header.length);
  const protocol::TraceHead head = protocol::load_trace_head(frame.payload.first<kHead>());
  const std::span<const std::byte> records = frame.payload.subspan(kHead);
  if (head.count == 0 || records.size() != head.count * ray_record_bytes(frame.layout())) {
    return refuse(ErrorCode::kBadLength, frame.header.length);
  }
  const Accepted<std::vector<BatchRay>> rays = unpack_rays(image_->header, records);
  if (!rays) return std::unexpected(rays.error());
  reply.append(frame.payload.first(kHead));
  const std::span<std::byte> hits = reply.extend(head.count * hit_record_bytes(frame.layout()));
  switch (options_.schedule.schedule) {
    case Schedule::kRays:
      trace_rays(*image_, *rays, hits, options_.schedule.threads, counters_);
      break;
    case Schedule::kPes:
      trace_pes(*image_, *rays, hits, options_.schedule, counters_);
      break;
    case Schedule::kPaper:
      trace_paper(*image_, *rays, hits, options_.schedule, counters_);
      break;
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
                                            std::chrono::milliseconds /*timeout*/) {
  // The host has sent all it wants to and waits, so an unfinished frame was cut short on the way;
  // what it would swallow are the frames behind it.
  while (out_.empty() && reader_.buffered() > 0) {
    const std::size_t before = reader_.buffered();
    reader_.resynchronise();
    if (auto done = handle_frames(); !done) return std::unexpected(std::move(done.error()));
    if (reader_.buffered() == before) break;
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
      protocol::CountersReport report;
      report.rays = counters_.rays;
      report.steps = counters_.steps;
      report.tests = counters_.tests;
      report.masked = counters_.masked;
      report.interrupts = counters_.interrupts;
      report.feedback_waits = counters_.feedback_waits;
      put_report(report, body);
      return {};
    }
    case protocol::ExchangeReport::kId: {
      protocol::ExchangeReport report;
      report.barriers = counters_.barriers;
      report.barrier_ns = counters_.barrier_ns;
      report.messages = counters_.messages;
      report.message_bytes = counters_.message_bytes;
      report.message_ns = counters_.message_ns;
      report.wait_ns = counters_.wait_ns;
      report.worker_ns = counters_.worker_ns;
      put_report(report, body);
      return {};
    }
    case protocol::AheadReport::kId: {
      protocol::AheadReport report;
      report.tests_ahead = counters_.tests_ahead;
      report.tests_aborted = counters_.tests_aborted;
      report.aborted_ns = counters_.aborted_ns;
      report.interrupts_sent = counters_.interrupts_sent;
      report.feedbacks_sent = counters_.feedbacks_sent;
      put_report(report, body);
      return {};
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
  store_.clear();
  image_.reset();
  state_ = protocol::DeviceState::kEmpty;
  last_error_ = {protocol::ErrorCode::kNone, 0};
  counters_ = {};
  reader_.clear();
  out_.clear();
  taken_ = 0;
}

}  // namespace gridrt
