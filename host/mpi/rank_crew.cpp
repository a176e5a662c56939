#include "host/mpi/rank_crew.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <utility>

#include <fmt/format.h>

#include "hal/record_sizes.hpp"
#include "host/pe/ray_batch.hpp"

namespace gridrt {
namespace {

using std::chrono::milliseconds;
using std::chrono::steady_clock;

constexpr std::size_t kFetchAtOnce = 64;     ///< parcels before work goes on
constexpr std::uint32_t kBeatsPerLimit = 4;  ///< beats of a rank in the time of silence allowed
constexpr milliseconds kLongestTick(100);
constexpr milliseconds kFarewell(2000);  ///< longest wait for ranks at the end

bool is_shared(std::uint8_t kind) {
  return kind <= static_cast<std::uint8_t>(protocol::SectionKind::kCells);
}

template <class T>
std::span<const std::byte> bytes_of(const T& value) {
  return std::as_bytes(std::span(&value, 1));
}

OpenOrder make_order(const ScheduleOptions& schedule, const protocol::CapabilitiesReport& limits,
                     milliseconds silence) {
  const auto limit = static_cast<std::uint32_t>(silence.count());
  return {schedule.schedule, schedule.interrupt, schedule.feedback,
          std::max(limit / kBeatsPerLimit, 1U), limits};
}

}  // namespace

RankCrew::RankCrew(std::unique_ptr<Postbox> postbox, int device, const ScheduleOptions& schedule,
                   const protocol::CapabilitiesReport& limits, milliseconds silence)
    : postbox_(std::move(postbox)),
      device_(device),
      ranks_(postbox_->ranks()),
      silence_(silence),
      member_(*postbox_, device, make_order(schedule, limits, silence)),
      last_tick_(steady_clock::now()),
      heard_(static_cast<std::size_t>(ranks_)) {
  const OpenOrder order = make_order(schedule, limits, silence);
  send_all(ParcelKind::kOpen, 0, bytes_of(order));
  member_.on_exchange([this] {
    Result<std::optional<Parcel>> parcel = postbox_->receive(device_);
    if (!parcel || !*parcel) return;
    if ((*parcel)->kind == ParcelKind::kRecords) {
      take(**parcel);
    } else {
      deferred_.push_back(std::move(**parcel));
    }
  });
}

RankCrew::~RankCrew() {
  const bool well = health_.has_value();
  replies_ = 0;
  send_all(ParcelKind::kClose, 0, {});
  const auto end = steady_clock::now() + kFarewell;
  while (well && health_ && replies_ < ranks_ - 1 && steady_clock::now() < end) {
    if (fetch() == 0) patience_.wait(true);
  }
}

void RankCrew::send(int to, ParcelKind kind, std::uint64_t number, std::span<const std::byte> head,
                    std::span<const std::byte> bytes) {
  Parcel parcel{kind, to, device_, number, {}};
  parcel.content.reserve(head.size() + bytes.size());
  parcel.content.insert(parcel.content.end(), head.begin(), head.end());
  parcel.content.insert(parcel.content.end(), bytes.begin(), bytes.end());
  if (kind == ParcelKind::kBatch) {
    member_.send(std::move(parcel));
  } else if (auto sent = postbox_->send(std::move(parcel)); !sent && health_) {
    health_ = sent;
  }
}

void RankCrew::send_all(ParcelKind kind, std::uint64_t number, std::span<const std::byte> content) {
  for (int to = 1; to < ranks_; ++to) send(to, kind, number, content);
}

Accepted<void> RankCrew::load(const protocol::LoadHead& head, std::span<const std::byte> bytes) {
  std::array<std::byte, protocol::LoadHead::kBytes> raw{};
  protocol::store(head, raw);
  if (begins_image(head)) ready_ = false;
  if (!is_shared(head.kind)) {
    const int owner = head.pe % ranks_;
    if (owner == 0) return member_.load(head, bytes);
    send(owner, ParcelKind::kLoad, 0, raw, bytes);
    return await_replies(1);
  }
  for (int to = 1; to < ranks_; ++to) send(to, ParcelKind::kLoad, 0, raw, bytes);
  const Accepted<void> own = member_.load(head, bytes);
  const Accepted<void> others = await_replies(ranks_ - 1);
  return own ? others : own;
}

Accepted<void> RankCrew::commit(std::uint64_t pe_mask) {
  const CommitOrder order{pe_mask, next_batch_, 0};
  send_all(ParcelKind::kCommit, 0, bytes_of(order));
  const Accepted<void> own = member_.commit(order);
  const Accepted<void> others = await_replies(ranks_ - 1);
  ready_ = own && others;
  return own ? others : own;
}

protocol::Layout RankCrew::layout() const {
  const protocol::ImageHeader* image = member_.image();
  return ready_ && image != nullptr ? static_cast<protocol::Layout>(image->layout)
                                    : protocol::Layout::kNone;
}

Accepted<void> RankCrew::start(const TraceOrder& order) {
  if (under_way_.empty()) {
    tick();
    std::ranges::fill(heard_, listened_);
    progress_ = listened_;
  }
  if (Accepted<void> begun = member_.add_batch(next_batch_, order.records); !begun) return begun;
  send_all(ParcelKind::kBatch, next_batch_, order.records);
  under_way_[next_batch_++] = {order.sequence, order.head};
  return {};
}

std::optional<TraceAnswer> RankCrew::finish(milliseconds patience) {
  const auto end = steady_clock::now() + patience;
  while (health_ && !under_way_.empty()) {
    const std::size_t fetched = fetch();
    const bool worked = member_.work();
    tick();
    if (worked) progress_ = listened_;
    if (const auto& health = member_.health(); !health && health_) health_ = health;
    if (std::optional<TraceAnswer> answer = take_finished()) {
      member_.flush();
      return answer;
    }
    if (fetched > 0 || worked) {
      patience_.renew();
    } else {
      check_silence();
      patience_.wait(true);
    }
    if (steady_clock::now() >= end) break;
  }
  member_.flush();
  return std::nullopt;
}

std::optional<TraceAnswer> RankCrew::take_finished() {
  if (!refused_.empty()) {
    TraceAnswer answer = std::move(refused_.front());
    refused_.pop_front();
    return answer;
  }
  const std::optional<PesWorker::Finished> batch = member_.take_finished();
  if (!batch) return std::nullopt;
  const auto order = under_way_.find(batch->batch);
  if (order == under_way_.end()) return std::nullopt;  // refused by a rank
  const auto layout = static_cast<protocol::Layout>(member_.image()->layout);
  TraceAnswer answer{order->second.sequence, order->second.head, {}, {}};
  answer.hits.resize(batch->rays.size() * hit_record_bytes(layout));
  for (std::size_t i = 0; i < batch->rays.size(); ++i) {
    const HitKey& key = batch->answers[i];
    pack_answer(layout, batch->rays[i], key.id == kNoTriangle ? PeAnswer{} : PeAnswer{key}, i,
                answer.hits);
  }
  under_way_.erase(order);
  return answer;
}

PeCounters RankCrew::counters() {
  counts_ = {};
  send_all(ParcelKind::kCount, 0, {});
  // A rank that does not answer shows in health_.
  [[maybe_unused]] const auto all = await_replies(ranks_ - 1);
  counts_ += member_.counters();
  return counts_;
}

void RankCrew::reset() {
  ready_ = false;
  under_way_.clear();
  refused_.clear();
  member_.reset();
  send_all(ParcelKind::kReset, 0, {});
  // A rank that does not answer shows in health_.
  [[maybe_unused]] const auto all = await_replies(ranks_ - 1);
}

/// Takes what has come, but not too much at once; returns how many parcels.
std::size_t RankCrew::fetch() {
  std::size_t n = 0;
  for (; n < kFetchAtOnce; ++n) {
    Result<std::optional<Parcel>> parcel;
    if (deferred_.empty()) {
      parcel = postbox_->receive(device_);
    } else {
      parcel = std::move(deferred_.front());
      deferred_.pop_front();
    }
    if (!parcel) {
      if (health_) health_ = std::unexpected(std::move(parcel.error()));
      break;
    }
    std::optional<Parcel>& came = *parcel;
    if (!came) break;
    take(*came);
  }
  return n;
}

void RankCrew::take(Parcel& parcel) {
  heard_[static_cast<std::size_t>(parcel.peer)] = listened_;
  if (parcel.kind != ParcelKind::kBeat || parcel.number != 0) progress_ = listened_;
  switch (parcel.kind) {
    case ParcelKind::kRecords:
      member_.take_records(parcel.content);
      break;
    case ParcelKind::kVerdict: {
      ++replies_;
      const Accepted<void> verdict = unpack_verdict(parcel.number);
      if (verdict_ && !verdict) verdict_ = verdict;
      break;
    }
    case ParcelKind::kCounts: {
      ++replies_;
      PeCounters counts;
      std::memcpy(&counts, parcel.content.data(), std::min(sizeof(counts), parcel.content.size()));
      counts_ += counts;
      break;
    }
    case ParcelKind::kGone:
      ++replies_;
      break;
    case ParcelKind::kRefused: {
      const auto order = under_way_.find(static_cast<std::uint32_t>(parcel.number));
      if (order == under_way_.end()) break;
      const Refusal refusal{protocol::ErrorCode::kNotReady,
                            static_cast<std::uint32_t>(parcel.peer)};
      refused_.push_back({order->second.sequence, order->second.head, {}, refusal});
      under_way_.erase(order);
      break;
    }
    default:
      break;
  }
}

/// Waits for that many replies; the first refusal among them, if any.
Accepted<void> RankCrew::await_replies(int replies) {
  tick();
  const std::chrono::nanoseconds start = listened_;
  while (health_ && replies_ < replies) {
    if (fetch() > 0) {
      patience_.renew();
      continue;
    }
    tick();
    if (listened_ - start > silence_) {
      give_up(fmt::format("{} of {} ranks have not answered for {} ms", replies - replies_, replies,
                          silence_.count()),
              "a rank hangs, or the machine is too busy: use a longer time limit");
    }
    patience_.wait(true);
  }
  replies_ = 0;
  return std::exchange(verdict_, {});
}

void RankCrew::tick() {
  const auto now = steady_clock::now();
  listened_ += std::min<std::chrono::nanoseconds>(now - last_tick_, kLongestTick);
  last_tick_ = now;
}

void RankCrew::check_silence() {
  for (int r = 1; r < ranks_; ++r) {
    if (listened_ - heard_[static_cast<std::size_t>(r)] <= silence_) continue;
    return give_up(fmt::format("rank {} has been silent for {} ms", r, silence_.count()),
                   "it hangs or is gone");
  }
  if (listened_ - progress_ <= silence_) return;
  give_up(fmt::format("{} batches of rays have no answer, and for {} ms no rank has had work: a "
                      "message between ranks is lost",
                      under_way_.size(), silence_.count()),
          "check the network between the ranks");
}

void RankCrew::give_up(std::string message, std::string advice) {
  if (!health_) return;
  health_ = fail(ErrorKind::kDevice, "the device 'mpi' has failed: " + std::move(message),
                 std::move(advice));
}

}  // namespace gridrt
