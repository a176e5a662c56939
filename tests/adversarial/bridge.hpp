// The engine's types in the truth's terms.
#pragma once

#include "host/grid/lattice.hpp"
#include "host/grid/segment.hpp"
#include "tests/truth/tracer.hpp"

namespace gridrt::adversarial {

inline truth::Point to_truth(const glm::ivec3& p) { return {p.x, p.y, p.z}; }
inline glm::ivec3 to_engine(const truth::Point& p) { return {p[0], p[1], p[2]}; }

inline truth::Ray to_truth(const Ray& ray) {
  return {{ray.origin.x, ray.origin.y, ray.origin.z},
          {ray.direction.x, ray.direction.y, ray.direction.z},
          ray.tmin,
          ray.tmax};
}

inline std::int64_t to_truth(std::uint32_t id) {
  return id == kNoTriangle ? truth::kNone : std::int64_t{id};
}

/// A segment given on the lattice, its parameters taken as they are.
inline truth::Segment to_truth(const Segment& segment) {
  truth::Segment out;
  out.meets_box = true;
  out.p0 = to_truth(segment.p0);
  out.p1 = to_truth(segment.p1);
  out.t0 = segment.t0;
  out.t1 = segment.t1;
  out.ignore = to_truth(segment.ignore);
  return out;
}

inline LatticeTriangle to_engine(const truth::Triangle& t) {
  return {{to_engine(t.a), to_engine(t.b), to_engine(t.c)}};
}

}  // namespace gridrt::adversarial
