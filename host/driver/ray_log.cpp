#include "host/driver/ray_log.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdlib>
#include <map>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "host/grid/traversal.hpp"
#include "host/image/triangles.hpp"
#include "host/pe/traversal_memory.hpp"

namespace gridrt {
namespace {

using Kind = ExplainEvent::Kind;
using protocol::SectionKind;

/// What bits 31 to 28 of a word say.
enum class Word : std::uint32_t {
  kStep = 1,
  kTask = 2,
  kTaskMore = 3,
  kTest = 4,
  kDrop = 5,
  kDropAhead = 6,
  kHit = 7,
  kHitMore = 8,
  kInterrupt = 9,
  kCommit = 10,
};

std::uint32_t bits(std::uint32_t word, unsigned high, unsigned low) {
  return (word >> low) & ((1U << (high - low + 1U)) - 1U);
}

std::span<const std::byte> bytes_of(const Image& image, SectionKind kind) {
  const ImageSection* section = image.find(kind);
  return section == nullptr ? std::span<const std::byte>{} : std::span(section->bytes);
}

/// Looks up in the image what the log names by its place in a memory.
class Names {
 public:
  static Result<Names> make(const Image& image, const Segment& segment) {
    Names names;
    Result<std::vector<std::uint32_t>> ids = decode_ids(image);
    if (!ids) return std::unexpected(std::move(ids.error()));
    names.global_ids_ = std::move(*ids);
    for (int pe = 0; pe < image.header.pes; ++pe) {
      Result<PeTriangles> triangles = decode_pe_triangles(image, pe);
      if (!triangles) return std::unexpected(std::move(triangles.error()));
      names.local_ids_.push_back(std::move(triangles->ids));
    }
    const VoxelGrid grid = image.grid();
    names.blocks_ = (grid.count + 1) / 2;
    const Accepted<TraversalMemory> memory = TraversalMemory::decode(
        image.header, bytes_of(image, SectionKind::kBlocks), bytes_of(image, SectionKind::kCells));
    if (!memory) {
      return fail(ErrorKind::kInput,
                  fmt::format("the image is not valid: {}", protocol::name(memory.error().code)));
    }
    traverse(
        grid, segment.p0, segment.p1, [](const glm::ivec3&, int) { return 0; },
        [&](const VoxelVisit& visit) {
          const Cell* cell = memory->find(visit.voxel);
          if (cell != nullptr) names.visits_.emplace(std::pair(cell->pe, cell->first), visit);
          return true;
        });
    // The board looks at a few voxels that the segment only comes close to.
    const int axis = SlabMarch(grid, segment.p0, segment.p1).direction() / 2;
    names.length_ = std::abs(segment.p1[axis] - segment.p0[axis]);
    for (int z = 0; z < grid.count.z; ++z) {
      for (int y = 0; y < grid.count.y; ++y) {
        for (int x = 0; x < grid.count.x; ++x) {
          const Cell* cell = memory->find({x, y, z});
          if (cell != nullptr)
            names.voxels_.emplace(std::pair(cell->pe, cell->first), glm::ivec3{x, y, z});
        }
      }
    }
    return names;
  }

  /// The voxel whose references begin there, with the segment's part in it; for one that it does
  /// not meet, the point where it enters the voxel's slab, so many lattice steps from its start.
  [[nodiscard]] std::optional<VoxelVisit> voxel(std::uint32_t pe, std::uint32_t first,
                                                std::uint32_t steps) const {
    const auto met = visits_.find({pe, first});
    if (met != visits_.end()) return met->second;
    const auto found = voxels_.find({pe, first});
    if (found == voxels_.end() || steps > static_cast<std::uint32_t>(length_)) return std::nullopt;
    const Fraction enter{steps, length_};
    return VoxelVisit{found->second, enter, enter};
  }
  [[nodiscard]] std::optional<std::uint32_t> triangle(std::uint32_t pe, std::uint32_t index) const {
    if (pe >= local_ids_.size() || index >= local_ids_[pe].size()) return std::nullopt;
    return global(local_ids_[pe][index]);
  }
  [[nodiscard]] std::optional<std::uint32_t> global(std::uint32_t local) const {
    if (local >= global_ids_.size()) return std::nullopt;
    return global_ids_[local];
  }
  [[nodiscard]] glm::ivec3 block(std::uint32_t index) const {
    const int i = static_cast<int>(index);
    return {i % blocks_.x, i / blocks_.x % blocks_.y, i / (blocks_.x * blocks_.y)};
  }

 private:
  std::vector<std::uint32_t> global_ids_;
  std::vector<std::vector<std::uint32_t>> local_ids_;  ///< by PE and index in its memory
  glm::ivec3 blocks_{1};
  int length_ = 1;  ///< of the segment, along its dominant axis
  using Place = std::pair<std::uint32_t, std::uint32_t>;  ///< PE and `first`
  std::map<Place, VoxelVisit> visits_;                    ///< voxels that the segment meets
  std::map<Place, glm::ivec3> voxels_;                    ///< all of them
};

class Translator {
 public:
  explicit Translator(const Names& names) : names_(names) {}

  /// Takes a word (and, where it needs one, the next); false for one that makes no sense.
  bool take(std::uint32_t word, std::uint32_t next) {
    switch (static_cast<Word>(word >> 28U)) {
      case Word::kStep:
        return step(word);
      case Word::kTask:
        return task(word, next);
      case Word::kTaskMore:
      case Word::kHitMore:
        return true;  // with the word before it
      case Word::kTest:
        return test(word);
      case Word::kDrop:
        add({.kind = bits(word, 2, 2) != 0 ? Kind::kCancelled : Kind::kDone,
             .pe = static_cast<int>(bits(word, 1, 0))});
        return true;
      case Word::kDropAhead:
        add({.kind = Kind::kCancelled});
        return true;
      case Word::kHit:
        return hit(word, next);
      case Word::kInterrupt:
        add({.kind = Kind::kLimit, .enter = bits(word, 17, 0)});
        return true;
      case Word::kCommit:
        return commit(word);
    }
    return false;
  }

  std::vector<ExplainEvent> events;

 private:
  void add(const ExplainEvent& event) { events.push_back(event); }

  bool step(std::uint32_t word) {
    add({.kind = Kind::kStep,
         .voxel = names_.block(bits(word, 11, 0)),
         .count = static_cast<std::uint32_t>(std::popcount(bits(word, 19, 12))),
         .jump = bits(word, 27, 20)});
    return true;
  }
  bool task(std::uint32_t word, std::uint32_t next) {
    const std::uint32_t pe = bits(word, 1, 0);
    if (next >> 28U != static_cast<std::uint32_t>(Word::kTaskMore)) return false;
    const std::optional<VoxelVisit> visit = names_.voxel(pe, bits(word, 15, 2), bits(next, 25, 8));
    if (!visit) return false;
    add({.kind = Kind::kVoxel,
         .voxel = visit->voxel,
         .pe = static_cast<int>(pe),
         .enter = visit->enter.quotient(),
         .leave = visit->leave.quotient(),
         .count = bits(word, 25, 16)});
    return true;
  }
  bool test(std::uint32_t word) {
    const std::uint32_t pe = bits(word, 1, 0);
    const auto id = names_.triangle(pe, bits(word, 13, 2));
    if (!id) return false;
    add({.kind = bits(word, 14, 14) != 0 ? Kind::kMeet : Kind::kTest,
         .pe = static_cast<int>(pe),
         .id = *id});
    return true;
  }
  bool hit(std::uint32_t word, std::uint32_t next) {
    const auto id = names_.global(bits(next, 19, 0));
    if (!id || next >> 28U != static_cast<std::uint32_t>(Word::kHitMore)) return false;
    quotients_[*id] = bits(word, 24, 0);
    add({.kind = Kind::kFeedback, .id = *id, .quotient = bits(word, 24, 0)});
    return true;
  }
  bool commit(std::uint32_t word) {
    ExplainEvent event{.kind = Kind::kCommit};
    if (bits(word, 20, 20) != 0) {
      const auto id = names_.global(bits(word, 19, 0));
      if (!id) return false;
      event.id = *id;
      const auto known = quotients_.find(*id);
      if (known != quotients_.end()) event.quotient = known->second;
    }
    add(event);
    return true;
  }

  const Names& names_;
  std::map<std::uint32_t, std::uint32_t> quotients_;  ///< by global id
};

}  // namespace

Result<std::vector<ExplainEvent>> read_ray_log(const Image& image, const Segment& segment,
                                               std::span<const std::uint32_t> words, bool lost) {
  const Result<Names> names = Names::make(image, segment);
  if (!names) return std::unexpected(names.error());
  Translator translator(*names);
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (!translator.take(words[i], i + 1 < words.size() ? words[i + 1] : 0) && !lost) {
      return fail(ErrorKind::kProtocol,
                  fmt::format("the device's event log says {:#010x}, which means nothing for this "
                              "ray",
                              words[i]),
                  "this is a defect of the device");
    }
  }
  if (lost) translator.events.push_back({.kind = Kind::kLost});
  return std::move(translator.events);
}

}  // namespace gridrt
