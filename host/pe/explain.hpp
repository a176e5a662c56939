// The life of one ray, told in one form by every device that can (--explain).
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "hal/error.hpp"
#include "host/grid/segment.hpp"
#include "host/image/image.hpp"

namespace gridrt {

/// One step of a ray's life, in the order in which it happened. Software PEs test voxel after
/// voxel; on a board several work at a time, so lines name the PE, and what has been dropped is
/// said.
struct ExplainEvent {
  enum class Kind {
    kVoxel,   ///< a voxel is met: voxel, quotients of entry and exit, pe (-1: no references)
    kMasked,  ///< a reference is skipped by its quarters: pe, id
    kTest,    ///< an exact test without a hit: pe, id
    kHit,     ///< an exact test with a hit: pe, id, quotient
    kCancel,  ///< the voxel and all later ones are cancelled by the best hit: id, quotient
    kCommit,  ///< the answer: id and quotient, or id kNoTriangle for a miss
    // Of boards only:
    kStep,      ///< a block of 2x2x2 voxels is looked at: voxel (its place among the blocks), count
                ///< (voxels to test), jump (blocks moved ahead)
    kMeet,      ///< an exact test with a hit, of which the quotient is still to come: pe, id
    kFeedback,  ///< the quotient of a hit is there: id, quotient
    kLimit,     ///< an interrupt: voxels entered behind `enter` (lattice steps) are cancelled
    kDone,      ///< a PE is through with a voxel and has not met anything: pe
    kCancelled,  ///< a PE drops a voxel because of an interrupt: pe; -1: no PE has had it yet
    kLost,       ///< the log was full, steps are missing
  };
  Kind kind = Kind::kVoxel;
  glm::ivec3 voxel{0};
  int pe = -1;
  std::uint32_t enter = 0;         ///< floor(2^24 entry parameter)
  std::uint32_t leave = 0;         ///< floor(2^24 exit parameter)
  std::uint32_t count = 0;         ///< references in the voxel
  std::uint32_t jump = 0;          ///< of kStep
  std::uint32_t id = kNoTriangle;  ///< global triangle id
  std::uint32_t quotient = 0;      ///< of the key
};

/// Traces one segment through the software PEs of `image` and notes every step.
Result<std::vector<ExplainEvent>> explain(const Image& image, const Segment& segment);

/// The events as text, a line each.
std::string describe(const std::vector<ExplainEvent>& events);

}  // namespace gridrt
