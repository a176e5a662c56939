// The lattice of a scene by its definition, in rationals.
#pragma once

#include <array>
#include <vector>

#include "host/scene/scene.hpp"
#include "tests/truth/numbers.hpp"

namespace gridrt::truth {

/// A triangle on the lattice; its place in the vector is its id.
struct Triangle {
  Point a, b, c;
};

/// Where the lattice lies: coordinate i of a point x is 2 + (x_i - lo_i) step[i], step a power of
/// two, and the box is [0, far_i].
struct Lattice {
  int bits = 17;
  std::array<Rational, 3> lo;
  std::array<Rational, 3> hi;
  std::array<int, 3> shift{};  ///< step[i] = 2^shift[i]
  std::array<Rational, 3> step{1, 1, 1};
  Point far{4, 4, 4};  ///< 2 + the largest coordinate of any vertex in use

  /// Coordinate `axis` of x on the lattice, not rounded.
  [[nodiscard]] Rational place(int axis, const Rational& x) const {
    return 2 + (x - lo[static_cast<std::size_t>(axis)]) * step[static_cast<std::size_t>(axis)];
  }
};

/// The lattice and the snapped triangles, by id.
struct SnappedScene {
  Lattice lattice;
  std::vector<Triangle> triangles;
};

/// Snaps the vertices that triangles use; all indices must be in range, all vertices finite.
SnappedScene snap_scene(const Scene& scene, int bits);

}  // namespace gridrt::truth
