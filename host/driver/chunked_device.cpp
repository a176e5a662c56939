#include "host/driver/chunked_device.hpp"

#include <algorithm>
#include <limits>
#include <numeric>
#include <utility>

#include <fmt/format.h>

#include "host/driver/ray_records.hpp"
#include "host/driver/upload.hpp"
#include "host/grid/box_entry.hpp"
#include "host/grid/intersect.hpp"

namespace gridrt {

/// One call of trace().
struct ChunkedDevice::Work {
  std::span<const Segment> segments;
  Query query;
  std::span<Hit> hits;
  std::vector<HitKey> best;  ///< by segment, closest hits only
  /// Scratch of a visit: the segments that go, and where they came from.
  std::vector<Segment> sent;
  std::vector<std::size_t> places;
  std::vector<Hit> answers;

  /// Whether a chunk whose box the segment enters at `entry` can still change its answer. Every hit
  /// in the chunk has a quotient of at least `entry`; an equal one may have the smaller id.
  [[nodiscard]] bool is_open(std::size_t i, std::uint32_t entry) const {
    if (query == Query::kAnyHit) return hits[i].id < 0;
    return entry <= best[i].quotient;
  }
};

Result<std::unique_ptr<Device>> load_images(std::unique_ptr<Device> device,
                                            std::shared_ptr<const SceneImages> images) {
  if (images->chunks.size() == 1) {
    if (auto loaded = device->load(images->front()); !loaded) {
      return std::unexpected(std::move(loaded.error()));
    }
    return device;
  }
  for (std::size_t i = 0; i < images->chunks.size(); ++i) {
    if (auto fits = check_fits(images->chunks[i].image, device->capabilities()); !fits) {
      Error error = std::move(fits.error());
      error.message =
          fmt::format("chunk {} of {}: {}", i + 1, images->chunks.size(), error.message);
      return std::unexpected(std::move(error));
    }
  }
  return std::make_unique<ChunkedDevice>(std::move(device), std::move(images));
}

ChunkedDevice::ChunkedDevice(std::unique_ptr<Device> device,
                             std::shared_ptr<const SceneImages> images)
    : device_(std::move(device)), images_(std::move(images)) {
  triangle_by_id_.assign(images_->front().header.triangles, kNoTriangle);
  const std::vector<std::uint32_t>& ids = images_->triangles.global_ids;
  for (std::size_t i = 0; i < ids.size(); ++i) {
    triangle_by_id_[ids[i]] = static_cast<std::uint32_t>(i);
  }
}

Result<void> ChunkedDevice::load(const Image& image) {
  images_.reset();
  loaded_.reset();
  return device_->load(image);
}

Result<void> ChunkedDevice::trace(std::span<const Segment> segments, Query query,
                                  std::span<Hit> hits) {
  if (!images_) return device_->trace(segments, query, hits);
  if (hits.size() != segments.size()) {
    return fail(ErrorKind::kInternal, "trace() needs a hit for each segment");
  }
  Work work{.segments = segments,
            .query = query,
            .hits = hits,
            .best = {},
            .sent = {},
            .places = {},
            .answers = {}};
  std::ranges::fill(hits, query == Query::kAnyHit ? any_hit_answer(false) : Hit{});
  if (query == Query::kClosestHit) work.best.assign(segments.size(), HitKey{});
  for (const std::size_t chunk : visiting_order(work)) {
    if (auto done = visit(chunk, work); !done) return done;
  }
  return {};
}

/// Front to back, as far as the rays of a batch agree: by the mean of the parameters at which a
/// sample of them enters a chunk. The answers do not depend on it, the number of rays sent does.
/// Any hit ends an any-hit ray, so there the chunk that is loaded comes first.
std::vector<std::size_t> ChunkedDevice::visiting_order(const Work& work) const {
  constexpr std::size_t kSample = 1024;
  const std::size_t step = std::max<std::size_t>(1, work.segments.size() / kSample);
  std::vector<double> depth(images_->chunks.size());
  for (std::size_t c = 0; c < depth.size(); ++c) {
    const Chunk& chunk = images_->chunks[c];
    double sum = 0.0;
    std::size_t rays = 0;
    for (std::size_t i = 0; i < work.segments.size(); i += step) {
      const Segment& s = work.segments[i];
      if (s.is_miss()) continue;
      const auto entry = entry_quotient(s.p0, s.p1, chunk.lo, chunk.hi);
      if (!entry) continue;
      sum += *entry;
      ++rays;
    }
    depth[c] =
        rays == 0 ? std::numeric_limits<double>::infinity() : sum / static_cast<double>(rays);
  }
  if (work.query == Query::kAnyHit && loaded_) depth[*loaded_] = -1.0;
  std::vector<std::size_t> order(depth.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::sort(order, {}, [&](std::size_t c) { return std::pair(depth[c], c); });
  return order;
}

/// Sends the chunk the rays that it may answer, and loads it first if there are any.
Result<void> ChunkedDevice::visit(std::size_t chunk, Work& work) {
  const Chunk& c = images_->chunks[chunk];
  work.sent.clear();
  work.places.clear();
  for (std::size_t i = 0; i < work.segments.size(); ++i) {
    const Segment& s = work.segments[i];
    if (s.is_miss()) continue;
    const auto entry = entry_quotient(s.p0, s.p1, c.lo, c.hi);
    if (!entry || !work.is_open(i, *entry)) continue;
    work.sent.push_back(s);
    work.places.push_back(i);
  }
  if (work.sent.empty()) return {};
  if (auto done = load_chunk(chunk); !done) return done;
  work.answers.assign(work.sent.size(), Hit{});
  if (auto done = device_->trace(work.sent, work.query, work.answers); !done) return done;
  for (std::size_t i = 0; i < work.sent.size(); ++i) {
    if (work.answers[i].id < 0) continue;
    if (auto done = merge(work, i); !done) return done;
  }
  return {};
}

Result<void> ChunkedDevice::load_chunk(std::size_t chunk) {
  if (loaded_ == chunk) return {};
  loaded_.reset();
  if (auto done = device_->load(images_->chunks[chunk].image); !done) return done;
  loaded_ = chunk;
  return {};
}

Result<std::vector<ExplainEvent>> ChunkedDevice::explain(const Image& image,
                                                         const Segment& segment) {
  const std::size_t chunks = images_ ? images_->chunks.size() : 0;
  for (std::size_t i = 0; i < chunks; ++i) {
    if (&images_->chunks[i].image != &image) continue;
    if (auto done = load_chunk(i); !done) return std::unexpected(std::move(done.error()));
  }
  return device_->explain(image, segment);
}

/// Keeps the smaller key of the best so far and answer `i` of a visit. The quotient is computed
/// from the exact integers again: t is rounded, and two that are equal may come from different
/// ones.
Result<void> ChunkedDevice::merge(Work& work, std::size_t i) {
  const Hit& hit = work.answers[i];
  const std::size_t place = work.places[i];
  if (work.query == Query::kAnyHit) {
    work.hits[place] = hit;
    return {};
  }
  const auto id = static_cast<std::uint32_t>(hit.id);
  const Segment& segment = work.sent[i];
  const auto exact = id < triangle_by_id_.size() && triangle_by_id_[id] != kNoTriangle
                         ? intersect_exact(segment.p0, segment.p1,
                                           images_->triangles.triangles[triangle_by_id_[id]])
                         : std::nullopt;
  if (!exact) {
    return fail(ErrorKind::kDevice,
                fmt::format("the device '{}' answers triangle {}, which the ray does not meet",
                            device_->name(), id));
  }
  const HitKey key{hit_quotient(*exact), id};
  if (key < work.best[place]) {
    work.best[place] = key;
    work.hits[place] = hit;
  }
  return {};
}

}  // namespace gridrt
