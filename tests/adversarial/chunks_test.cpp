// Case 36: scenes larger than a device's memories, cut into chunks; memories exactly full and one
// entry over; hits on the faces between chunks and in voxels that chunks share.
#include <algorithm>

#include "host/driver/chunked_device.hpp"
#include "host/driver/image_options.hpp"
#include "host/pe/capabilities.hpp"
#include "tests/adversarial/bridge.hpp"
#include "tests/adversarial/cases.hpp"

namespace gridrt::adversarial {
namespace {

/// Memories of a few dozen entries.
MemorySizes tiny_memory(Random& random) {
  MemorySizes m;
  const auto between = [&](int lo, int hi) {
    return static_cast<std::uint32_t>(random.between(lo, hi));
  };
  m.triangles = between(random.chance(0.1) ? 1 : 4, 40);
  m.vertices = between(3, 60);
  m.references = between(1, 80);
  m.cells = between(1, 60);
  m.blocks = between(1, 64);
  return m;
}

/// Segments that lie in a face of a chunk, end on one, or run through its edges and corners.
std::vector<Segment> face_segments(const SceneImages& images, std::size_t n, Random& random) {
  const glm::ivec3 box = images.front().lattice().box();
  const int margin = images.front().grid().margin;
  std::vector<Segment> out;
  for (std::size_t i = 0; i < n; ++i) {
    const Chunk& chunk = images.chunks[random.below(images.chunks.size())];
    Segment s;
    s.t1 = 1.0;
    for (int a = 0; a < 3; ++a) {
      s.p0[a] = random.between(0, box[a]);
      s.p1[a] = random.chance(0.2) ? s.p0[a] : random.between(0, box[a]);
    }
    const int axis = random.between(0, 2);
    const int kind = random.between(0, 3);
    for (int a = 0; a < 3; ++a) {
      const int face = random.chance(0.5) ? chunk.lo[a] + margin : chunk.hi[a] - margin;
      const int at = std::clamp(face, 0, box[a]);
      const bool chosen = kind == 3 || a == axis || (kind == 2 && a == (axis + 1) % 3);
      if (!chosen) continue;
      s.p0[a] = at;                 // starts on the face, edge or corner
      if (kind != 1) s.p1[a] = at;  // and stays in it
      if (kind == 3 && random.chance(0.7)) s.p1[a] = random.between(0, box[a]);
    }
    if (random.chance(0.5)) std::swap(s.p0, s.p1);
    out.push_back(s);
  }
  return out;
}

/// Some of the segments leave a triangle.
void ignore_some(std::vector<Segment>& segments, std::size_t triangles, Random& random) {
  for (Segment& s : segments) {
    if (random.chance(0.2)) s.ignore = static_cast<std::uint32_t>(random.below(triangles));
  }
}

Configuration tiny_configuration(Random& random, int bits) {
  Configuration c = random_configuration(random, bits);
  c.image.memory = tiny_memory(random);
  c.image.pes = random.between(1, 4);
  if (c.image.grid && random.chance(0.5)) c.image.grid.reset();
  return c;
}

TEST(Case36, RandomScenesInManyChunks) {
  Tally tally;
  Random random(36);
  std::size_t chunks = 0;
  std::size_t most = 0;
  for (int round = 0; round < 40; ++round) {
    const Scene scene = any_scene(random, 300).scene;
    const int bits = random.between(8, 17);
    with_bench(scene, tiny_configuration(random, bits), [&](const Bench& bench) {
      chunks += bench.images().chunks.size();
      most = std::max(most, bench.images().chunks.size());
      const auto rays = any_rays(scene, bench.truth().lattice(), bench.grid(), 150, random);
      auto segments = exact_segments(bench.truth(), 150, random);
      for (const Segment& s : face_segments(bench.images(), 150, random)) segments.push_back(s);
      ignore_some(segments, std::max<std::size_t>(1, scene.triangles.size()), random);
      bench.check_rays(rays, tally, segments);
    });
  }
  EXPECT_GT(chunks, 400U);
  EXPECT_GT(most, 50U);
  std::printf("case 36: %zu chunks, at most %zu of one scene\n", chunks, most);
  report("case 36, random scenes in many chunks", tally);
}

/// Triangles in and across the planes x, y, z = 0 ... steps of the unit lattice, so that chunk
/// faces of a grid of `steps` voxels are full of them.
Scene faces_scene(int steps, Random& random) {
  Scene scene = lattice_soup(250, steps, random);
  const auto f = [](int i) { return static_cast<float>(i); };
  for (int i = 0; i <= steps; ++i) {
    const float n = f(steps);
    add_triangle(scene, {f(i), 0, 0}, {f(i), n, 0}, {f(i), 0, n});
    add_triangle(scene, {0, f(i), 0}, {n, f(i), n}, {0, f(i), n});
    add_triangle(scene, {0, 0, f(i)}, {n, 0, f(i)}, {n, n, f(i)});
  }
  // All again, so that each hit has a rival of the same quotient and a higher id.
  const Scene once = scene;
  add_scene(scene, once);
  return scene;
}

TEST(Case36, HitsOnTheFacesBetweenChunks) {
  Tally tally;
  Random random(3636);
  for (int round = 0; round < 12; ++round) {
    const int steps = random.between(2, 6);
    const Scene scene = faces_scene(steps, random);
    Configuration c = tiny_configuration(random, random.between(8, 17));
    c.image.memory->blocks = 1000;
    c.image.memory->references = static_cast<std::uint32_t>(random.between(30, 200));
    c.image.memory->triangles = c.image.memory->vertices = 100;
    c.image.grid = glm::ivec3{steps};
    with_bench(scene, c, [&](const Bench& bench) {
      EXPECT_GT(bench.images().chunks.size(), 4U);
      auto segments = face_segments(bench.images(), 500, random);
      for (const Segment& s : exact_segments(bench.truth(), 500, random)) segments.push_back(s);
      ignore_some(segments, scene.triangles.size(), random);
      bench.check_segments(segments, tally);
    });
  }
  report("case 36, faces between chunks", tally);
}

TEST(Case36, OneVoxelSharedByManyChunks) {
  Tally tally;
  Random random(363);
  for (int round = 0; round < 10; ++round) {
    // A heap in a corner of a wide box: no grid that the memories allow divides it.
    Scene scene = lattice_soup(300, 3, random);
    add_scene(scene, Scene(scene));
    const float far = random.chance(0.5) ? 1000.0F : 50.0F;
    add_triangle(scene, {far, far, far}, {far, far - 1, far}, {far - 1, far, far});
    Configuration c = tiny_configuration(random, 17);
    c.image.memory->blocks = 8;
    c.image.memory->references = 37;
    with_bench(scene, c, [&](const Bench& bench) {
      EXPECT_GT(bench.images().chunks.size(), 4U);
      auto segments = exact_segments(bench.truth(), 600, random);
      ignore_some(segments, scene.triangles.size(), random);
      bench.check_segments(segments, tally);
    });
  }
  report("case 36, a voxel shared by chunks", tally);
}

// Where a voxel's list is shared, the chunks that hold its later pieces may answer first.
TEST(Case36, AnyOrderOfChunksGivesTheSameAnswers) {
  Tally tally;
  Random random(364);
  std::size_t starts = 0;
  for (int round = 0; round < 6; ++round) {
    Scene scene = lattice_soup(200, 3, random);
    add_scene(scene, Scene(scene));
    Configuration c = tiny_configuration(random, 17);
    c.image.memory =
        MemorySizes{.triangles = 30, .vertices = 60, .references = 30, .cells = 8, .blocks = 1};
    c.image.grid.reset();
    with_bench(scene, c, [&](const Bench& bench) {
      ASSERT_GT(bench.images().chunks.size(), 4U);
      const auto segments = exact_segments(bench.truth(), 800, random);
      const auto expected = bench.check_segments(segments, tally);
      auto images = std::make_shared<SceneImages>(bench.images());
      std::ranges::reverse(images->chunks);
      auto device = open_device(c.device);
      ASSERT_TRUE(device);
      const auto turned = load_images(std::move(*device), images);
      ASSERT_TRUE(turned) << turned.error().message;
      std::vector<Hit> hits(segments.size());
      ASSERT_TRUE((*turned)->trace(segments, Query::kClosestHit, hits));
      for (std::size_t i = 0; i < hits.size(); ++i) {
        ASSERT_EQ(hits[i].id, expected[i].id) << "segment " << i;
        starts += hits[i].id >= 0 && hits[i].t == segments[i].t0 ? 1 : 0;
      }
    });
  }
  EXPECT_GT(starts, 20U) << "too few rays start on a triangle";
  report("case 36, chunks in reverse", tally);
}

TEST(Case36, MoreTrianglesInAVoxelThanTheBoardCanName) {
  Tally tally;
  Random random(21);
  Scene scene = soup(3000, 2.0, random);
  add_triangle(scene, {5000, 5000, 5000}, {5000, 4999, 5000}, {4999, 5000, 5000});
  Configuration c = plain_configuration();
  if (asked_devices().empty()) c.device.name = "seq-board";
  c.image.layout = protocol::Layout::kCompact;
  with_bench(scene, c, [&](const Bench& bench) {
    EXPECT_GT(bench.images().chunks.size(), 1U);
    bench.check_segments(exact_segments(bench.truth(), 1000, random), tally);
  });
  report("case 36, 3000 triangles in one voxel", tally);
}

/// What a whole image needs, to the entry.
MemorySizes exact_sizes(const Image& image) {
  MemorySizes m;
  const glm::ivec3 blocks = (image.grid().count + 1) / 2;
  m.blocks = static_cast<std::uint32_t>(blocks.x * blocks.y * blocks.z);
  m.cells = image.header.occupied_cells;
  const auto counts = count_image(image);
  for (std::size_t pe = 0; pe + 1 < counts.size(); ++pe) {
    const auto grow = [](std::uint32_t& most, std::uint64_t n) {
      most = std::max(most, static_cast<std::uint32_t>(n));
    };
    grow(m.triangles, counts[pe].triangles);
    grow(m.vertices, counts[pe].vertices);
    grow(m.references, counts[pe].references);
  }
  return m;
}

TEST(Case36, ExactlyFullIsOneImageAndOneEntryOverIsChunksOrAClearError) {
  Tally tally;
  Random random(3600);
  using Sizes = MemorySizes;
  for (int round = 0; round < 8; ++round) {
    const Scene scene = soup(random.between(20, 200), 3.0, random);
    Configuration c = plain_configuration(17, glm::ivec3{5});
    c.image.pes = random.between(1, 4);
    const auto image = build_image(scene, c.image);
    ASSERT_TRUE(image);
    const Sizes exact = exact_sizes(*image);
    for (std::uint32_t Sizes::* const less :
         {static_cast<std::uint32_t Sizes::*>(nullptr), &Sizes::triangles, &Sizes::vertices,
          &Sizes::references, &Sizes::cells, &Sizes::blocks}) {
      c.image.memory = exact;
      if (less != nullptr) --((*c.image.memory).*less);
      const auto images = build_scene_images(scene, c.image);
      if (less == &Sizes::blocks) {  // the grid was asked for
        ASSERT_FALSE(images);
        EXPECT_EQ(images.error().kind, ErrorKind::kLimit);
        EXPECT_NE(images.error().message.find("27 blocks"), std::string::npos);
        EXPECT_FALSE(images.error().advice.empty());
        continue;
      }
      ASSERT_TRUE(images) << images.error().message;
      EXPECT_EQ(images->chunks.size() == 1, less == nullptr);
      with_bench(scene, c, [&](const Bench& bench) {
        bench.check_segments(exact_segments(bench.truth(), 100, random), tally);
      });
    }
  }
  report("case 36, exactly full and one over", tally);
}

/// Counts what a device is given to do.
class Watched final : public Device {
 public:
  Watched(std::unique_ptr<Device> inner, int& calls) : inner_(std::move(inner)), calls_(calls) {}
  Result<void> load(const Image& image) override {
    ++calls_;
    return inner_->load(image);
  }
  Result<void> trace(std::span<const Segment> segments, Query query, std::span<Hit> hits) override {
    ++calls_;
    return inner_->trace(segments, query, hits);
  }
  Result<DeviceCounters> counters() override { return inner_->counters(); }
  [[nodiscard]] std::string name() const override { return inner_->name(); }
  [[nodiscard]] const protocol::CapabilitiesReport& capabilities() const override {
    return inner_->capabilities();
  }

 private:
  std::unique_ptr<Device> inner_;
  int& calls_;
};

TEST(Case36, WhatCannotFitIsRefusedBeforeAnythingIsSent) {
  Random random(360);
  const Scene scene = soup(100, 3.0, random);
  ImageOptions options;
  options.with_scene = false;
  for (std::uint32_t MemorySizes::* const none :
       {&MemorySizes::triangles, &MemorySizes::vertices, &MemorySizes::references,
        &MemorySizes::cells, &MemorySizes::blocks}) {
    options.memory =
        MemorySizes{.triangles = 9, .vertices = 9, .references = 9, .cells = 9, .blocks = 9};
    ASSERT_TRUE(build_scene_images(scene, options));
    (*options.memory).*none = none == &MemorySizes::vertices ? 2 : 0;
    const auto refused = build_scene_images(scene, options);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().kind, ErrorKind::kLimit) << refused.error().message;
    EXPECT_NE(refused.error().message.find_first_of("0123456789"), std::string::npos)
        << refused.error().message;
    EXPECT_FALSE(refused.error().advice.empty());
  }
  // Chunks cut for a larger device than the one at hand.
  DeviceOptions small;
  small.name = "seq";
  small.capabilities = board_capabilities();
  small.capabilities->max_references = 20;
  options.memory =
      MemorySizes{.triangles = 30, .vertices = 90, .references = 21, .cells = 21, .blocks = 100};
  options.layout = protocol::Layout::kCompact;
  auto images = build_scene_images(scene, options);
  auto device = open_device(small);
  ASSERT_TRUE(images && device);
  ASSERT_GT(images->chunks.size(), 1U);
  int sent = 0;
  const auto loaded = load_images(std::make_unique<Watched>(std::move(*device), sent),
                                  std::make_shared<const SceneImages>(std::move(*images)));
  ASSERT_FALSE(loaded);
  EXPECT_EQ(loaded.error().kind, ErrorKind::kLimit);
  EXPECT_NE(loaded.error().message.find("references"), std::string::npos) << loaded.error().message;
  EXPECT_EQ(sent, 0);
}

TEST(Case36, AChunkIsLoadedOnceACallAndOnlyIfARayNeedsIt) {
  Random random(361);
  const Scene scene = sphere(30, 30, {0, 0, 0}, 1.0F);
  Configuration c = plain_configuration();
  c.image.memory =
      MemorySizes{.triangles = 60, .vertices = 60, .references = 300, .cells = 100, .blocks = 1000};
  with_bench(scene, c, [&](const Bench& bench) {
    const std::size_t chunks = bench.images().chunks.size();
    ASSERT_GT(chunks, 5U);
    Device& device = bench.device();
    EXPECT_EQ(device.counters()->uploads, 0U);
    const auto segments = exact_segments(bench.truth(), 3000, random);
    std::vector<Hit> hits(segments.size());
    ASSERT_TRUE(device.trace(segments, Query::kClosestHit, hits));
    EXPECT_EQ(device.counters()->uploads, chunks);
    // One ray along an edge of the box meets no chunk or a few.
    const auto before = device.counters();
    Segment edge;
    edge.p1 = {bench.lattice().box().x, 0, 0};
    ASSERT_TRUE(device.trace({&edge, 1}, Query::kClosestHit, std::span(hits).first(1)));
    EXPECT_EQ(hits[0].id, -1);
    EXPECT_LE(device.counters()->uploads, before->uploads + 2);
    // A settled ray does not go on: through the middle there are two sheets of chunks, and the rays
    // of a batch that looks along x are answered by the first.
    std::vector<Segment> looks(500);
    const glm::ivec3 box = bench.lattice().box();
    for (Segment& s : looks) {
      s.p0 = {0, random.between(box.y / 3, 2 * box.y / 3),
              random.between(box.z / 3, 2 * box.z / 3)};
      s.p1 = {box.x, s.p0.y, s.p0.z};
      s.t1 = 1.0;
    }
    hits.resize(looks.size());
    const auto start = device.counters();
    ASSERT_TRUE(device.trace(looks, Query::kClosestHit, hits));
    EXPECT_TRUE(std::ranges::all_of(hits, [](const Hit& h) { return h.id >= 0; }));
    EXPECT_LT(device.counters()->rays - start->rays, 2 * looks.size());
    EXPECT_LT(device.counters()->uploads - start->uploads, chunks);
  });
}

}  // namespace
}  // namespace gridrt::adversarial
