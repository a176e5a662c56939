/// What a processing element must answer: a random image, rays, and the events of a task.
#pragma once

#include <array>
#include <cstdint>
#include <cstdlib>
#include <random>
#include <vector>

#include "host/image/quarter_code.hpp"
#include "tests/rtl/exact_test.hpp"
#include "tests/rtl/pe_ports.hpp"

namespace gridrt::rtl {

/// The generator that all choices of a bench come from.
class Random {
 public:
  std::uint32_t operator()() { return static_cast<std::uint32_t>(engine_()); }

 private:
  std::mt19937 engine_{17};
};

struct Reference {
  std::uint32_t triangle = 0;
  unsigned quarters = 255;  ///< code, as in protocol.toml; 255: all
};

struct StoredTriangle {
  std::array<std::uint32_t, 3> vertex{};
  std::uint32_t id = 0;
};

struct PeRay {
  Point p0{};
  Point p1{};
  std::uint32_t length = 1;
  std::uint32_t ignore = kNoId;
  bool any = false;
};

struct PeSizes {
  int references = 0;
  int triangles = 0;
  int vertices = 0;
};

/// Random memories of a PE; `size` is the edge of the cube in which everything lies: the smaller,
/// the more degenerate tests. `sparse` is how many references of ten touch some quarters only.
class PeImage {
 public:
  PeImage(int bits, const PeSizes& sizes, std::int64_t size, unsigned sparse, Random& random)
      : size_(size) {
    const std::int64_t most = (std::int64_t{1} << bits) - 1;
    for (std::int64_t& low : low_) low = static_cast<std::int64_t>(random()) % (most - size + 1);
    for (int i = 0; i < sizes.vertices; ++i) vertices.push_back(point(random));
    for (int i = 0; i < sizes.triangles; ++i) {
      StoredTriangle t;
      for (std::uint32_t& v : t.vertex) v = random() % static_cast<unsigned>(sizes.vertices);
      t.id = random() % kNoId;
      triangles.push_back(t);
    }
    for (int i = 0; i < sizes.references; ++i) {
      const unsigned quarters = random() % 10 < sparse ? random() % 1024 : 255U;
      references.push_back({random() % static_cast<unsigned>(sizes.triangles), quarters});
    }
  }

  Point point(Random& random) const {
    Point p{};
    for (std::size_t i = 0; i < 3; ++i) {
      p[i] = low_[i] + static_cast<std::int64_t>(random() % static_cast<unsigned>(size_ + 1));
    }
    return p;
  }

  PeRay ray(Random& random) const {
    PeRay r;
    r.p0 = point(random);
    do {
      r.p1 = point(random);
    } while (r.p1 == r.p0);
    std::size_t axis = random() % 3;
    while (r.p1[axis] == r.p0[axis]) axis = (axis + 1) % 3;
    r.length = static_cast<std::uint32_t>(std::abs(r.p1[axis] - r.p0[axis]));
    if (random() % 2 == 0) r.ignore = triangles[random() % triangles.size()].id;
    r.any = random() % 4 == 0;
    return r;
  }

  [[nodiscard]] Corners corners(std::uint32_t triangle) const {
    const StoredTriangle& t = triangles[triangle];
    return {vertices[t.vertex[0]], vertices[t.vertex[1]], vertices[t.vertex[2]]};
  }

  std::vector<Reference> references;
  std::vector<StoredTriangle> triangles;
  std::vector<Point> vertices;

 private:
  std::int64_t size_;
  std::array<std::int64_t, 3> low_{};
};

/// Whether a reference's code and the cells of a ray (task_t) have a cell in common.
inline bool shares_a_cell(unsigned code, std::uint64_t cells) {
  const QuarterMasks quarters = quarters_of_code(code);
  const auto axis = static_cast<unsigned>(cells >> 32U);
  const auto mask = [&](unsigned a) { return (quarters >> (4 * (a % 3))) & 15U; };
  for (unsigned slab = 0; slab < 4; ++slab) {
    const auto b = static_cast<unsigned>(cells >> (16 + 4 * slab)) & 15U;
    const auto c = static_cast<unsigned>(cells >> (4 * slab)) & 15U;
    const bool here = ((mask(axis) >> slab) & 1U) != 0;
    if (here && (mask(axis + 1) & b) != 0 && (mask(axis + 2) & c) != 0) return true;
  }
  return false;
}

/// The tests of a task, in order: the triangle, what the test says, and the event of a hit that
/// counts (no hit: nothing found, or the triangle that the ray ignores).
struct PeTest {
  std::uint32_t triangle = 0;
  bool hit = false;
  Event event;
};

/// The order in which a list is read: eight references a clock, by the banks of the memory.
inline std::vector<int> order_of(const Task& task) {
  std::vector<int> order;
  for (int row = 0; row < task.count; row += 8) {
    for (int bank = 0; bank < 4; ++bank) {
      const int first = row + (bank - task.first % 4 + 4) % 4;
      for (const int i : {first, first + 4}) {
        if (i < task.count) order.push_back(i);
      }
    }
  }
  return order;
}

inline std::vector<PeTest> tests_of(const PeImage& image, const PeRay& ray, const Task& task) {
  std::vector<PeTest> tests;
  for (const int i : order_of(task)) {
    const Reference& r =
        image.references[static_cast<std::size_t>(task.first) + static_cast<std::size_t>(i)];
    if (!shares_a_cell(r.quarters, task.cells)) continue;
    const Verdict verdict = judge(ray.p0, ray.p1, image.corners(r.triangle));
    PeTest test{r.triangle, verdict.hit, {}};
    const std::uint32_t id = image.triangles[r.triangle].id;
    test.event.slot = task.slot;
    test.event.hit = verdict.hit && id != ray.ignore;
    if (test.event.hit && !ray.any) {
      test.event.quotient = exact_quotient(verdict.tn, verdict.det);
      test.event.id = id;
      test.event.limit = exact_limit(test.event.quotient, ray.length);
    }
    tests.push_back(test);
  }
  return tests;
}

/// The events of the first `count` tests, when the task ends with the last of them.
inline std::vector<Event> events_of(const std::vector<PeTest>& tests, std::size_t count) {
  std::vector<Event> events;
  for (std::size_t i = 0; i < count; ++i) {
    Event e = tests[i].event;
    e.last = i + 1 == count;
    if (e.hit || e.last) events.push_back(e);
  }
  return events;
}

}  // namespace gridrt::rtl
