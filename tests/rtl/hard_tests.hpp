/// Segments and triangles that are hard on a test: degenerate, grazing, through edges and corners,
/// at the ends of segments, at the corners of the lattice box.
#pragma once

#include <cstdint>
#include <optional>
#include <random>

#include "tests/rtl/exact_test.hpp"

namespace gridrt::rtl {

struct Case {
  Point p0{};
  Point p1{};
  Corners v{};
};

class HardTests {
 public:
  /// Coordinates take `bits` bits.
  HardTests(int bits, unsigned seed) : most_((std::int64_t{1} << bits) - 1), random_(seed) {}

  /// Any of the kinds below.
  Case next() {
    switch (random_() % 8) {
      case 0:
        return anywhere(0, most_);
      case 1:  // so small that all special positions are common
        return within(1 + static_cast<std::int64_t>(random_() % 5));
      case 2:
        return within(1 + static_cast<std::int64_t>(random_() % 1000));
      case 3:
        return corners_and_neighbours();
      case 4:
        return flat();
      default:
        return aimed();
    }
  }

  /// Two triangles that share an edge and one segment, through a point of the edge if it can be.
  std::array<Case, 2> neighbours() {
    Case first = aimed();
    Case second = first;
    second.v = {first.v[1], first.v[0], any_point(0, most_)};
    return {first, second};
  }

  std::int64_t number(std::int64_t least, std::int64_t most) {
    return std::uniform_int_distribution<std::int64_t>(least, most)(random_);
  }
  Point any_point(std::int64_t least, std::int64_t most) {
    return {number(least, most), number(least, most), number(least, most)};
  }
  std::mt19937& random() { return random_; }

 private:
  Case anywhere(std::int64_t least, std::int64_t most) {
    return {any_point(least, most),
            any_point(least, most),
            {any_point(least, most), any_point(least, most), any_point(least, most)}};
  }

  Case within(std::int64_t size) {
    const std::int64_t low = number(0, most_ - size);
    return anywhere(low, low + size);
  }

  Case corners_and_neighbours() {
    Case c = anywhere(-2, 1);
    const auto wrap = [&](Point& p) {
      for (std::int64_t& x : p) x = x < 0 ? most_ + 1 + x : x;
    };
    wrap(c.p0);
    wrap(c.p1);
    for (Point& p : c.v) wrap(p);
    return c;
  }

  // Everything in one plane, or a triangle without area.
  Case flat() {
    Case c = random_() % 2 == 0 ? anywhere(0, most_) : within(20);
    const std::size_t axis = random_() % 3;
    switch (random_() % 4) {
      case 0:
        c.v[1] = c.v[0];
        break;
      case 1:  // collinear
        for (std::size_t i = 0; i < 3; ++i) {
          c.v[1][i] -= (c.v[1][i] - c.v[0][i]) % 2;
          c.v[2][i] = (c.v[0][i] + c.v[1][i]) / 2;
        }
        break;
      case 2:  // in a plane along an axis, the segment in it or not
        for (Point& p : c.v) p[axis] = c.v[0][axis];
        if (random_() % 2 == 0) c.p0[axis] = c.v[0][axis];
        if (random_() % 2 == 0) c.p1[axis] = c.v[0][axis];
        break;
      default:
        c.p1 = c.p0;
        if (random_() % 2 == 0) c.p1[axis] = number(0, most_);
        break;
    }
    return c;
  }

  // Through a lattice point of the triangle: a corner, an edge, its inside, or a step beside it.
  Case aimed() {
    while (true) {
      Case c = random_() % 2 == 0 ? anywhere(0, most_) : within(60);
      const std::int64_t parts = number(1, 6);
      for (std::size_t corner = 1; corner < 3; ++corner) {
        for (std::size_t i = 0; i < 3; ++i) {
          c.v[corner][i] -= (c.v[corner][i] - c.v[0][i]) % parts;
        }
      }
      const std::int64_t first = number(0, parts);
      const std::int64_t second = random_() % 2 == 0 ? parts - first : number(0, parts - first);
      Point through = c.v[0];
      for (std::size_t i = 0; i < 3; ++i) {
        through[i] +=
            ((c.v[1][i] - c.v[0][i]) / parts) * first + ((c.v[2][i] - c.v[0][i]) / parts) * second;
      }
      if (random_() % 4 == 0) through[random_() % 3] += random_() % 2 == 0 ? 1 : -1;
      if (const auto ends = line_through(through)) {
        c.p0 = ends->first;
        c.p1 = ends->second;
        return c;
      }
    }
  }

  std::optional<std::pair<Point, Point>> line_through(const Point& point) {
    const std::int64_t reach = random_() % 2 == 0 ? 3 : most_ / 4;
    const Point step = any_point(-reach, reach);
    const std::int64_t back = number(0, 3);  // 0: starts on the triangle
    const std::int64_t ahead = number(0, 3);
    std::pair<Point, Point> ends{point, point};
    for (std::size_t i = 0; i < 3; ++i) {
      ends.first[i] -= back * step[i];
      ends.second[i] += ahead * step[i];
      if (std::min(ends.first[i], ends.second[i]) < 0) return std::nullopt;
      if (std::max(ends.first[i], ends.second[i]) > most_) return std::nullopt;
    }
    return ends;
  }

  std::int64_t most_;
  std::mt19937 random_;
};

}  // namespace gridrt::rtl
