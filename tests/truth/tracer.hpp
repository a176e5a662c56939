// What every device must answer, by brute force over all triangles in exact arithmetic.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "tests/truth/box_tree.hpp"
#include "tests/truth/lattice.hpp"
#include "tests/truth/segment.hpp"
#include "tests/truth/volumes.hpp"

namespace gridrt::truth {

/// The closest hit: smallest (quotient, id), and where it is.
struct Closest {
  std::int64_t id = kNone;
  std::uint32_t quotient = 0;
  Meeting meeting;
};

/// How candidates are found; the answers are the same.
enum class Search {
  kAll,     ///< every triangle
  kPruned,  ///< triangles of the boxes that the segment meets
};

/// A snapped scene that answers segments.
class Tracer {
 public:
  Tracer(const Scene& scene, int bits, Search search);

  [[nodiscard]] const Lattice& lattice() const { return scene_.lattice; }
  [[nodiscard]] const std::vector<Triangle>& triangles() const { return scene_.triangles; }

  /// The closest hit, or nothing for a miss.
  [[nodiscard]] std::optional<Closest> closest(const Segment& segment) const;

  /// Whether any triangle is hit.
  [[nodiscard]] bool any(const Segment& segment) const;

  /// Number of triangles that the segment meets.
  [[nodiscard]] std::size_t count(const Segment& segment) const;

 private:
  template <class Visit>
  void candidates(const Segment& segment, const Visit& visit) const;

  SnappedScene scene_;
  std::optional<BoxTree> tree_;
};

/// Checks reported numbers of a hit: t = t0 + before / (before + after) (t1 - t0), u and v the
/// weights of the second and third vertex, relative error <= 1e-12 each. Empty if right, else what
/// is wrong.
std::string check_parameters(const Segment& segment, const Meeting& meeting, double t, double u,
                             double v);

}  // namespace gridrt::truth
