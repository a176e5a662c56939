// Grids and dealings that sample rays choose for the compact layout.
#include <glm/common.hpp>

#include "host/grid/partition.hpp"
#include "host/image/blocks.hpp"
#include "host/image/even_out.hpp"
#include "host/image/image_file.hpp"
#include "host/image/lattice_scene.hpp"
#include "host/image/ray_load.hpp"
#include "host/scene/load.hpp"
#include "image_support.hpp"

namespace gridrt {
namespace {

Scene must_load(const std::string& spec) {
  auto scene = load_scene(spec);
  EXPECT_TRUE(scene) << scene.error().message;
  return std::move(*scene);
}

ImageOptions compact() {
  ImageOptions options;
  options.layout = protocol::Layout::kCompact;
  options.with_scene = false;
  return options;
}

/// Owner of each voxel with references, 0 elsewhere, as the image says.
std::vector<std::uint8_t> owners_of(const Image& image) {
  const VoxelGrid grid = image.grid();
  const auto triangles = decode_triangles(image);
  const VoxelLists lists = bin_triangles(grid, triangles->triangles);
  const std::vector<std::uint8_t> occupancy = block_occupancy(grid, lists);
  const protocol::CellCodec codec(image.header);
  const auto& bytes = image.find(protocol::SectionKind::kCells)->bytes;
  std::vector<std::uint8_t> owners(grid.cells(), 0);
  const glm::ivec3 blocks = block_count(grid);
  std::size_t next = 0;
  for (int i = 0; i < blocks.x * blocks.y * blocks.z; ++i) {
    const glm::ivec3 block{i % blocks.x, i / blocks.x % blocks.y, i / blocks.x / blocks.y};
    for (int bit = 0; bit < 8; ++bit) {
      if (((occupancy[static_cast<std::size_t>(i)] >> bit) & 1) == 0) continue;
      owners[grid.index(block_voxel(block, bit))] =
          static_cast<std::uint8_t>(codec.at(bytes, next++).pe);
    }
  }
  return owners;
}

double clocks_of(const Scene& scene, const Image& image) {
  const auto triangles = decode_triangles(image);
  RaySample sample(image.lattice(), triangles->triangles, scene.lights);
  const VoxelGrid grid = image.grid();
  const VoxelLists lists = bin_triangles(grid, triangles->triangles);
  return estimate_clocks(sample.measure(grid, lists), owners_of(image), image.header.pes);
}

TEST(Measured, CheaperThanCoarserGridsAndPlainDealing) {
  for (const char* spec : {"builtin:teapot?tessellation=10", "builtin:sphere?subdivisions=4",
                           "builtin:sheet?triangles=6000&depth=0.5"}) {
    const Scene scene = must_load(spec);
    const Image image = must_build(scene, compact());
    EXPECT_EQ(static_cast<Mapping>(image.header.mapping), Mapping::kMeasured);
    EXPECT_TRUE(verify_image(image)) << verify_image(image).error().message;
    const double clocks = clocks_of(scene, image);
    ImageOptions other = compact();
    other.grid = image.grid().count;
    const Image plain = must_build(scene, other);
    EXPECT_EQ(static_cast<Mapping>(plain.header.mapping), Mapping::kBoxes);
    EXPECT_LE(clocks, clocks_of(scene, plain)) << spec;
    other.grid = glm::max(image.grid().count / 2, glm::ivec3{1});
    EXPECT_LT(clocks, clocks_of(scene, must_build(scene, other))) << spec;
  }
}

TEST(Measured, ThirteenThousandTrianglesFit) {
  // With as many boxes as a smaller mesh gets, copies of triangles would fill a PE's memory.
  for (const char* spec :
       {"builtin:teapot?tessellation=14", "builtin:sphere?kind=uv&segments=114"}) {
    const Scene scene = must_load(spec);
    EXPECT_GT(scene.triangles.size(), 12000U) << spec;
    const Image image = must_build(scene, compact());
    EXPECT_GT(block_total(image.grid()), 1000U) << spec;
    EXPECT_TRUE(verify_image(image)) << verify_image(image).error().message;
  }
}

/// Of the first groups, which are those of rays, then of facings and regions: how much more than
/// its part the busiest PE has.
double unevenness(const MeasuredGrid& measured, std::span<const std::uint8_t> owners, int pes,
                  std::size_t groups) {
  std::vector<Shares> held(static_cast<std::size_t>(pes), Shares{});
  for (std::size_t i = 0; i < owners.size(); ++i) {
    for (std::size_t g = 0; g < groups; ++g) held[owners[i]][g] += measured.shares[i][g];
  }
  double sum = 0.0;
  for (std::size_t g = 0; g < groups; ++g) {
    double most = 0.0;
    for (const Shares& h : held) most = std::max(most, static_cast<double>(h[g]));
    sum += most * pes - 1.0;
  }
  return sum / static_cast<double>(groups);
}

TEST(Measured, EvensOutWithinMemories) {
  const Scene scene = must_load("builtin:teapot?tessellation=14");
  const auto lattice_scene = make_lattice_scene(scene, compact());
  ASSERT_TRUE(lattice_scene);
  const auto& [local, lights, cut] = *lattice_scene;
  MeasuredGrid measured{must_build(scene, compact()).grid(), {}, {}, {}};
  measured.lists = bin_triangles(measured.grid, local.triangles);
  measured.load =
      RaySample(cut.lattice, local.triangles, lights).measure(measured.grid, measured.lists);
  find_shares(local.triangles, cut.lattice, measured);
  for (const int boxes : {48, 12}) {  // a PE: copies fill the memories, and large boxes
    const auto cuts = balanced_boxes(measured.grid, measured.lists, boxes * cut.pes);
    std::vector<std::uint8_t> owners = deal_by_work(measured, cuts, cut.pes);
    EXPECT_EQ(dealing_fits(local, cut, measured, owners), boxes == 12);
    const auto uneven = [&](std::size_t groups) {
      return unevenness(measured, owners, cut.pes, groups);
    };
    const double of_rays = uneven(kRayGroups);
    const double of_all = uneven(Shares{}.size());
    even_out(local, cut, measured, owners);
    EXPECT_TRUE(dealing_fits(local, cut, measured, owners)) << boxes;
    EXPECT_LT(uneven(kRayGroups), (boxes == 12 ? 0.6 : 2.0) * of_rays) << boxes;
    EXPECT_LT(uneven(Shares{}.size()), (boxes == 12 ? 0.7 : 2.0) * of_all) << boxes;
  }
}

/// Of the work of shadow rays to the scene's light, the busiest PE's part; the mean of all views.
double busiest_of_light(const Scene& scene, const Image& image) {
  const auto triangles = decode_triangles(image);
  RaySample sample(image.lattice(), triangles->triangles, scene.lights);
  const VoxelGrid grid = image.grid();
  const GridLoad load = sample.measure(grid, bin_triangles(grid, triangles->triangles));
  const std::vector<std::uint8_t> owners = owners_of(image);
  double mean = 0.0;
  for (std::size_t g = kViews; g < 2 * kViews; ++g) {
    std::array<double, 4> busy{};
    double sum = 0.0;
    for (std::size_t i = 0; i < owners.size(); ++i) {
      busy.at(owners[i]) += load.work[g][i];
      sum += load.work[g][i];
    }
    mean += *std::ranges::max_element(busy) / sum / kViews;
  }
  return mean;
}

TEST(Measured, ShadowRaysToTheScenesLightAreEvenAmongPes) {
  Scene scene = must_load("builtin:teapot?tessellation=14");
  Scene dark = scene;
  dark.lights.clear();
  const Image of_dark = must_build(dark, compact());
  Light lamp;
  lamp.position = {9.0, 2.0, -4.0};
  Light sun;
  sun.kind = Light::Kind::kDirectional;
  sun.direction = {-0.9, 0.1, 0.4};
  for (const Light& light : {lamp, sun}) {
    scene.lights = {light};
    EXPECT_LT(busiest_of_light(scene, must_build(scene, compact())),
              busiest_of_light(scene, of_dark));
  }
}

TEST(Measured, TheSameImageTwiceAndWorkForAllPes) {
  const Scene scene = must_load("builtin:teapot?tessellation=6");
  for (const int pes : {1, 2, 3, 4}) {
    ImageOptions options = compact();
    options.pes = pes;
    const Image image = must_build(scene, options);
    EXPECT_EQ(serialize_image(image), serialize_image(must_build(scene, options)));
    const auto counts = count_image(image);
    for (int p = 0; p < pes; ++p) {
      EXPECT_GT(counts[static_cast<std::size_t>(p)].references, 0U);
    }
    EXPECT_TRUE(verify_image(image)) << verify_image(image).error().message;
  }
}

TEST(Measured, OddScenes) {
  for (const char* spec : {"builtin:triangle", "builtin:quad", "builtin:cube?size=1,1000,1000",
                           "builtin:cube?size=1e-30,1,1e30", "builtin:degenerate?whole=1",
                           "builtin:empty", "builtin:teapots?tessellation=2&stray=100"}) {
    const Image image = must_build(must_load(spec), compact());
    EXPECT_TRUE(verify_image(image)) << spec << ": " << verify_image(image).error().message;
  }
  Scene lit = must_load("builtin:cube?size=1e6,1e6,1e6");
  // On a corner, without a direction, and as far as numbers reach.
  lit.lights.assign(3, Light{});
  lit.lights[0].position = glm::dvec3{lit.positions[0]};
  lit.lights[1].kind = Light::Kind::kDirectional;
  lit.lights[1].direction = glm::dvec3{0.0};
  lit.lights[2].position = {1e308, -1e308, 1e308};
  EXPECT_TRUE(verify_image(must_build(lit, compact())));
  ImageOptions options = compact();
  options.bits = 4;
  EXPECT_TRUE(verify_image(must_build(random_scene(40, 3), options)));
  // Smaller memories than the board's are kept to, too.
  options = compact();
  options.memory = MemorySizes{
      .triangles = 300, .vertices = 300, .references = 900, .cells = 700, .blocks = 128};
  const Image small = must_build(must_load("builtin:sphere?subdivisions=2"), options);
  EXPECT_LE(block_total(small.grid()), 128U);
  EXPECT_TRUE(verify_image(small));
}

}  // namespace
}  // namespace gridrt
