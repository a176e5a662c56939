/// The truth for the hardware's exact test, by another road than the hardware's: signed volumes of
/// four points instead of Moeller and Trumbore's products, in 128-bit integers.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

namespace gridrt::rtl {

__extension__ using Wide = __int128;
using Point = std::array<std::int64_t, 3>;
using Corners = std::array<Point, 3>;

/// Six times the signed volume of a tetrahedron; coordinates in [0, 2^17).
inline Wide volume(const Point& a, const Point& b, const Point& c, const Point& d) {
  std::array<std::array<Wide, 3>, 3> m{};
  for (std::size_t i = 0; i < 3; ++i) {
    m[0][i] = b[i] - a[i];
    m[1][i] = c[i] - a[i];
    m[2][i] = d[i] - a[i];
  }
  return m[0][0] * m[1][1] * m[2][2] + m[0][1] * m[1][2] * m[2][0] + m[0][2] * m[1][0] * m[2][1] -
         m[0][2] * m[1][1] * m[2][0] - m[0][1] * m[1][0] * m[2][2] - m[0][0] * m[1][2] * m[2][1];
}

struct Verdict {
  bool hit = false;
  std::uint64_t tn = 0;   ///< magnitude, of a hit
  std::uint64_t det = 0;  ///< magnitude, of a hit; the segment is met at tn / det of its length
};

/// Two-sided and closed: the ends lie on different sides of the plane (or one in it), and the line
/// passes all three edges on the same side (or through them).
inline Verdict judge(const Point& p0, const Point& p1, const Corners& v) {
  const Wide start = volume(v[0], v[1], v[2], p0);
  const Wide end = volume(v[0], v[1], v[2], p1);
  if (start == end) return {};  // parallel to the plane, or there is no plane
  if ((start > 0 && end > 0) || (start < 0 && end < 0)) return {};
  const std::array<Wide, 3> side = {volume(p0, p1, v[0], v[1]), volume(p0, p1, v[1], v[2]),
                                    volume(p0, p1, v[2], v[0])};
  const auto [least, most] = std::minmax_element(side.begin(), side.end());
  if (*least < 0 && *most > 0) return {};
  const Wide det = start - end;
  return {true, static_cast<std::uint64_t>(start < 0 ? -start : start),
          static_cast<std::uint64_t>(det < 0 ? -det : det)};
}

/// floor(2^24 tn / det)
inline std::uint32_t exact_quotient(std::uint64_t tn, std::uint64_t det) {
  return static_cast<std::uint32_t>((Wide{tn} << 24) / Wide{det});
}

/// floor(((q + 1) length - 1) / 2^24): the largest whole n with floor(2^24 n / length) <= q.
inline std::uint32_t exact_limit(std::uint32_t quotient, std::uint32_t length) {
  return static_cast<std::uint32_t>(((Wide{quotient} + 1) * length - 1) >> 24);
}

}  // namespace gridrt::rtl
