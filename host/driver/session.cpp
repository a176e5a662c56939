#include "host/driver/session.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <numeric>
#include <utility>

#include <fmt/format.h>

#include "host/driver/flash_image.hpp"
#include "host/driver/ray_log.hpp"
#include "host/driver/ray_order.hpp"
#include "host/driver/upload.hpp"
#include "host/grid/parallel.hpp"

namespace gridrt {
namespace {

using protocol::ErrorCode;
using protocol::FrameType;

constexpr int kMostAttempts = 16;  ///< times that one batch is sent before it is given up
constexpr std::size_t kMostLogWords = std::size_t{1} << 16U;  ///< above what any board keeps

}  // namespace

Session::Session(std::unique_ptr<Transport> transport, const DeviceOptions& options)
    : options_(options),
      threads_(resolve_threads(options.threads)),
      connection_(std::move(transport), std::chrono::milliseconds(options.timeout_ms)) {}

Result<std::unique_ptr<Session>> Session::open(std::unique_ptr<Transport> transport,
                                               const DeviceOptions& options) {
  if (options.rays_per_frame < 1 || options.frames_in_flight < 1 || options.timeout_ms < 1 ||
      options.threads < 0) {
    return fail(ErrorKind::kUsage, "batch size, frames in flight and time limit must be positive");
  }
  std::unique_ptr<Session> session(new Session(std::move(transport), options));
  Transport& link = session->connection_.transport();
  const auto identity = get_report<protocol::IdentityReport>(link);
  if (!identity) return std::unexpected(identity.error());
  if (identity->protocol_version != protocol::kVersion) {
    return fail(ErrorKind::kUnsupported,
                fmt::format("the device speaks protocol version {}, this program version {}",
                            identity->protocol_version, protocol::kVersion),
                "use the firmware and the program of one release");
  }
  const auto capabilities = get_report<protocol::CapabilitiesReport>(link);
  if (!capabilities) return std::unexpected(capabilities.error());
  session->capabilities_ = *capabilities;
  const auto end = std::ranges::find(identity->name, std::uint8_t{0});
  session->name_.assign(identity->name.begin(), end);
  if (capabilities->max_payload < 64) {
    return fail(ErrorKind::kProtocol, fmt::format("the device '{}' takes payloads of {} bytes only",
                                                  session->name_, capabilities->max_payload));
  }
  return session;
}

Result<void> Session::load(const Image& image) {
  answers_.reset();
  if (auto fits = check_fits(image, capabilities_); !fits) return fits;
  Result<Answers> answers = Answers::make(image);
  if (!answers) return std::unexpected(std::move(answers.error()));
  layout_ = static_cast<protocol::Layout>(image.header.layout);
  if (is_resident(image)) {
    answers_ = std::move(*answers);
    return {};
  }
  const auto start = std::chrono::steady_clock::now();
  if (auto done = upload(connection_, image, capabilities_, retries_); !done) return done;
  upload_seconds_ +=
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  ++uploads_;
  answers_ = std::move(*answers);
  return {};
}

/// Whether a board has loaded this very image from its flash. Boards alone have the report.
bool Session::is_resident(const Image& image) {
  const auto boot = get_report<protocol::BootReport>(connection_.transport());
  return boot && boot->resident == 1 && boot->fingerprint == fingerprint(image);
}

std::size_t Session::batch_size() const {
  const std::size_t room =
      (capabilities_.max_payload - protocol::TraceHead::kBytes) / ray_record_bytes(layout_);
  return std::min(options_.rays_per_frame, room);
}

/// Makes every hit a miss and lists the segments that go to the device, in their order.
void Session::choose(Work& work) const {
  const Hit miss = work.query == Query::kAnyHit ? any_hit_answer(false) : Hit{};
  const std::size_t count = work.segments.size();
  std::vector<std::size_t> place(count / kPiece + 2, 0);  // where a piece's begin
  parallel_pieces(threads_, count, [&](std::size_t first, std::size_t last) {
    std::size_t& here = place[first / kPiece + 1];
    for (std::size_t i = first; i < last; ++i) {
      work.hits[i] = miss;
      if (!work.segments[i].is_miss()) ++here;
    }
  });
  std::partial_sum(place.begin(), place.end(), place.begin());
  work.sent.resize(place.back());
  parallel_pieces(threads_, count, [&](std::size_t first, std::size_t last) {
    std::size_t at = place[first / kPiece];
    for (std::size_t i = first; i < last; ++i) {
      if (!work.segments[i].is_miss()) work.sent[at++] = i;
    }
  });
  if (options_.spread_rays && capabilities_.clock_hz > 0) work.sent = spread(work.sent);
}

Result<void> Session::trace(std::span<const Segment> segments, Query query, std::span<Hit> hits) {
  if (!answers_) return fail(ErrorKind::kUsage, "no image is loaded", "load an image first");
  if (hits.size() != segments.size()) {
    return fail(ErrorKind::kInternal, "trace() needs a hit for each segment");
  }
  Work work{*answers_, segments, query, hits, {}, {}};
  choose(work);
  connection_.progress();
  std::size_t next = 0;
  while (next < work.sent.size() || !work.in_flight.empty()) {
    while (next < work.sent.size() &&
           work.in_flight.size() < static_cast<std::size_t>(options_.frames_in_flight)) {
      Result<Batch> batch = make_batch(work, next);
      if (!batch) return std::unexpected(std::move(batch.error()));
      next += batch->count;
      work.in_flight.push_back(std::move(*batch));
      if (auto sent = connection_.send(work.in_flight.back().frame); !sent) return sent;
    }
    if (auto collected = collect(work); !collected) return collected;
    while (!work.in_flight.empty() && work.in_flight.front().done) {
      spare_frames_.push_back(std::move(work.in_flight.front().frame));
      work.in_flight.pop_front();
    }
  }
  return {};
}

Result<Session::Batch> Session::make_batch(const Work& work, std::size_t first) {
  Batch batch;
  batch.sequence = connection_.next_sequence();
  batch.first = first;
  batch.count = std::min(batch_size(), work.sent.size() - first);
  if (!spare_frames_.empty()) {
    batch.frame = std::move(spare_frames_.back());
    spare_frames_.pop_back();
    batch.frame.clear();
  }
  FrameBuilder builder(batch.frame, FrameType::kTrace, layout_, batch.sequence);
  std::array<std::byte, protocol::TraceHead::kBytes> head{};
  protocol::store(protocol::TraceHead{static_cast<std::uint32_t>(batch.count), batch.sequence},
                  head);
  builder.append(head);
  const std::size_t bytes = ray_record_bytes(layout_);
  const std::span<std::byte> records = builder.extend(batch.count * bytes);
  parallel_pieces(threads_, batch.count, [&](std::size_t from, std::size_t to) {
    for (std::size_t i = from; i < to; ++i) {
      const Segment& segment = work.segments[work.sent[first + i]];
      pack_ray(layout_, segment, work.answers.local_id(segment.ignore), work.query,
               records.subspan(i * bytes, bytes));
    }
  });
  if (auto built = builder.finish(); !built) return std::unexpected(std::move(built.error()));
  return batch;
}

Result<void> Session::collect(Work& work) {
  const Result<std::optional<Frame>> received = connection_.receive();
  if (!received) return std::unexpected(received.error());
  if (const std::optional<Frame>& frame = *received) return take(work, *frame);
  // Silence: whatever is still open was lost on the way there or back.
  for (Batch& batch : work.in_flight) {
    if (batch.done) continue;
    if (auto sent = send_again(batch); !sent) return sent;
  }
  return {};
}

Result<void> Session::take(Work& work, const Frame& frame) {
  const auto batch = std::ranges::find_if(work.in_flight, [&](const Batch& b) {
    return !b.done && b.sequence == frame.header.sequence;
  });
  // Not ours, or answered already: a late or doubled frame.
  if (batch == work.in_flight.end()) return {};
  if (frame.type() == FrameType::kHits) return take_hits(work, *batch, frame);
  if (frame.type() == FrameType::kError) return take_error(*batch, frame);
  return {};
}

/// Writes the answer to one segment; what is wrong with it, or null.
const char* Session::settle(const Work& work, std::size_t index, const DeviceHit& answer) {
  if (!answer.hit) return nullptr;
  if (work.query == Query::kAnyHit) {
    work.hits[index] = any_hit_answer(true);
    return nullptr;
  }
  if (answer.id >= work.answers.size()) return "an id beyond the image";
  const std::optional<Hit> hit = work.answers.hit(work.segments[index], answer.id);
  if (!hit) return "a triangle that the ray does not meet";
  work.hits[index] = *hit;
  return nullptr;
}

Result<void> Session::take_hits(Work& work, Batch& batch, const Frame& frame) {
  constexpr std::size_t kHead = protocol::TraceHead::kBytes;
  const std::size_t bytes = hit_record_bytes(layout_);
  const auto broken = [&](const char* what) {
    return fail(ErrorKind::kProtocol, fmt::format("the device '{}' answers with {}", name_, what),
                "this is a defect of the device");
  };
  if (frame.layout() != layout_) return broken("records of another layout");
  if (frame.payload.size() != kHead + batch.count * bytes) return broken("a wrong number of hits");
  const protocol::TraceHead head = protocol::load_trace_head(frame.payload.first<kHead>());
  if (head.count != batch.count || head.tag != batch.sequence) return broken("a wrong batch");
  const std::span<const std::byte> records = frame.payload.subspan(kHead);
  std::atomic<const char*> defect{nullptr};
  parallel_pieces(threads_, batch.count, [&](std::size_t first, std::size_t last) {
    const char* found = nullptr;
    for (std::size_t i = first; i < last && found == nullptr; ++i) {
      found = settle(work, work.sent[batch.first + i],
                     unpack_hit(layout_, records.subspan(i * bytes, bytes)));
    }
    if (found != nullptr) defect.store(found);
  });
  if (const char* found = defect.load()) return broken(found);
  batch.done = true;
  connection_.progress();
  return {};
}

Result<void> Session::take_error(Batch& batch, const Frame& frame) {
  constexpr std::size_t kBytes = protocol::ErrorBody::kBytes;
  if (frame.payload.size() != kBytes) return {};
  const protocol::ErrorBody error = protocol::load_error_body(frame.payload.first<kBytes>());
  const auto code = static_cast<ErrorCode>(error.code);
  if (code == ErrorCode::kBadPayloadCrc) return send_again(batch);
  return fail(ErrorKind::kDevice, fmt::format("the device '{}' refuses rays: {} (detail {})", name_,
                                              protocol::name(code), error.detail));
}

Result<void> Session::send_again(Batch& batch) {
  if (batch.attempts >= kMostAttempts) {
    return fail(ErrorKind::kTimeout,
                fmt::format("the device '{}' has not answered a batch of {} rays in {} attempts of "
                            "{} ms",
                            name_, batch.count, batch.attempts, options_.timeout_ms),
                "check the device and its cable, or use a longer time limit");
  }
  ++batch.attempts;
  ++retries_;
  return connection_.send(batch.frame);
}

Result<std::vector<ExplainEvent>> Session::explain(const Image& image, const Segment& segment) {
  Transport& link = connection_.transport();
  const auto before = get_report<protocol::ControlReport>(link);
  // Who has no settings has no log.
  if (!before && before.error().kind == ErrorKind::kUnsupported) {
    return Device::explain(image, segment);
  }
  if (!before) return std::unexpected(before.error());
  protocol::ControlReport control = *before;
  control.log = 1;
  if (auto on = set_report(link, control); !on) return std::unexpected(std::move(on.error()));
  Hit hit;
  auto traced = trace(std::span(&segment, 1), Query::kClosestHit, std::span(&hit, 1));
  if (!traced) return std::unexpected(std::move(traced.error()));
  std::vector<std::uint32_t> words;
  bool lost = false;
  for (;;) {
    const auto log = get_report<protocol::LogReport>(link);
    if (!log) return std::unexpected(log.error());
    lost = lost || log->overflow != 0;
    if (log->count == 0) break;
    if (words.size() > kMostLogWords) {
      return fail(ErrorKind::kProtocol,
                  fmt::format("the event log of the device '{}' does not end", name_),
                  "this is a defect of the device");
    }
    const std::size_t count = std::min<std::size_t>(log->count, log->words.size());
    words.insert(words.end(), log->words.begin(),
                 log->words.begin() + static_cast<std::ptrdiff_t>(count));
  }
  control.log = 0;
  if (auto off = set_report(link, control); !off) return std::unexpected(std::move(off.error()));
  return read_ray_log(image, segment, words, lost);
}

Result<void> Session::start_counting() {
  const auto report = get_report<protocol::CountersReport>(connection_.transport());
  if (!report) return std::unexpected(report.error());
  before_ = *report;
  connection_.forget_counts();
  return {};
}

Result<DeviceCounters> Session::counters() {
  const auto report = get_report<protocol::CountersReport>(connection_.transport());
  if (!report) return std::unexpected(report.error());
  // A device that was reset meanwhile counts from nothing.
  const bool anew = report->rays < before_.rays || report->cycles < before_.cycles;
  const protocol::CountersReport before = anew ? protocol::CountersReport{} : before_;
  DeviceCounters c;
  c.rays = report->rays - before.rays;
  c.steps = report->steps - before.steps;
  c.tests = report->tests - before.tests;
  c.masked = report->masked - before.masked;
  c.interrupts = report->interrupts - before.interrupts;
  c.feedback_waits = report->feedback_waits - before.feedback_waits;
  c.cycles = report->cycles - before.cycles;
  c.bytes_out = connection_.bytes_out();
  c.bytes_in = connection_.bytes_in();
  c.frames_retried = retries_;
  c.uploads = uploads_;
  c.upload_seconds = upload_seconds_;
  // Devices without workers do not have these.
  if (const auto more = get_report<protocol::ExchangeReport>(connection_.transport())) {
    c.exchange = *more;
  }
  if (const auto more = get_report<protocol::AheadReport>(connection_.transport())) {
    c.ahead = *more;
  }
  return c;
}

}  // namespace gridrt
