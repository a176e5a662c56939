#include "host/mpi/rank_member.hpp"

#include <cstring>
#include <utility>

#include "hal/record_sizes.hpp"
#include "host/pe/ray_batch.hpp"

namespace gridrt {
namespace {

constexpr unsigned kDetailShift = 32;
/// Records that are worth a parcel while there is other work; MPI sends as many without asking
/// first.
constexpr std::size_t kFullParcel = 120;
constexpr int kMostRounds = 16;  ///< of work that a record waits for others to fill its parcel

}  // namespace

std::uint64_t pack_verdict(const Accepted<void>& verdict) {
  if (verdict) return 0;
  return (std::uint64_t{verdict.error().detail} << kDetailShift) |
         static_cast<std::uint64_t>(verdict.error().code);
}

Accepted<void> unpack_verdict(std::uint64_t number) {
  const auto code = static_cast<protocol::ErrorCode>(number & 0xFFFFU);
  if (code == protocol::ErrorCode::kNone) return {};
  return refuse(code, static_cast<std::uint32_t>(number >> kDetailShift));
}

RankMember::RankMember(Postbox& postbox, int device, const OpenOrder& order)
    : postbox_(postbox),
      device_(device),
      order_(order),
      groups_{postbox.ranks(), order.groups},
      store_(order.limits) {}

Accepted<void> RankMember::load(const protocol::LoadHead& head, std::span<const std::byte> bytes) {
  Accepted<void> stored = store_.add(head, bytes);
  if (stored && begins_image(head)) {
    counters_ = counters();
    worker_.reset();
    image_.reset();
  }
  return stored;
}

Accepted<void> RankMember::commit(const CommitOrder& order) {
  const auto members = static_cast<std::uint32_t>(groups_.size());
  const auto member = static_cast<std::uint32_t>(groups_.member(postbox_.rank()));
  std::uint64_t own = 0;
  for (std::uint32_t p = member; p < 64; p += members) own |= std::uint64_t{1} << p;
  Accepted<std::unique_ptr<CommittedImage>> image = store_.commit(order.pe_mask & own);
  if (!image) return std::unexpected(image.error());
  counters_ = counters();
  worker_.reset();
  image_ = std::move(*image);
  PesTeam team;
  team.worker = member;
  team.workers = members;
  team.interrupt = order_.interrupt;
  team.feedback = order_.feedback;
  team.first_batch = order.first_batch;
  worker_ = make_rank_worker(image_->engine, team, order_.schedule, [this] {
    flush();
    if (fetch_) fetch_();
  });
  return {};
}

void RankMember::reset() {
  worker_.reset();
  image_.reset();
  store_.clear();
  counters_ = {};
}

Accepted<void> RankMember::add_batch(std::uint32_t batch, std::span<const std::byte> records) {
  if (!worker_) {
    return refuse(protocol::ErrorCode::kNotReady, static_cast<std::uint32_t>(postbox_.rank()));
  }
  Accepted<std::vector<BatchRay>> rays = unpack_rays(image_->header, records, 1);
  if (!rays) return std::unexpected(rays.error());
  if (!busy()) {
    busy_since_ = now_ns();
    idle_since_ = 0;
  }
  worker_->add_batch(batch, std::move(*rays));
  return {};
}

void RankMember::take_records(std::span<const std::byte> content) {
  if (!worker_) return;  // late, of an image that is gone
  std::vector<PesRecord> records(content.size() / sizeof(PesRecord));
  std::memcpy(records.data(), content.data(), records.size() * sizeof(PesRecord));
  const bool was_busy = busy();
  worker_->take(records);
  if (was_busy && !busy()) measure(true);
}

bool RankMember::work() {
  if (!busy()) {
    // A parcel may have settled the last ray: others are to know that their batch is done.
    flush();
    return false;
  }
  const bool worked = worker_->work();
  if (worked && ++rounds_ < kMostRounds) {
    deliver(kFullParcel);
  } else {
    flush();
  }
  measure(worked);
  return worked;
}

/// Adds up the time with and without work while batches are under way.
void RankMember::measure(bool worked) {
  if (busy() && !worked) {
    if (idle_since_ == 0) idle_since_ = now_ns();
    return;
  }
  const std::uint64_t now = now_ns();
  // Of `paper`, waiting is time in barriers, which its worker counts.
  const bool counts = order_.schedule == Schedule::kPes;
  if (counts && idle_since_ != 0) counters_.wait_ns += now - idle_since_;
  idle_since_ = 0;
  if (busy_since_ == 0) return;
  counters_.worker_ns += now - busy_since_;
  busy_since_ = busy() ? now : 0;
}

void RankMember::flush() {
  rounds_ = 0;
  deliver(1);
}

/// Sends outboxes of at least so many records.
void RankMember::deliver(std::size_t least) {
  if (!worker_) return;
  const int first = groups_.first(groups_.group_of(postbox_.rank()));
  for (int to = first; to < first + groups_.size(); ++to) {
    std::vector<PesRecord>& records = worker_->outbox(static_cast<std::size_t>(to - first));
    if (to == postbox_.rank() || records.size() < least) continue;
    Parcel parcel{ParcelKind::kRecords, to, device_, 0, {}};
    const std::span<const std::byte> raw = std::as_bytes(std::span(records));
    parcel.content.assign(raw.begin(), raw.end());
    records.clear();
    send(std::move(parcel));
  }
}

void RankMember::send(Parcel parcel) {
  ++counters_.messages;
  counters_.message_bytes += parcel.content.size();
  const std::uint64_t start = now_ns();
  Result<void> sent = postbox_.send(std::move(parcel));
  counters_.message_ns += now_ns() - start;
  if (!sent && health_) health_ = std::move(sent);
}

std::optional<RankMember::Answer> RankMember::take_answer() {
  if (!worker_) return std::nullopt;
  const std::optional<PesWorker::Finished> batch = worker_->take_finished();
  if (!batch) return std::nullopt;
  const auto layout = static_cast<protocol::Layout>(image_->header.layout);
  Answer answer{batch->batch, {}};
  answer.hits.resize(batch->rays.size() * hit_record_bytes(layout));
  for (std::size_t i = 0; i < batch->rays.size(); ++i) {
    const HitKey& key = batch->answers[i];
    pack_answer(layout, batch->rays[i], key.id == kNoTriangle ? PeAnswer{} : PeAnswer{key}, i,
                answer.hits);
  }
  return answer;
}

PeCounters RankMember::counters() {
  PeCounters sum = counters_;
  if (worker_) sum += worker_->counters();
  return sum;
}

}  // namespace gridrt
