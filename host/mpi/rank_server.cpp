#include "host/mpi/rank_server.hpp"

#include <algorithm>
#include <cstring>
#include <utility>

#include "host/mpi/patience.hpp"

namespace gridrt {
namespace {

constexpr std::size_t kFetchAtOnce = 64;  ///< parcels before work goes on
constexpr std::uint64_t kNsPerMs = 1'000'000;

template <class T>
T from_bytes(const std::vector<std::byte>& content) {
  T value{};
  std::memcpy(&value, content.data(), std::min(sizeof(T), content.size()));
  return value;
}

}  // namespace

Result<void> RankServer::serve() {
  Patience patience;
  for (;;) {
    const Result<Step> step = this->step();
    if (!step) return std::unexpected(step.error());
    if (step->stopped) return {};
    bool busy = false;
    for (const auto& [number, served] : devices_) busy = busy || served.member->busy();
    if (step->idle) {
      patience.wait(busy);
    } else {
      patience.renew();
    }
  }
}

Result<RankServer::Step> RankServer::step() {
  Step step{.stopped = false, .idle = true};
  if (auto done = fetch(kFetchAtOnce, step); !done) return std::unexpected(done.error());
  if (step.stopped) return step;
  for (auto& [number, served] : devices_) {
    const bool worked = served.member->work();
    if (worked) step.idle = false;
    while (std::optional<RankMember::Answer> answer = served.member->take_answer()) {
      served.member->send({ParcelKind::kAnswer, 0, number, answer->batch, std::move(answer->hits)});
    }
    beat(number, served, worked);
    if (const auto& health = served.member->health(); !health) {
      return std::unexpected(health.error());
    }
  }
  return step;
}

Result<void> RankServer::fetch(std::size_t most, Step& step) {
  for (std::size_t n = 0; n < most && !step.stopped; ++n) {
    Result<std::optional<Parcel>> parcel;
    if (deferred_.empty()) {
      parcel = postbox_.receive(kAnyDevice);
    } else {
      parcel = std::move(deferred_.front());
      deferred_.pop_front();
    }
    if (!parcel) return std::unexpected(parcel.error());
    std::optional<Parcel>& came = *parcel;
    if (!came) return {};
    step.idle = false;
    if (came->kind == ParcelKind::kStop) {
      step.stopped = true;
      return postbox_.send({ParcelKind::kGone, 0, kNoDevice, 0, {}});
    }
    if (auto done = handle(*came); !done) return done;
  }
  return {};
}

Result<void> RankServer::handle(Parcel& parcel) {
  if (parcel.kind == ParcelKind::kOpen) {
    open(parcel);
    return {};
  }
  if (parcel.kind == ParcelKind::kClose) {
    devices_.erase(parcel.device);
    return postbox_.send({ParcelKind::kGone, 0, parcel.device, 0, {}});
  }
  const auto served = devices_.find(parcel.device);
  if (served == devices_.end()) return {};  // late, of a device that is closed
  return handle(served->second, parcel);
}

void RankServer::open(const Parcel& parcel) {
  const auto order = from_bytes<OpenOrder>(parcel.content);
  Served& served = devices_[parcel.device];
  served.member = std::make_unique<RankMember>(postbox_, parcel.device, order);
  served.beat_ns = order.beat_ms * kNsPerMs;
  served.member->on_exchange([this, device = parcel.device, member = served.member.get()] {
    fetch_record(device, *member);
  });
}

/// In the midst of work only records are taken; the rest waits for its turn.
void RankServer::fetch_record(int device, RankMember& member) {
  Result<std::optional<Parcel>> parcel = postbox_.receive(kAnyDevice);
  if (!parcel) return;
  std::optional<Parcel>& came = *parcel;
  if (!came) return;
  if (came->kind == ParcelKind::kRecords && came->device == device) {
    member.take_records(came->content);
  } else {
    deferred_.push_back(std::move(*came));
  }
}

Result<void> RankServer::handle(Served& served, Parcel& parcel) {
  RankMember& member = *served.member;
  const auto reply = [&](ParcelKind kind, std::uint64_t number, std::vector<std::byte> content) {
    return postbox_.send({kind, 0, parcel.device, number, std::move(content)});
  };
  switch (parcel.kind) {
    case ParcelKind::kLoad: {
      constexpr std::size_t kHead = protocol::LoadHead::kBytes;
      const std::span<const std::byte> content(parcel.content);
      const protocol::LoadHead head = protocol::load_load_head(content.first<kHead>());
      return reply(ParcelKind::kVerdict, pack_verdict(member.load(head, content.subspan(kHead))),
                   {});
    }
    case ParcelKind::kCommit:
      return reply(ParcelKind::kVerdict,
                   pack_verdict(member.commit(from_bytes<CommitOrder>(parcel.content))), {});
    case ParcelKind::kReset:
      member.reset();
      return reply(ParcelKind::kVerdict, 0, {});
    case ParcelKind::kBatch: {
      served.last_beat = now_ns();
      const Accepted<void> begun =
          member.add_batch(static_cast<std::uint32_t>(parcel.number), parcel.content);
      if (begun) return {};
      const std::uint64_t why = pack_verdict(begun);
      const auto raw = std::as_bytes(std::span(&why, 1));
      return reply(ParcelKind::kRefused, parcel.number, {raw.begin(), raw.end()});
    }
    case ParcelKind::kRecords:
      member.take_records(parcel.content);
      return {};
    case ParcelKind::kCount: {
      const PeCounters counters = member.counters();
      std::vector<std::byte> content(sizeof(counters));
      std::memcpy(content.data(), &counters, sizeof(counters));
      return reply(ParcelKind::kCounts, 0, std::move(content));
    }
    default:
      return fail(ErrorKind::kTransport, "a rank got a parcel that it does not know");
  }
}

/// Tells rank 0 now and then that this rank is alive, and whether it has had work.
void RankServer::beat(int device, Served& served, bool worked) {
  served.worked = served.worked || worked;
  if (!served.member->busy()) return;
  const std::uint64_t now = now_ns();
  if (now - served.last_beat < served.beat_ns) return;
  served.last_beat = now;
  served.member->send({ParcelKind::kBeat, 0, device, served.worked ? 1U : 0U, {}});
  served.worked = false;
}

}  // namespace gridrt
