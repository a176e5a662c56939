#include "tests/truth/volumes.hpp"

namespace gridrt::truth {
namespace {

template <class T>
using Vector = std::array<T, 3>;

template <class T>
Vector<T> minus(const Point& x, const Point& y) {
  return {static_cast<T>(x[0]) - y[0], static_cast<T>(x[1]) - y[1], static_cast<T>(x[2]) - y[2]};
}

/// Six times the signed volume spanned by x, y, z: at most 6 m^3 in size for entries up to m.
template <class T>
T volume(const Vector<T>& x, const Vector<T>& y, const Vector<T>& z) {
  return x[0] * (y[1] * z[2] - y[2] * z[1]) + x[1] * (y[2] * z[0] - y[0] * z[2]) +
         x[2] * (y[0] * z[1] - y[1] * z[0]);
}

/// All of them >= 0 or all <= 0.
template <class T>
bool agree(T x, T y, T z) {
  return (x >= 0 && y >= 0 && z >= 0) || (x <= 0 && y <= 0 && z <= 0);
}

template <class T>
std::optional<Meeting> meet_in(const Point& p0, const Point& p1, const Triangle& triangle) {
  // Tetrahedra of the segment with each edge: the line passes inside if none disagrees.
  const auto d = minus<T>(p1, p0);
  const auto a = minus<T>(triangle.a, p0);
  const auto b = minus<T>(triangle.b, p0);
  const auto c = minus<T>(triangle.c, p0);
  const T bc = volume<T>(d, b, c);
  const T ca = volume<T>(d, c, a);
  const T ab = volume<T>(d, a, b);
  if (!agree<T>(bc, ca, ab)) return std::nullopt;
  // Tetrahedra of the triangle with each end point: they must lie on different sides of its plane,
  // or one of them (not both) in it.
  const T start = volume<T>(a, b, c);
  const T end =
      volume<T>(minus<T>(triangle.a, p1), minus<T>(triangle.b, p1), minus<T>(triangle.c, p1));
  if ((start > 0 && end > 0) || (start < 0 && end < 0) || (start == 0 && end == 0)) {
    return std::nullopt;
  }
  const auto size = [](T x) -> Wide { return x < 0 ? -x : x; };
  return Meeting{size(start), size(end), size(bc), size(ca), size(ab)};
}

bool small(const Point& p) {
  constexpr std::int32_t kLimit = 1 << 20;  // 6 (2^20)^3 < 2^63
  return p[0] >= 0 && p[1] >= 0 && p[2] >= 0 && p[0] <= kLimit && p[1] <= kLimit && p[2] <= kLimit;
}

}  // namespace

std::optional<Meeting> meet(const Point& p0, const Point& p1, const Triangle& triangle) {
  if (small(p0) && small(p1) && small(triangle.a) && small(triangle.b) && small(triangle.c)) {
    return meet_in<std::int64_t>(p0, p1, triangle);
  }
  return meet_in<Wide>(p0, p1, triangle);
}

std::array<Wide, 3> normal_of(const Triangle& triangle) {
  const auto x = minus<Wide>(triangle.b, triangle.a);
  const auto y = minus<Wide>(triangle.c, triangle.a);
  return {x[1] * y[2] - x[2] * y[1], x[2] * y[0] - x[0] * y[2], x[0] * y[1] - x[1] * y[0]};
}

}  // namespace gridrt::truth
