// Inside host/grid: the two ways of cutting a ray to the lattice box.
#pragma once

#include "host/grid/segment.hpp"

namespace gridrt::detail {

/// The part of a ray within the closed lattice box, end points rounded to nearest.
struct Cut {
  enum class Outcome {
    kUndecided,  ///< the filter's error bound does not decide
    kMiss,       ///< nothing is left of the ray
    kCut,
  };
  Outcome outcome = Outcome::kUndecided;
  glm::ivec3 p0{0};
  glm::ivec3 p1{0};
  double t0 = 0.0;
  double t1 = 0.0;
};

/// In double-double with a running error bound; may be undecided.
Cut cut_filtered(const Lattice& lattice, const Ray& ray);

/// In rational arithmetic; always decided. A parameter beyond the range of double is reported as
/// the largest double.
Cut cut_exact(const Lattice& lattice, const Ray& ray);

/// The filter, and the rationals where it does not decide.
Cut cut(const Lattice& lattice, const Ray& ray);

}  // namespace gridrt::detail
