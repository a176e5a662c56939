// Rays that go the same way together, one for each lane of a vector: slab by slab along one axis,
// all voxels that any of them may be in, each triangle there against all of them at once.
//
// Along the axis the rays lie within a frustum: four bounds that are linear in the coordinate along
// it. The smallest of linear functions is concave and the largest convex, so chords from one end to
// the other bound them. All bounds are wide by the frustum's slack (docs/numerics.md, section 7),
// so no voxel and no triangle of a hit is left out, and every hit is one of exact integers: answers
// are those of rays alone.
#include <array>
#include <bit>
#include <cstring>
#include <vector>

#include "host/pe/ray_candidate.hpp"
#include "host/pe/ray_lanes.hpp"

#if defined(GRIDRT_RAY_PACKET_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef GRIDRT_RAY_PACKET_INL
#undef GRIDRT_RAY_PACKET_INL
#else
#define GRIDRT_RAY_PACKET_INL
#endif

#include <hwy/highway.h>

#include "host/pe/ray_filter-inl.hpp"
#include "host/pe/ray_frustum-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace gridrt {
namespace HWY_NAMESPACE {

/// Rays of a packet and what has been found for each. What is best is known by the number of its
/// record and by bounds on its tn / det; integers are asked only where these do not decide.
class Packet {
 public:
  explicit Packet(const RayLayout& layout) : layout_(layout), frustum_(layout) {}

  /// Answers rays[i], as many as a vector has lanes, to answers[i]; false, and nothing done, if
  /// they do not go the same way.
  bool trace(const BatchRay* rays, PeAnswer* answers, PeCounters& counters) {
    const std::size_t lanes = hn::Lanes(Floats{});
    if (!frustum_.bound(rays)) return false;
    take(rays);
    walk(counters);
    counters.rays += lanes;
    for (std::size_t lane = 0; lane < lanes; ++lane) {
      answers[lane] = std::nullopt;
      if (best_[lane] == kNoPlace) continue;
      ++counters.interrupts;
      answers[lane] = HitKey{0, rays[lane].any_hit ? 0 : record(best_[lane]).id};
    }
    return true;
  }

 private:
  using Places = hn::RebindToUnsigned<Floats>;

  void take(const BatchRay* rays) {
    rays_ = rays;
    const Floats f;
    const std::size_t lanes = hn::Lanes(f);
    const Vector3 d = load_rows(frustum_.directions());
    const float length =
        hn::GetLane(hn::MaxOfLanes(f, hn::Add(hn::Add(hn::Abs(d.x), hn::Abs(d.y)), hn::Abs(d.z))));
    hn::Store(hn::Set(f, 1.0F), f, limit_.data());
    hn::Store(hn::Set(f, 2.0F), f, nearer_.data());
    best_.fill(kNoPlace);
    for (std::size_t lane = 0; lane < lanes; ++lane) {
      ignore_[lane] = rays[lane].ray.ignore;
      shortest_[lane] = rays[lane].any_hit ? -1.0F : 1.0F;
    }
    scale_ = 0x1p-20F * static_cast<float>(layout_.box()) * length;
    seen_.fill(kNoPlace);
  }

  /// Memory is far away, so each slab is looked up before the one ahead of it is worked on, and all
  /// records of a slab are asked for before the first is needed.
  void walk(PeCounters& counters) {
    Slab* ahead = slabs_.data();
    Slab* here = slabs_.data() + 1;
    int slab = look(0, *ahead);
    while (slab < frustum_.slabs() && frustum_.reaches(slab, limit_.data())) {
      std::swap(ahead, here);
      const int next = look(slab + 1, *ahead);
      ++counters.steps;
      const std::array<float, 4> offsets = frustum_.offsets(slab);
      for (std::size_t i = 0; i < here->count; ++i) find(here->voxels[i], offsets);
      test_found(counters);
      slab = next;
    }
  }

  struct Voxel {
    const std::uint32_t* head = nullptr;
    int a = 0;
    int b = 0;
  };
  struct Slab {
    std::size_t count = 0;
    std::array<Voxel, Frustum::kMostVoxels> voxels{};
  };

  /// The voxels with triangles in the next slab that has any where the rays are, from `slab` on.
  int look(int slab, Slab& out) {
    out.count = 0;
    while (slab < frustum_.slabs()) {
      const SlabArea area = frustum_.area(slab);
      const int empty = area.empty() ? 1 : frustum_.empty_slabs(area, slab);
      if (empty == 0) collect(area, slab, out);
      if (out.count > 0) return slab;
      slab += std::max(empty, 1);
    }
    return slab;
  }

  void collect(const SlabArea& area, int slab, Slab& out) {
    const std::int32_t* const codes = layout_.codes() + frustum_.slab_number(slab);
    for (int b = area.lo_b; b <= area.hi_b; ++b) {
      const std::int32_t* const row = codes + (b + 1) * frustum_.stride_b();
      for (int a = area.lo_a; a <= area.hi_a;) {
        const std::int32_t code = row[(a + 1) * frustum_.stride_a()];
        if (code < 0) {
          a -= code;
          continue;
        }
        const std::uint32_t* const head = layout_.boxes().voxel(static_cast<std::uint32_t>(code));
        hwy::Prefetch(head);
        hwy::Prefetch(head + 16);
        out.voxels[out.count++] = {head, a, b};
        ++a;
      }
    }
  }

  /// Notes the triangles of a voxel that the rays may meet and have not been tested against.
  void find(const Voxel& voxel, const std::array<float, 4>& offsets) {
    const std::size_t lanes = hn::Lanes(Floats{});
    const auto* group = reinterpret_cast<const std::uint8_t*>(voxel.head + TriangleBoxes::kHead);
    std::size_t count = 0;
    for (std::size_t rest = *voxel.head; rest > 0; rest -= count) {
      count = std::min(rest, lanes);
      const std::size_t row = TriangleBoxes::row_bytes(count);
      const std::uint8_t* const numbers = group + 6 * row;
      for (unsigned left = frustum_.holds(offsets, voxel.a, voxel.b, group, count); left != 0;
           left &= left - 1) {
        std::uint32_t number = 0;
        std::memcpy(&number, numbers + static_cast<std::size_t>(std::countr_zero(left)) * 4, 4);
        // Voxels share triangles, and one that all rays were tested against is done with.
        std::uint32_t& seen = seen_[number % kSeen];
        if (seen == number) continue;
        seen = number;
        hwy::Prefetch(&record(number));
        found_.push_back(number);
      }
      group = numbers + 4 * row;
    }
  }

  void test_found(PeCounters& counters) {
    counters.tests += found_.size() * hn::Lanes(Floats{});
    for (const std::uint32_t number : found_) test_triangle(number);
    found_.clear();
  }

  [[nodiscard]] const TriangleRecord& record(std::uint32_t number) const {
    return layout_.boxes().record(number);
  }

  /// A triangle with every ray.
  void test_triangle(std::uint32_t place) {
    const Floats tag;
    const TriangleRecord& triangle = record(place);
    const float e = scale_ * triangle.reach;
    const float f =
        2.0F * (e + 0x3p-20F * static_cast<float>(layout_.box()) * triangle.reach * triangle.reach);
    const auto set = [&](const float* x) {
      return Vector3{hn::Set(tag, x[0]), hn::Set(tag, x[1]), hn::Set(tag, x[2])};
    };
    const Vector3 p0 = load_rows(frustum_.origins());
    const Vector3 d = load_rows(frustum_.directions());
    const Vector3 v0 = set(triangle.numbers);
    const Vector3 t{hn::Sub(v0.x, p0.x), hn::Sub(v0.y, p0.y), hn::Sub(v0.z, p0.z)};
    const Vector3 normal = set(triangle.numbers + 9);
    const Test test = make_test(dot(d, normal), dot(t, normal), set(triangle.numbers + 3),
                                set(triangle.numbers + 6), cross(t, d));
    const Vector limit = hn::Load(tag, limit_.data());
    const auto may = possible(test, e, f, limit);
    if (hn::AllFalse(tag, may)) return;
    const Places places;
    const auto other = hn::Ne(hn::Load(places, ignore_.data()), hn::Set(places, triangle.id));
    const Vector nearer = hn::Load(tag, nearer_.data());
    const Vector one = hn::Set(tag, 1.0F);
    const Vector inverse = hn::Div(one, test.size);
    const Vector at = hn::Mul(test.tn, inverse);
    const Vector off = hn::MulAdd(hn::Set(tag, f), inverse, hn::Set(tag, 0x1p-23F));
    // Hit for sure, and with a smaller quotient than the best for sure.
    const auto sure = hn::And(certain(test, e, f), hn::RebindMask(tag, other));
    const auto better = hn::And(hn::And(may, sure), hn::Lt(hn::Add(at, off), nearer));
    const Vector most = hn::Min(hn::Add(at, off), hn::Load(tag, shortest_.data()));
    hn::Store(hn::IfThenElse(better, most, limit), tag, limit_.data());
    hn::Store(hn::IfThenElse(better, hn::Sub(at, off), nearer), tag, nearer_.data());
    hn::Store(hn::IfThenElse(hn::RebindMask(places, better), hn::Set(places, place),
                             hn::Load(places, best_.data())),
              places, best_.data());
    unsigned open = mask_bits(hn::AndNot(better, may));
    for (; open != 0; open &= open - 1) {
      decide(static_cast<std::size_t>(std::countr_zero(open)), place);
    }
  }

  [[nodiscard]] std::optional<HitKey> key(std::size_t lane, std::uint32_t place) const {
    const PeRay& ray = rays_[lane].ray;
    const std::optional<std::uint32_t> quotient = exact_quotient(
        layout_.narrow(), ray.p0, ray.p1 - ray.p0, triangle_of(record(place).numbers, 1));
    if (!quotient) return std::nullopt;
    return HitKey{*quotient, record(place).id};
  }

  /// By integers: whether the triangle at `place` is hit, and before the best.
  void decide(std::size_t lane, std::uint32_t place) {
    const std::uint32_t id = record(place).id;
    const std::uint32_t best = best_[lane];
    if (id == rays_[lane].ray.ignore) return;
    if (best != kNoPlace && record(best).id == id) return;
    const std::optional<HitKey> found = key(lane, place);
    if (!found) return;
    HitKey nearest = *found;
    if (best != kNoPlace) nearest = std::min(nearest, key(lane, best).value_or(nearest));
    if (nearest.id == id) best_[lane] = place;
    // Quotients up to this one, and strictly smaller ones.
    limit_[lane] = std::min(shortest_[lane], static_cast<float>(nearest.quotient + 1) * 0x1p-24F);
    nearer_[lane] = static_cast<float>(nearest.quotient) * 0x1p-24F;
  }

  static constexpr std::uint32_t kNoPlace = ~std::uint32_t{0};
  static constexpr std::size_t kSeen =
      64;  // triangles remembered, by the low bits of their numbers

  template <class T>
  using Row = std::array<T, kMostLanes>;
  const RayLayout& layout_;
  Frustum frustum_;
  const BatchRay* rays_ = nullptr;
  float scale_ = 0.0F;                 ///< `e` of a voxel whose reach is 1
  alignas(64) Row<float> limit_{};     ///< a hit that matters has tn <= limit * det
  alignas(64) Row<float> nearer_{};    ///< one with tn < nearer * det is before the best
  alignas(64) Row<float> shortest_{};  ///< limit after a hit: -1 for any-hit rays
  alignas(64) Row<std::uint32_t> best_{};
  alignas(64) Row<std::uint32_t> ignore_{};
  std::array<std::uint32_t, kSeen> seen_{};
  std::array<Slab, 2> slabs_;
  std::vector<std::uint32_t> found_;
};

}  // namespace HWY_NAMESPACE
}  // namespace gridrt
HWY_AFTER_NAMESPACE();

#endif
