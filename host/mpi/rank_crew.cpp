#include "host/mpi/rank_crew.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <utility>

#include <fmt/format.h>

#include "hal/record_sizes.hpp"

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
                     milliseconds silence, int groups) {
  const auto limit = static_cast<std::uint32_t>(silence.count());
  return {schedule.schedule,
          schedule.interrupt,
          schedule.feedback,
          std::max(limit / kBeatsPerLimit, 1U),
          groups,
          limits};
}

}  // namespace

RankCrew::RankCrew(std::unique_ptr<Postbox> postbox, int device, const ScheduleOptions& schedule,
                   const protocol::CapabilitiesReport& limits, milliseconds silence, int groups)
    : postbox_(std::move(postbox)),
      device_(device),
      ranks_(postbox_->ranks()),
      groups_{ranks_, groups},
      silence_(silence),
      member_(*postbox_, device, make_order(schedule, limits, silence, groups)),
      last_tick_(steady_clock::now()),
      heard_(static_cast<std::size_t>(ranks_)) {
  const OpenOrder order = make_order(schedule, limits, silence, groups);
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
    int others = 0;
    for (int g = 0; g < groups_.groups; ++g) {
      const int owner = groups_.owner(g, head.pe);
      if (owner == 0) continue;
      send(owner, ParcelKind::kLoad, 0, raw, bytes);
      ++others;
    }
    const bool is_own = groups_.owner(0, head.pe) == 0;
    const Accepted<void> own = is_own ? member_.load(head, bytes) : Accepted<void>{};
    const Accepted<void> rest = await_replies(others);
    return own ? rest : own;
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
  tick();
  if (orders_.empty()) progress_ = listened_;
  const std::vector<OrderPart> parts = split_order(order.head.count, groups_.groups);
  const std::size_t ray_bytes = ray_record_bytes(layout());
  const auto records = [&](const OrderPart& part) {
    return order.records.subspan(part.first * ray_bytes, part.count * ray_bytes);
  };
  // The own part first: what is refused at once is not begun.
  if (Accepted<void> begun = member_.add_batch(next_batch_, records(parts[0])); !begun) {
    return begun;
  }
  orders_.begin(order, parts.size(), hit_record_bytes(layout()));
  for (const OrderPart& part : parts) {
    if (!orders_.expects(part.group)) listen_to(part.group);
    const int first = groups_.first(part.group);
    for (int to = std::max(first, 1); to < first + groups_.size(); ++to) {
      send(to, ParcelKind::kBatch, next_batch_, records(part));
    }
    orders_.add(next_batch_++, part);
  }
  return {};
}

/// Its ranks had nothing to say and have now.
void RankCrew::listen_to(int group) {
  const auto first = heard_.begin() + groups_.first(group);
  std::fill(first, first + groups_.size(), listened_);
}

std::optional<TraceAnswer> RankCrew::finish(milliseconds patience) {
  const auto end = steady_clock::now() + patience;
  while (health_ && !orders_.empty()) {
    const std::size_t fetched = fetch();
    const bool worked = member_.work();
    tick();
    if (worked) progress_ = listened_;
    if (const auto& health = member_.health(); !health && health_) health_ = health;
    while (const std::optional<RankMember::Answer> own = member_.take_answer()) {
      take_answer(own->batch, own->hits);
    }
    if (std::optional<TraceAnswer> answer = orders_.take()) {
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

void RankCrew::take_answer(std::uint32_t batch, std::span<const std::byte> hits) {
  if (orders_.answer(batch, hits)) return;
  give_up("a rank answers another number of rays than it has got", "the ranks' programs differ");
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
  orders_.clear();
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
    case ParcelKind::kAnswer:
      take_answer(static_cast<std::uint32_t>(parcel.number), parcel.content);
      break;
    case ParcelKind::kRefused: {
      std::uint64_t why = 0;
      std::memcpy(&why, parcel.content.data(), std::min(sizeof(why), parcel.content.size()));
      const Accepted<void> verdict = unpack_verdict(why);
      if (!verdict) orders_.refuse(static_cast<std::uint32_t>(parcel.number), verdict.error());
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
    if (!orders_.expects(groups_.group_of(r))) continue;
    if (listened_ - heard_[static_cast<std::size_t>(r)] <= silence_) continue;
    return give_up(fmt::format("rank {} has been silent for {} ms", r, silence_.count()),
                   "it hangs or is gone");
  }
  if (listened_ - progress_ <= silence_) return;
  give_up(fmt::format("{} batches of rays have no answer, and for {} ms no rank has had work: a "
                      "message between ranks is lost",
                      orders_.size(), silence_.count()),
          "check the network between the ranks");
}

void RankCrew::give_up(std::string message, std::string advice) {
  if (!health_) return;
  health_ = fail(ErrorKind::kDevice, "the device 'mpi' has failed: " + std::move(message),
                 std::move(advice));
}

}  // namespace gridrt
