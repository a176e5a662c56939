// The frustum of a packet of rays, and which voxels and triangles it holds. Compiled for each kind
// of vectors.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

#include <glm/common.hpp>

#include "host/pe/ray_lanes.hpp"
#include "host/pe/slab_area.hpp"

#if defined(GRIDRT_RAY_FRUSTUM_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef GRIDRT_RAY_FRUSTUM_INL
#undef GRIDRT_RAY_FRUSTUM_INL
#else
#define GRIDRT_RAY_FRUSTUM_INL
#endif

#include <hwy/highway.h>

#include "host/pe/ray_filter-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace gridrt {
namespace HWY_NAMESPACE {

/// Along axis c (and its direction) from z = start to z = end: at z, coordinates along a and b lie
/// in at + rate (z - start), for lower and upper bounds, give or take the slack. Lattice steps.
class Frustum {
 public:
  explicit Frustum(const RayLayout& layout)
      : layout_(layout), slack_(0x1p-18F * static_cast<float>(layout.box())) {}

  /// Takes as many rays as a vector has lanes; false if they do not go the same way.
  bool bound(const BatchRay* rays) {
    const std::size_t lanes = hn::Lanes(Floats{});
    if (lanes < 4 || !alike(rays[0].ray, rays[lanes - 1].ray)) return false;
    choose_axis(rays[0].ray);
    // A ray is eight integers: both ends, and two more.
    const Floats f;
    const Integers n;
    static_assert(sizeof(BatchRay) == 8 * sizeof(std::int32_t) && offsetof(PeRay, p1) == 12);
    const auto* const numbers = reinterpret_cast<const std::int32_t*>(rays);
    const auto place = hn::ShiftLeft<3>(hn::Iota(n, 0));
    for (std::size_t i = 0; i < 3; ++i) {
      const auto p0 = hn::GatherIndex(n, numbers + i, place);
      const auto p1 = hn::GatherIndex(n, numbers + 3 + i, place);
      hn::Store(hn::ConvertTo(f, p0), f, origins_.data() + i * lanes);
      hn::Store(hn::ConvertTo(f, hn::Sub(p1, p0)), f, directions_.data() + i * lanes);
    }
    const Vector along =
        hn::Mul(hn::Load(f, directions_.data() + static_cast<std::size_t>(axis_) * lanes),
                hn::Set(f, static_cast<float>(way_)));
    const bool same_way = hn::AllTrue(f, hn::Gt(along, hn::Zero(f)));
    return same_way && bound_sides();
  }

  /// Voxels; rays farther apart, or that move more in a slab, go alone.
  static constexpr int kMostAcross = 4;
  static constexpr float kMostDrift = 2.0F;
  /// Of an area.
  static constexpr int kMostWide = kMostAcross + 8;
  static constexpr std::size_t kMostVoxels = kMostWide * kMostWide;

  /// Slabs are counted from the one in which the first ray starts, the way that the rays go.
  [[nodiscard]] int slabs() const { return slabs_; }
  [[nodiscard]] const float* origins() const { return origins_.data(); }
  [[nodiscard]] const float* directions() const { return directions_.data(); }
  [[nodiscard]] std::ptrdiff_t stride_a() const { return layout_.stride()[axis_a()]; }
  [[nodiscard]] std::ptrdiff_t stride_b() const { return layout_.stride()[axis_b()]; }
  /// Number of the border voxel from which a slab's rows are counted.
  [[nodiscard]] std::ptrdiff_t slab_number(int slab) const {
    return static_cast<std::ptrdiff_t>(first_slab_ + way_ * slab + 1) * layout_.stride()[axis_];
  }

  /// False if every ray ends before the slab: its end is at limits[lane] of its length.
  [[nodiscard]] bool reaches(int slab, const float* limits) const {
    const Floats f;
    const std::size_t row = static_cast<std::size_t>(axis_) * hn::Lanes(f);
    const Vector end = hn::MulAdd(hn::Load(f, directions_.data() + row), hn::Load(f, limits),
                                  hn::Load(f, origins_.data() + row));
    const float plane = first_plane_ + static_cast<float>(way_ * slab) * pitch_;
    const Vector beyond = hn::Sub(end, hn::Set(f, plane));
    return !hn::AllFalse(
        f, way_ > 0 ? hn::Ge(beyond, hn::Set(f, -slack_)) : hn::Le(beyond, hn::Set(f, slack_)));
  }

  /// The voxels of a slab that the rays may be in.
  [[nodiscard]] SlabArea area(int slab) const {
    const hn::CappedTag<float, 4> f;
    const hn::RebindToSigned<decltype(f)> n;
    alignas(16) std::array<std::int32_t, 4> x{};
    const auto s = hn::Set(f, static_cast<float>(slab));
    const auto bound = hn::MulAdd(hn::Load(f, area_rate_.data()), s, hn::Load(f, area_at_.data()));
    const auto within = hn::Min(hn::Max(bound, hn::Zero(f)), hn::Load(f, area_most_.data()));
    hn::Store(hn::Sub(hn::ConvertTo(n, within), hn::Set(n, 1)), n, x.data());
    const glm::ivec3& count = layout_.count();
    return {std::max(x[0], 0), std::min(x[1], count[axis_a()] - 1), std::max(x[2], 0),
            std::min(x[3], count[axis_b()] - 1)};
  }

  /// How many slabs from this one on are surely empty where the rays are; 0 if this one may not be.
  [[nodiscard]] int empty_slabs(const SlabArea& area, int slab) const {
    const int a = (area.lo_a + area.hi_a) / 2;
    const int b = (area.lo_b + area.hi_b) / 2;
    const std::int32_t code =
        layout_.codes()[slab_number(slab) + (a + 1) * stride_a() + (b + 1) * stride_b()];
    // All voxels nearer than `reach` are empty.
    const int reach = -code;
    const int half = std::max(area.hi_a - a, area.hi_b - b);
    if (reach <= half) return 0;
    // n slabs on, the area has moved by less than n drift + 1 voxels.
    return 1 + std::max(0, static_cast<int>(static_cast<float>(reach - 2 - half) * per_drift_));
  }

  /// What holds() needs of the voxels of a slab.
  [[nodiscard]] std::array<float, 4> offsets(int slab) const {
    const float z = static_cast<float>((first_slab_ + way_ * slab) * layout_.edge()[axis_] -
                                       layout_.boxes().margin()) -
                    start_;
    std::array<float, 4> out{};
    for (std::size_t i = 0; i < 4; ++i) out[i] = against_at_[i] + against_rate_[i] * z;
    return out;
  }

  /// Of a group of `count` boxes of voxel (a, b) of a slab those that do not lie beside the
  /// frustum, a bit each.
  [[nodiscard]] HWY_INLINE unsigned holds(const std::array<float, 4>& offsets, int a, int b,
                                          const std::uint8_t* group, std::size_t count) const {
    const Floats f;
    const std::size_t row = TriangleBoxes::row_bytes(count);
    const int margin = layout_.boxes().margin();
    const auto base_a = static_cast<float>(a * layout_.edge()[axis_a()] - margin);
    const auto base_b = static_cast<float>(b * layout_.edge()[axis_b()] - margin);
    // How far inside each side the box reaches.
    const auto inside = [&](std::size_t side, float base) {
      const Vector x = bytes(group + x_row_[side] * row);
      const Vector z = bytes(group + z_row_[side] * row);
      return hn::MulAdd(z, hn::Set(f, z_unit_[side]),
                        hn::MulAdd(x, hn::Set(f, x_unit_[side]), hn::Set(f, offsets[side] + base)));
    };
    const Vector in_a = hn::Min(inside(0, base_a), inside(1, -base_a));
    const Vector in_b = hn::Min(inside(2, base_b), inside(3, -base_b));
    return mask_bits(hn::Ge(hn::Min(in_a, in_b), hn::Zero(f))) & ((1U << count) - 1U);
  }

 private:
  struct Side {
    float at = 0.0F;
    float rate = 0.0F;
  };

  static HWY_INLINE Vector bytes(const std::uint8_t* from) {
    const hn::Rebind<std::uint8_t, Floats> small;
    const hn::RebindToSigned<Floats> wide;
    return hn::ConvertTo(Floats{}, hn::PromoteTo(wide, hn::LoadU(small, from)));
  }

  [[nodiscard]] int axis_a() const { return axis_ == 0 ? 1 : 0; }
  [[nodiscard]] int axis_b() const { return axis_ == 2 ? 1 : 2; }

  [[nodiscard]] int slab_of(float z) const {
    return std::min(static_cast<int>(z) / layout_.edge()[axis_], layout_.count()[axis_] - 1);
  }

  /// False if they are too wide. Bounds of area(), in voxels and one more, that are linear in the
  /// slab: each side where it is widest within a slab.
  bool bound_areas() {
    pitch_ = static_cast<float>(layout_.edge()[axis_]);
    first_slab_ = slab_of(start_);
    slabs_ = (slab_of(end_) - first_slab_) * way_ + 1;
    first_plane_ = static_cast<float>(first_slab_ + (way_ > 0 ? 0 : 1)) * pitch_;
    const float step = pitch_ * static_cast<float>(way_);
    const auto put = [&](std::size_t i, const Side& side, int axis, bool lower) {
      const float per = 1.0F / static_cast<float>(layout_.edge()[axis]);
      const float drift = side.rate * step;
      const float in = side.at + side.rate * (first_plane_ - start_);
      const float widest =
          lower ? std::min(in, in + drift) - slack_ : std::max(in, in + drift) + slack_;
      area_at_[i] = widest * per + 1.0F;
      area_rate_[i] = drift * per;
      area_most_[i] = static_cast<float>(layout_.count()[axis] + 1);
      // A box is inside as far as x - rate z reaches in it, or its opposite, for upper sides.
      const float sign = lower ? 1.0F : -1.0F;
      const glm::vec3& unit = layout_.boxes().unit();
      x_row_[i] = static_cast<std::size_t>(axis) + (lower ? 3 : 0);
      z_row_[i] = static_cast<std::size_t>(axis_) + ((side.rate > 0.0F) == lower ? 0 : 3);
      x_unit_[i] = sign * unit[axis];
      z_unit_[i] = -sign * side.rate * unit[axis_];
      against_rate_[i] = -sign * side.rate;
      against_at_[i] = slack_ - sign * side.at;
    };
    put(0, lo_a_, axis_a(), true);
    put(1, hi_a_, axis_a(), false);
    put(2, lo_b_, axis_b(), true);
    put(3, hi_b_, axis_b(), false);
    const auto width = [&](std::size_t lower, int slab) {
      const auto x = static_cast<float>(slab);
      return (area_at_[lower + 1] + area_rate_[lower + 1] * x) -
             (area_at_[lower] + area_rate_[lower] * x);
    };
    const float widest = std::max({width(0, 0), width(0, slabs_), width(2, 0), width(2, slabs_)});
    return widest <= static_cast<float>(kMostWide - 2);
  }

  /// A cheap look at two rays before more is done: neither parallel nor equal, but similar.
  [[nodiscard]] bool alike(const PeRay& first, const PeRay& last) const {
    const glm::ivec3 d0 = first.p1 - first.p0;
    const glm::ivec3 d1 = last.p1 - last.p0;
    const glm::ivec3 far = glm::abs(first.p1 - last.p1);
    const glm::ivec3 near = glm::abs(first.p0 - last.p0);
    const auto close = [&](const glm::ivec3& x) {
      int wide = 0;  // axes along which they are apart; one may be that along which they go
      for (int i = 0; i < 3; ++i) wide += x[i] > kMostAcross * layout_.edge()[i] ? 1 : 0;
      return wide <= 1;
    };
    return d0.x * std::int64_t{d1.x} + d0.y * std::int64_t{d1.y} + d0.z * std::int64_t{d1.z} > 0 &&
           close(far) && close(near);
  }

  void choose_axis(const PeRay& ray) {
    const glm::ivec3 d = ray.p1 - ray.p0;
    const glm::vec3 size = glm::vec3{glm::abs(d)} / glm::vec3{layout_.edge()};
    axis_ = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    way_ = d[axis_] > 0 ? 1 : -1;
  }

  bool bound_sides() {
    const Floats f;
    const std::size_t n = hn::Lanes(f);
    const auto row = [&](const Rows& rows, int axis) {
      return hn::Load(f, rows.data() + static_cast<std::size_t>(axis) * n);
    };
    const auto least = [&](const Vector& x) { return hn::GetLane(hn::MinOfLanes(f, x)); };
    const auto most = [&](const Vector& x) { return hn::GetLane(hn::MaxOfLanes(f, x)); };
    const Vector way = hn::Set(f, static_cast<float>(way_));
    const Vector z0 = row(origins_, axis_);
    const Vector dz = row(directions_, axis_);
    const Vector z1 = hn::Mul(hn::Add(z0, dz), way);
    start_ = least(hn::Mul(z0, way)) * static_cast<float>(way_);
    end_ = most(z1) * static_cast<float>(way_);
    const float length = end_ - start_;
    const Vector before = hn::Sub(hn::Set(f, start_), z0);
    const Vector behind = hn::Sub(hn::Set(f, end_), z0);
    const auto box = static_cast<float>(layout_.box());
    float drift = 0.0F;
    bool narrow = true;
    const auto side = [&](int axis, Side& lo, Side& hi) {
      const Vector x = row(origins_, axis);
      const Vector rate = hn::Div(row(directions_, axis), dz);
      const Vector near = hn::MulAdd(rate, before, x);
      const Vector far = hn::MulAdd(rate, behind, x);
      lo.at = least(near);
      hi.at = most(near);
      const float lo_end = least(far);
      const float hi_end = most(far);
      lo.rate = (lo_end - lo.at) / length;
      hi.rate = (hi_end - hi.at) / length;
      const auto edge = static_cast<float>(layout_.edge()[axis]);
      narrow &= std::min(lo.at, lo_end) >= -2.0F * box && std::max(hi.at, hi_end) <= 2.0F * box &&
                std::max(hi.at - lo.at, hi_end - lo_end) <= static_cast<float>(kMostAcross) * edge;
      const float steepest = std::max(std::abs(lo.rate), std::abs(hi.rate));
      narrow &= steepest <= 4.0F;
      drift = std::max(drift, steepest * static_cast<float>(layout_.edge()[axis_]) / edge);
    };
    side(axis_a(), lo_a_, hi_a_);
    side(axis_b(), lo_b_, hi_b_);
    narrow &= drift <= kMostDrift;
    per_drift_ = 0.999F / std::max(drift, 1.0F);
    return narrow && bound_areas();
  }

  using Rows = std::array<float, 3 * kMostLanes>;
  const RayLayout& layout_;
  float slack_;
  int axis_ = 2;
  int way_ = 1;
  float start_ = 0.0F;
  float end_ = 0.0F;
  Side lo_a_, hi_a_, lo_b_, hi_b_;
  int first_slab_ = 0;
  int slabs_ = 0;
  float first_plane_ = 0.0F;                    ///< where the rays enter the first slab
  float pitch_ = 1.0F;                          ///< from plane to plane
  alignas(16) std::array<float, 4> area_at_{};  ///< of the first slab: lower and upper a, then b
  alignas(16) std::array<float, 4> area_rate_{};
  alignas(16) std::array<float, 4> area_most_{};
  std::array<std::size_t, 4>
      x_row_{};  ///< of a group: the bounds that reach farthest inside a side
  std::array<std::size_t, 4> z_row_{};
  std::array<float, 4> x_unit_{};
  std::array<float, 4> z_unit_{};
  std::array<float, 4> against_rate_{};
  std::array<float, 4> against_at_{};
  float per_drift_ = 1.0F;  ///< slabs in which a side moves by a voxel, at most 1
  alignas(64) Rows origins_{};
  alignas(64) Rows directions_{};
};

}  // namespace HWY_NAMESPACE
}  // namespace gridrt
HWY_AFTER_NAMESPACE();

#endif
