/// What a processing element must answer: a random image, rays, and the events of a task.
#pragma once

#include <array>
#include <cstdint>
#include <cstdlib>
#include <random>
#include <vector>

#include "gridrt_protocol.hpp"
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
  unsigned octants = 63;  ///< code, as in protocol.toml
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
/// the more degenerate tests. `sparse` is how many references of ten touch some octants only.
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
      const unsigned octants =
          random() % 10 < sparse ? random() % (random() % 2 == 0 ? 8U : 64U) : 63U;
      references.push_back({random() % static_cast<unsigned>(sizes.triangles), octants});
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

/// The tests of a task, in order: the triangle, what the test says, and the event of a hit that
/// counts (no hit: nothing found, or the triangle that the ray ignores).
struct PeTest {
  std::uint32_t triangle = 0;
  bool hit = false;
  Event event;
};

/// The order in which a list is read: four references a clock, those with even indices first.
inline std::vector<int> order_of(const Task& task) {
  std::vector<int> order;
  const bool odd = task.first % 2 != 0;
  for (int row = 0; row < task.count; row += 4) {
    for (const int i : odd ? std::array{1, 3, 0, 2} : std::array{0, 2, 1, 3}) {
      if (row + i < task.count) order.push_back(row + i);
    }
  }
  return order;
}

inline std::vector<PeTest> tests_of(const PeImage& image, const PeRay& ray, const Task& task) {
  std::vector<PeTest> tests;
  for (const int i : order_of(task)) {
    const Reference& r =
        image.references[static_cast<std::size_t>(task.first) + static_cast<std::size_t>(i)];
    if ((protocol::kOctantSets[r.octants] & task.octants) == 0) continue;
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
