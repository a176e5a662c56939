#include "host/pe/thread_crew.hpp"

#include <algorithm>
#include <utility>

#include "hal/record_sizes.hpp"
#include "host/pe/ray_batch.hpp"
#include "host/pe/schedule_paper.hpp"
#include "host/pe/schedule_pes.hpp"
#include "host/pe/schedule_rays.hpp"

namespace gridrt {

Accepted<void> ThreadCrew::load(const protocol::LoadHead& head, std::span<const std::byte> bytes) {
  // The committed image goes on answering until another one is begun.
  Accepted<void> stored = store_.add(head, bytes);
  if (stored && begins_image(head)) image_.reset();
  return stored;
}

Accepted<void> ThreadCrew::commit(std::uint64_t pe_mask) {
  Accepted<std::unique_ptr<CommittedImage>> image = store_.commit(pe_mask);
  if (!image) return std::unexpected(image.error());
  if (schedule_.schedule == Schedule::kRays && !schedule_.plain) {
    (*image)->stream = make_stream(**image, schedule_.simd, schedule_.threads);
  }
  image_ = std::move(*image);
  return {};
}

protocol::Layout ThreadCrew::layout() const {
  return image_ ? static_cast<protocol::Layout>(image_->header.layout) : protocol::Layout::kNone;
}

Accepted<void> ThreadCrew::start(const TraceOrder& order) {
  if (!image_) return refuse(protocol::ErrorCode::kNotReady, 0);
  const Accepted<std::vector<BatchRay>> rays =
      unpack_rays(image_->header, order.records, std::max(1, schedule_.threads));
  if (!rays) return std::unexpected(rays.error());
  TraceAnswer answer{order.sequence, order.head, {}, {}};
  answer.hits.resize(rays->size() * hit_record_bytes(layout()));
  switch (schedule_.schedule) {
    case Schedule::kRays:
      trace_rays(*image_, *rays, answer.hits, schedule_.threads, counters_);
      break;
    case Schedule::kPes:
      trace_pes(*image_, *rays, answer.hits, schedule_, counters_);
      break;
    case Schedule::kPaper:
      trace_paper(*image_, *rays, answer.hits, schedule_, counters_);
      break;
  }
  answers_.push_back(std::move(answer));
  return {};
}

std::optional<TraceAnswer> ThreadCrew::finish(std::chrono::milliseconds /*patience*/) {
  if (answers_.empty()) return std::nullopt;
  TraceAnswer answer = std::move(answers_.front());
  answers_.pop_front();
  return answer;
}

void ThreadCrew::reset() {
  store_.clear();
  image_.reset();
  answers_.clear();
  counters_ = {};
}

}  // namespace gridrt
