// The schedule rays on vectors: the answers of the plain one from every kind that this machine has.
#include <algorithm>
#include <bit>

#include <gtest/gtest.h>

#include "host/driver/device.hpp"
#include "host/pe/empty_space.hpp"
#include "host/pe/ray_candidate.hpp"
#include "host/pe/ray_stream.hpp"
#include "tests/adversarial/meshes.hpp"
#include "tests/unit/pe_fixture.hpp"

namespace gridrt {
namespace {

std::vector<Hit> answers(const Image& image, std::span<const Segment> segments, Query query,
                         std::string_view simd, int threads) {
  DeviceOptions options;
  options.name = "omp";
  options.simd = simd;
  options.threads = threads;
  std::vector<Hit> hits(segments.size());
  auto device = open_device(options);
  EXPECT_TRUE(device && (*device)->load(image));
  EXPECT_TRUE((*device)->trace(segments, query, hits));
  return hits;
}

std::size_t differences(std::span<const Hit> a, std::span<const Hit> b) {
  const auto bits = [](double x) { return std::bit_cast<std::uint64_t>(x); };
  std::size_t n = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    n += a[i].id != b[i].id || bits(a[i].t) != bits(b[i].t) || bits(a[i].u) != bits(b[i].u) ||
                 bits(a[i].v) != bits(b[i].v)
             ? 1
             : 0;
  }
  return n;
}

std::vector<Image> images(int bits) {
  adversarial::Random random(5);
  ImageOptions options;
  options.bits = bits;
  options.with_scene = false;
  std::vector<Image> out;
  for (const Scene& scene :
       {load_scene("builtin:teapots").value(), adversarial::lattice_soup(400, 8, random),
        adversarial::soup(900, 6.0, random), adversarial::slivers(300, 1e5, random),
        adversarial::sheet(20, 0.3, random), adversarial::box(3, {-1, -1, -1}, {1, 2, 3})}) {
    out.push_back(build_image(scene, options).value());
  }
  return out;
}

/// Through or up to corners of triangles, where what floats tell of a side is as good as a guess.
std::vector<Segment> aimed_segments(const Image& image, int n, std::uint64_t seed) {
  const std::vector<LatticeTriangle> triangles = decode_triangles(image)->triangles;
  const glm::ivec3 box = image.lattice().box();
  fixture::Random random(seed);
  std::vector<Segment> out(static_cast<std::size_t>(n));
  for (Segment& s : out) {
    const auto which = static_cast<std::size_t>(random.below(static_cast<int>(triangles.size())));
    const glm::ivec3 corner = triangles[which].v[random.below(3)];
    s.t1 = 1.0;
    s.p1 = corner;
    glm::ivec3 beyond{0};
    for (int a = 0; a < 3; ++a) {
      s.p0[a] = random.below(box[a] + 1);
      beyond[a] = 2 * corner[a] - s.p0[a];
    }
    const auto within = [&](int a) { return beyond[a] >= 0 && beyond[a] <= box[a]; };
    if (within(0) && within(1) && within(2)) s.p1 = beyond;
  }
  return out;
}

TEST(Stream, EveryKindOfVectorsAnswersLikeThePlainSchedule) {
  std::size_t hits = 0;
  for (const int bits : {8, 17, 20, 24}) {
    for (const Image& image : images(bits)) {
      auto segments = fixture::random_segments(image, 2000, 11);
      const auto aimed = aimed_segments(image, 1000, 13);
      segments.insert(segments.end(), aimed.begin(), aimed.end());
      for (const Query query : {Query::kClosestHit, Query::kAnyHit}) {
        const auto expected = answers(image, segments, query, "plain", 1);
        hits += static_cast<std::size_t>(
            std::ranges::count_if(expected, [](const Hit& hit) { return hit.id >= 0; }));
        for (const StreamKernel& kernel : stream_kernels()) {
          for (const int threads : {1, 3}) {
            const auto got = answers(image, segments, query, kernel.name, threads);
            EXPECT_EQ(differences(got, expected), 0U)
                << kernel.name << ", " << bits << " bits, " << threads << " threads";
          }
        }
      }
    }
  }
  EXPECT_GT(hits, 10000U);
}

/// Strips of neighbouring rays that go the same way: fans and parallel bundles from every side,
/// some of them along axes and faces of voxels, dense and sparse, some ignoring a triangle.
std::vector<Segment> bundles(const Image& image, int n, std::uint64_t seed) {
  fixture::Random random(seed);
  const glm::ivec3 box = image.lattice().box();
  const VoxelGrid grid = image.grid();
  std::vector<Segment> out;
  while (static_cast<int>(out.size()) < n) {
    const int axis = random.below(3);
    const bool back = random.below(2) == 1;
    Segment first;
    first.t1 = 1.0;
    for (int a = 0; a < 3; ++a) {
      first.p0[a] = random.below(box[a] + 1);
      first.p1[a] = random.below(3) == 0 ? first.p0[a] : random.below(box[a] + 1);
      if (random.below(4) == 0) first.p0[a] = first.p0[a] / grid.edge[a] * grid.edge[a];
    }
    first.p0[axis] = back ? box[axis] - random.below(9) : random.below(9);
    first.p1[axis] =
        back ? random.below(box[axis] / 2 + 1) : box[axis] - random.below(box[axis] / 2 + 1);
    const int side = (axis + 1 + random.below(2)) % 3;
    const int steps = 1 + random.below(std::max(1, grid.edge[side] / 4));
    const int spread = random.below(3) == 0 ? 0 : random.below(steps + 1);
    if (random.below(4) == 0) first.ignore = static_cast<std::uint32_t>(random.below(40));
    for (int i = 0; i < 64; ++i) {
      Segment s = first;
      s.p0[side] = std::clamp(s.p0[side] + i * spread, 0, box[side]);
      s.p1[side] = std::clamp(s.p1[side] + i * steps, 0, box[side]);
      out.push_back(s);
    }
  }
  return out;
}

TEST(Stream, RaysThatGoTogetherAreAnsweredLikeRaysAlone) {
  std::size_t hits = 0;
  for (const int bits : {8, 17, 24}) {
    for (const Image& image : images(bits)) {
      const auto segments = bundles(image, 8000, 12);
      for (const Query query : {Query::kClosestHit, Query::kAnyHit}) {
        const auto expected = answers(image, segments, query, "plain", 1);
        hits += static_cast<std::size_t>(
            std::ranges::count_if(expected, [](const Hit& hit) { return hit.id >= 0; }));
        for (const StreamKernel& kernel : stream_kernels()) {
          const auto got = answers(image, segments, query, kernel.name, 1);
          EXPECT_EQ(differences(got, expected), 0U) << kernel.name << ", " << bits << " bits";
        }
      }
    }
  }
  EXPECT_GT(hits, 30000U);
}

TEST(Stream, KindsAreTheWidestFirstAndTheBaselineLast) {
  const auto kernels = stream_kernels();
  ASSERT_FALSE(kernels.empty());
  EXPECT_TRUE(std::ranges::is_sorted(kernels, std::ranges::greater{}, &StreamKernel::lanes));
  EXPECT_EQ(kernels.back().name, "baseline");
  EXPECT_EQ(stream_kernel("")->name, kernels.front().name);
  EXPECT_FALSE(stream_kernel("mmx"));
  DeviceOptions options;
  options.name = "omp";
  options.simd = "mmx";
  const auto device = open_device(options);
  ASSERT_FALSE(device);
  EXPECT_EQ(device.error().kind, ErrorKind::kUsage);
}

TEST(Stream, QuotientsAreTheExactOnes) {
  fixture::Random random(3);
  for (int i = 0; i < 200000; ++i) {
    const auto det = static_cast<std::int64_t>(random.next() >> (10 + random.below(53))) + 1;
    auto tn = static_cast<std::int64_t>(random.next() % static_cast<std::uint64_t>(det + 1));
    if (i % 4 == 0) {  // next to a multiple of det / 2^24, where the estimate may be off
      const auto q = static_cast<Int128>(random.below(1 << 24));
      tn = std::clamp<std::int64_t>(static_cast<std::int64_t>((q * det) >> 24) + random.below(2), 0,
                                    det);
    }
    EXPECT_EQ(quotient_narrow(tn, det), hit_quotient({det, 0, 0, tn}));
  }
}

TEST(Stream, EmptySpaceIsTheDistanceToTheNearestVoxelWithTriangles) {
  fixture::Random random(4);
  for (int round = 0; round < 40; ++round) {
    const glm::ivec3 size{1 + random.below(9), 1 + random.below(9), 1 + random.below(9)};
    std::vector<std::int32_t> codes(static_cast<std::size_t>(size.x * size.y * size.z), -1);
    std::vector<glm::ivec3> full;
    const auto at = [&](int x, int y, int z) -> std::int32_t& {
      return codes[static_cast<std::size_t>((z * size.y + y) * size.x + x)];
    };
    for (int i = random.below(4); i > 0; --i) {
      full.emplace_back(random.below(size.x), random.below(size.y), random.below(size.z));
      at(full.back().x, full.back().y, full.back().z) = i;
    }
    measure_empty_space(size, codes);
    for (int z = 0; z < size.z; ++z) {
      for (int y = 0; y < size.y; ++y) {
        for (int x = 0; x < size.x; ++x) {
          int nearest = kFarthest;
          for (const glm::ivec3& f : full) {
            nearest = std::min(nearest,
                               std::max({std::abs(f.x - x), std::abs(f.y - y), std::abs(f.z - z)}));
          }
          EXPECT_EQ(std::min(at(x, y, z), 0), -nearest);
        }
      }
    }
  }
}

}  // namespace
}  // namespace gridrt
