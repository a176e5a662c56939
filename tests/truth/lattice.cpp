#include "tests/truth/lattice.hpp"

#include <algorithm>

namespace gridrt::truth {
namespace {

/// The largest k with extent 2^k <= limit, by trying one after the other; extent > 0.
int largest_shift(const Rational& extent, const Rational& limit) {
  int k = 0;
  while (extent * power_of_two(k + 1) <= limit) ++k;
  while (extent * power_of_two(k) > limit) --k;
  return k;
}

}  // namespace

SnappedScene snap_scene(const Scene& scene, int bits) {
  SnappedScene out;
  Lattice& lattice = out.lattice;
  lattice.bits = bits;
  if (scene.triangles.empty()) return out;

  std::array<int, 3> shift{};
  std::array<bool, 3> flat{};
  const Rational limit = power_of_two(bits) - 5;
  for (int i = 0; i < 3; ++i) {
    const auto axis = static_cast<std::size_t>(i);
    float lo = scene.positions[scene.triangles[0][0]][i];
    float hi = lo;
    for (const auto& triangle : scene.triangles) {
      for (const auto index : triangle) {
        lo = std::min(lo, scene.positions[index][i]);
        hi = std::max(hi, scene.positions[index][i]);
      }
    }
    lattice.lo[axis] = Rational(lo);
    lattice.hi[axis] = Rational(hi);
    flat[axis] = lo == hi;
    if (!flat[axis]) shift[axis] = largest_shift(lattice.hi[axis] - lattice.lo[axis], limit);
  }
  // A flat axis takes the largest shift of the others; with none, 0.
  bool any = false;
  int largest = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (flat[axis]) continue;
    largest = any ? std::max(largest, shift[axis]) : shift[axis];
    any = true;
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    lattice.shift[axis] = flat[axis] ? largest : shift[axis];
    lattice.step[axis] = power_of_two(lattice.shift[axis]);
  }

  Point top{2, 2, 2};
  const auto snapped = [&](std::uint32_t index) {
    Point p{};
    for (int i = 0; i < 3; ++i) {
      const auto axis = static_cast<std::size_t>(i);
      const Integer q = nearest(lattice.place(i, Rational(scene.positions[index][i])));
      p[axis] = static_cast<std::int32_t>(q.get_si());
      top[axis] = std::max(top[axis], p[axis]);
    }
    return p;
  };
  out.triangles.reserve(scene.triangles.size());
  for (const auto& t : scene.triangles) {
    out.triangles.push_back({snapped(t[0]), snapped(t[1]), snapped(t[2])});
  }
  for (std::size_t axis = 0; axis < 3; ++axis) lattice.far[axis] = top[axis] + 2;
  return out;
}

}  // namespace gridrt::truth
