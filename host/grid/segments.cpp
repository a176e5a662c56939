#include "host/grid/segments.hpp"

#include <array>
#include <cstdint>
#include <limits>

// Highway compiles what follows once for each kind of vectors.
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_AVX3_DL)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "host/grid/segments.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "host/grid/segments-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace gridrt::detail {
namespace HWY_NAMESPACE {

/// The filter needs products and sums that are rounded once, as std::fma does.
#if HWY_ARCH_X86
inline constexpr bool kFused = HWY_TARGET <= HWY_AVX2;
#else
inline constexpr bool kFused = false;
#endif

void put(const WideCut& cut, std::span<const Ray> rays, const Lattice& lattice,
         std::span<Segment> out) {
  const Doubles f;
  constexpr std::size_t kLanes = 8;  // at most
  using Row = std::array<double, kLanes>;
  alignas(64) std::array<Row, 8> rows{};
  for (std::size_t a = 0; a < 3; ++a) {
    hn::Store(cut.p0[a], f, rows[a].data());
    hn::Store(cut.p1[a], f, rows[3 + a].data());
  }
  hn::Store(cut.t0, f, rows[6].data());
  hn::Store(cut.t1, f, rows[7].data());
  alignas(64) Row open{};
  alignas(64) Row miss{};
  hn::Store(hn::IfThenElseZero(cut.open, all(1.0)), f, open.data());
  hn::Store(hn::IfThenElseZero(cut.miss, all(1.0)), f, miss.data());
  for (std::size_t i = 0; i < hn::Lanes(f); ++i) {
    if (open[i] != 0.0) {
      out[i] = make_segment(lattice, rays[i]);
    } else if (miss[i] != 0.0) {
      out[i] = {};
    } else {
      const auto whole = [&](std::size_t row) { return static_cast<int>(rows[row][i]); };
      out[i] = {{whole(0), whole(1), whole(2)},
                {whole(3), whole(4), whole(5)},
                rows[6][i],
                rows[7][i],
                kNoTriangle};
    }
  }
}

void make_all(const Lattice& lattice, std::span<const Ray> rays, std::span<Segment> segments) {
  std::size_t i = 0;
  if constexpr (kFused) {
    const std::size_t lanes = hn::Lanes(Doubles{});
    for (; i + lanes <= rays.size(); i += lanes) {
      put(cut_rays(lattice, &rays[i]), rays.subspan(i, lanes), lattice, segments.subspan(i, lanes));
    }
  }
  for (; i < rays.size(); ++i) segments[i] = make_segment(lattice, rays[i]);
}

}  // namespace HWY_NAMESPACE
}  // namespace gridrt::detail
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include "host/grid/vector_name.hpp"

namespace gridrt {
namespace detail {
namespace {
HWY_EXPORT(make_all);
}  // namespace
}  // namespace detail

std::vector<SegmentKernel> segment_kernels() {
  std::vector<SegmentKernel> kernels;
  // The best target has the lowest bit.
  for (std::int64_t left = hwy::SupportedTargets() & HWY_TARGETS; left != 0; left &= left - 1) {
    hwy::ChosenTarget target;
    target.Update(left & -left);
    kernels.push_back(
        {vector_name(left & -left), detail::HWY_DISPATCH_TABLE(make_all)[target.GetIndex()]});
  }
  return kernels;
}

void make_segments(const Lattice& lattice, std::span<const Ray> rays, std::span<Segment> segments) {
  static const SegmentKernel widest = segment_kernels().front();
  widest.make(lattice, rays, segments);
}

}  // namespace gridrt
#endif  // HWY_ONCE
