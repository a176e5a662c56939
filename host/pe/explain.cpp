#include "host/pe/explain.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "host/pe/engine.hpp"

namespace gridrt {
namespace {

using protocol::SectionKind;

class Recorder final : public EngineObserver {
 public:
  Recorder(std::vector<ExplainEvent>& events, const std::vector<std::uint32_t>& global_ids)
      : events_(events), global_ids_(global_ids) {}

  void on_voxel(const VoxelVisit& visit, const Cell* cell) override {
    ExplainEvent event = at(ExplainEvent::Kind::kVoxel, visit);
    if (cell != nullptr) {
      event.pe = static_cast<int>(cell->pe);
      event.count = cell->count;
    }
    pe_ = event.pe;
    events_.push_back(event);
  }
  void on_masked(std::uint32_t local_id) override {
    ExplainEvent event;
    event.kind = ExplainEvent::Kind::kMasked;
    event.pe = pe_;
    event.id = global_ids_[local_id];
    events_.push_back(event);
  }
  void on_test(std::uint32_t local_id, const std::optional<HitKey>& hit) override {
    ExplainEvent event;
    event.kind = hit ? ExplainEvent::Kind::kHit : ExplainEvent::Kind::kTest;
    event.pe = pe_;
    event.id = global_ids_[local_id];
    if (hit) event.quotient = hit->quotient;
    events_.push_back(event);
  }
  void on_cancel(const VoxelVisit& visit, const HitKey& best) override {
    ExplainEvent event = at(ExplainEvent::Kind::kCancel, visit);
    event.id = global_ids_[best.id];
    event.quotient = best.quotient;
    events_.push_back(event);
  }

 private:
  static ExplainEvent at(ExplainEvent::Kind kind, const VoxelVisit& visit) {
    ExplainEvent event;
    event.kind = kind;
    event.voxel = visit.voxel;
    event.enter = visit.enter.quotient();
    event.leave = visit.leave.quotient();
    return event;
  }

  std::vector<ExplainEvent>& events_;
  const std::vector<std::uint32_t>& global_ids_;
  int pe_ = -1;  // that owns the voxel at hand
};

std::span<const std::byte> bytes_of(const Image& image, SectionKind kind, int pe = 0) {
  const ImageSection* section = image.find(kind, pe);
  return section == nullptr ? std::span<const std::byte>{} : std::span(section->bytes);
}

Accepted<Engine> make_engine(const Image& image) {
  Accepted<TraversalMemory> traversal = TraversalMemory::decode(
      image.header, bytes_of(image, SectionKind::kBlocks), bytes_of(image, SectionKind::kCells));
  if (!traversal) return std::unexpected(traversal.error());
  std::vector<std::optional<Pe>> pes;
  for (std::uint8_t p = 0; p < image.header.pes; ++p) {
    Accepted<Pe> pe = Pe::decode(image.header, p, bytes_of(image, SectionKind::kReferences, p),
                                 bytes_of(image, SectionKind::kTriangles, p),
                                 bytes_of(image, SectionKind::kVertices, p));
    if (!pe) return std::unexpected(pe.error());
    pes.emplace_back(std::move(*pe));
  }
  return Engine::assemble(std::move(*traversal), std::move(pes));
}

}  // namespace

Result<std::vector<ExplainEvent>> explain(const Image& image, const Segment& segment) {
  const Result<ImageTriangles> triangles = decode_triangles(image);
  if (!triangles) return std::unexpected(triangles.error());
  const Accepted<Engine> engine = make_engine(image);
  if (!engine) {
    return fail(ErrorKind::kInput,
                fmt::format("the image is not valid: {}", protocol::name(engine.error().code)));
  }
  std::vector<ExplainEvent> events;
  ExplainEvent commit;
  commit.kind = ExplainEvent::Kind::kCommit;
  if (!segment.is_miss()) {
    const std::vector<std::uint32_t>& ids = triangles->global_ids;
    PeRay ray{segment.p0, segment.p1, kNoTriangle};
    const auto ignored = std::ranges::lower_bound(ids, segment.ignore);
    if (ignored != ids.end() && *ignored == segment.ignore) {
      ray.ignore = static_cast<std::uint32_t>(ignored - ids.begin());
    }
    Recorder recorder(events, ids);
    PeCounters counters;
    const PeAnswer answer = engine->closest_hit(ray, counters, &recorder);
    if (answer) {
      commit.id = ids[answer->id];
      commit.quotient = answer->quotient;
    }
  }
  events.push_back(commit);
  return events;
}

std::string describe(const std::vector<ExplainEvent>& events) {
  std::string text;
  auto out = std::back_inserter(text);
  for (const ExplainEvent& e : events) {
    switch (e.kind) {
      case ExplainEvent::Kind::kVoxel:
        if (e.pe < 0) {
          fmt::format_to(out, "voxel {},{},{}  entry {} exit {}  empty\n", e.voxel.x, e.voxel.y,
                         e.voxel.z, e.enter, e.leave);
        } else {
          fmt::format_to(out, "voxel {},{},{}  entry {} exit {}  PE {}  references {}\n", e.voxel.x,
                         e.voxel.y, e.voxel.z, e.enter, e.leave, e.pe, e.count);
        }
        break;
      case ExplainEvent::Kind::kMasked:
        fmt::format_to(out, "  masked    PE {}  triangle {}\n", e.pe, e.id);
        break;
      case ExplainEvent::Kind::kTest:
        fmt::format_to(out, "  test      PE {}  triangle {}  no hit\n", e.pe, e.id);
        break;
      case ExplainEvent::Kind::kHit:
        fmt::format_to(out, "  test      PE {}  triangle {}  hit, key {}\n", e.pe, e.id,
                       e.quotient);
        break;
      case ExplainEvent::Kind::kCancel:
        fmt::format_to(out,
                       "interrupt   triangle {} at key {} cancels voxel {},{},{} (entry {}) and "
                       "all later ones\n",
                       e.id, e.quotient, e.voxel.x, e.voxel.y, e.voxel.z, e.enter);
        break;
      case ExplainEvent::Kind::kCommit:
        if (e.id == kNoTriangle) {
          fmt::format_to(out, "commit      miss\n");
        } else {
          fmt::format_to(out, "commit      triangle {}, key {}\n", e.id, e.quotient);
        }
        break;
      case ExplainEvent::Kind::kStep:
        fmt::format_to(out, "step        block {},{},{}: {} voxels to test, then {} blocks ahead\n",
                       e.voxel.x, e.voxel.y, e.voxel.z, e.count, e.jump);
        break;
      case ExplainEvent::Kind::kMeet:
        fmt::format_to(out, "  test      PE {}  triangle {}  hit\n", e.pe, e.id);
        break;
      case ExplainEvent::Kind::kFeedback:
        fmt::format_to(out, "feedback    triangle {}, key {}\n", e.id, e.quotient);
        break;
      case ExplainEvent::Kind::kLimit:
        fmt::format_to(out,
                       "interrupt   cancels voxels entered beyond {} lattice steps of the dominant "
                       "axis\n",
                       e.enter);
        break;
      case ExplainEvent::Kind::kDone:
        fmt::format_to(out, "  through   PE {}  a voxel without a hit\n", e.pe);
        break;
      case ExplainEvent::Kind::kCancelled:
        if (e.pe < 0) {
          fmt::format_to(out, "  cancelled a voxel on its way to a PE\n");
        } else {
          fmt::format_to(out, "  cancelled PE {}  a voxel\n", e.pe);
        }
        break;
      case ExplainEvent::Kind::kLost:
        fmt::format_to(out, "the log was full: steps are missing\n");
        break;
    }
  }
  return text;
}

}  // namespace gridrt
