#include "tests/truth/tracer.hpp"

#include <cstdio>
#include <tuple>

namespace gridrt::truth {

Tracer::Tracer(const Scene& scene, int bits, Search search) : scene_(snap_scene(scene, bits)) {
  if (search == Search::kPruned) tree_.emplace(scene_.triangles);
}

template <class Visit>
void Tracer::candidates(const Segment& segment, const Visit& visit) const {
  if (segment.miss()) return;
  const auto test = [&](std::uint32_t id) {
    if (static_cast<std::int64_t>(id) == segment.ignore) return;
    const auto meeting = meet(segment.p0, segment.p1, scene_.triangles[id]);
    if (meeting) visit(id, *meeting);
  };
  if (tree_) {
    tree_->each(segment.p0, segment.p1, test);
  } else {
    for (std::uint32_t id = 0; id < scene_.triangles.size(); ++id) test(id);
  }
}

std::optional<Closest> Tracer::closest(const Segment& segment) const {
  std::optional<Closest> best;
  candidates(segment, [&](std::uint32_t id, const Meeting& meeting) {
    const std::uint32_t quotient = meeting.quotient();
    const std::int64_t name = id;
    if (!best || std::tie(quotient, name) < std::tie(best->quotient, best->id)) {
      best = Closest{name, quotient, meeting};
    }
  });
  return best;
}

bool Tracer::any(const Segment& segment) const { return count(segment) > 0; }

std::size_t Tracer::count(const Segment& segment) const {
  std::size_t n = 0;
  candidates(segment, [&](std::uint32_t, const Meeting&) { ++n; });
  return n;
}

std::string check_parameters(const Segment& segment, const Meeting& meeting, double t, double u,
                             double v) {
  constexpr double kBound = 1e-12;
  const Rational total = rational(meeting.before + meeting.after);
  const Rational exact_t =
      segment.t0 + rational(meeting.before) / total * (segment.t1 - segment.t0);
  const auto check = [](const char* name, double reported, const Rational& exact) -> std::string {
    if (close(reported, exact, kBound)) return {};
    char text[160];
    std::snprintf(text, sizeof text, "%s is %.17g and should be about %.17g", name, reported,
                  exact.get_d());
    return text;
  };
  if (auto wrong = check("t", t, exact_t); !wrong.empty()) return wrong;
  if (auto wrong = check("u", u, rational(meeting.weight_b) / total); !wrong.empty()) return wrong;
  return check("v", v, rational(meeting.weight_c) / total);
}

}  // namespace gridrt::truth
